import package::lib::accumulate::{accumulate, finish_ray, start_ray};
import package::lib::ray::{ray_of_pixel};
import package::lib::ray_state::{NOTHING_HIT, RayState};
import package::lib::view::{view};

// Premultiplied RGBA.
@group(2) @binding(0) var color_target: texture_storage_2d<rgba32float, write>;
// Depth of the first hit in metres, and samples taken.
@group(2) @binding(1) var depth_target: texture_storage_2d<rg32float, write>;
// Rays of a piece between dispatches, row by row.
@group(2) @binding(2) var<storage, read_write> states: array<RayState>;

// Side of a workgroup, pixels.
const BAND_ROWS: u32 = 8u;

// The `sample_limit` of a ray that is cast in one go.
const ALL_SAMPLES: u32 = 0xffffffffu;

// Casts a piece of a picture: `row_count` rows from `first_row`, samples [first_sample, first_sample + sample_limit).
@compute @workgroup_size(BAND_ROWS, BAND_ROWS)
fn cast_rays(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let band_count = (view.row_count + BAND_ROWS - 1u) / BAND_ROWS;
    let band = (group.y * view.band_stride) % band_count;
    let id = vec2u(group.x * BAND_ROWS + local.x, band * BAND_ROWS + local.y);
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

    var state: RayState;
    if view.first_sample == 0u {
        state = start_ray(ray);
    } else {
        state = states[slot];
    }
    let end = min(ray.sample_count, view.first_sample + view.sample_limit);
    if state.is_finished == 0u && view.first_sample < end {
        state = accumulate(ray, view.first_sample, end, state);
    }
    if view.sample_limit != ALL_SAMPLES {
        states[slot] = state;
    }

    let finished = finish_ray(ray, state);
    textureStore(color_target, pixel, finished.color);
    textureStore(depth_target, pixel, vec4f(finished.depth_m, f32(finished.samples), 0.0, 0.0));
}
