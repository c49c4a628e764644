import package::lib::accumulate::{accumulate, finish_ray};
import package::lib::ray::{ray_of_pixel};
import package::lib::record::{begin_recording};
import package::lib::resume::{begin_ray, keep_ray};
import package::lib::start::{start_of};
import package::lib::target::{store};
import package::lib::tiles::{LANES, pixel_of_lane, store_miss};
import package::lib::view::{is_outside_piece, view};

// Casts a piece of a picture: `row_count` rows from `first_row`, samples [first_sample, first_sample + sample_limit).
@compute @workgroup_size(LANES)
fn cast_rays(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let pixel = pixel_of_lane(group, lane);
    if is_outside_piece(pixel) {
        return;
    }
    var ray = ray_of_pixel(pixel);
    ray.first_sample = start_of(ray, pixel);
    if ray.first_sample >= ray.sample_count {
        store_miss(pixel);
        return;
    }
    let slot = (pixel.y - view.first_row) * view.width + pixel.x;
    begin_recording(pixel);
    var state = begin_ray(ray, pixel, slot);
    let end = min(ray.sample_count, view.first_sample + view.sample_limit);
    let begin = max(ray.first_sample, view.first_sample);
    if state.is_finished == 0u && begin < end {
        state = accumulate(ray, begin, end, state);
    }
    keep_ray(slot, state);
    store(pixel, finish_ray(ray, state));
}
