import package::lib::accumulate::{accumulate, finish_ray};
import package::lib::ray::{ray_of_pixel};
import package::lib::ray_state::{NOTHING_HIT, RayState};
import package::lib::resume::{begin_ray, keep_ray};
import package::lib::view::{view};

// Premultiplied RGBA.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba32float, write>;
// Depth of the first hit in metres, samples taken, reads of the skip map.
@group(2) @binding(1) var depth_target: texture_storage_2d<rgba32float, write>;
// Side of a workgroup, pixels.
const BAND_ROWS: u32 = 8u;

// Where in a workgroup a lane's pixel is: every eight consecutive lanes are a rectangle of 4 x 2, whose rays stay
// closer together than those of a row.
fn pixel_of_lane(lane: vec2u) -> vec2u {
    return vec2u((lane.x & 3u) | ((lane.y & 1u) << 2u), (lane.x >> 2u) | (lane.y & 6u));
}

// Casts a piece of a picture: `row_count` rows from `first_row`, samples [first_sample, first_sample + sample_limit).
@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn cast_rays(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let band_count = (view.row_count + BAND_ROWS - 1u) / BAND_ROWS;
    let band = (group.y * view.band_stride) % band_count;
    let id = vec2u(group.x, band) * BAND_ROWS + pixel_of_lane(local.xy);
    if id.x >= view.width || id.y >= view.row_count {
        return;
    }
    let pixel = vec2u(id.x, id.y + view.first_row);
    let ray = ray_of_pixel(pixel);
    let slot = id.y * view.width + id.x;
    if ray.sample_count == 0u {
        textureStore(color_target, pixel, vec4f(0.0));
        textureStore(depth_target, pixel, vec4f(NOTHING_HIT, 0.0, 0.0, 0.0));
        return;
    }

    var state = begin_ray(ray, slot);
    let end = min(ray.sample_count, view.first_sample + view.sample_limit);
    if state.is_finished == 0u && view.first_sample < end {
        state = accumulate(ray, view.first_sample, end, state);
    }
    keep_ray(slot, state);

    let finished = finish_ray(ray, state);
    textureStore(color_target, pixel, finished.color);
    textureStore(depth_target, pixel, vec4f(finished.depth_m, f32(finished.samples), f32(finished.map_reads), 0.0));
}
