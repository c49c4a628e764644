import package::lib::accumulate::{finish_ray};
import package::lib::cast_segments::{cast_segments};
import package::lib::mirrored::{mirrored};
import package::lib::ray::{ray_through};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::segmented_ray::{start_segments};
import package::lib::target::{store};
import package::lib::tiles_all::{LANES, pixel_of_lane};
import package::lib::view::{view};

// Casts the reference view ray by ray and leaves the segments in layers (SP Alg. 1 and 2). Workgroups are squares of sweep
// columns and rows.

@compute @workgroup_size(LANES)
fn cast_layers(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let at = pixel_of_lane(group, lane) - vec2u(view.first_column, 0u);
    if at.y >= view.first_row + view.row_count || at.x >= view.pair.column_count {
        return;
    }
    let column = view.pair.first_column + i32(at.x);
    let x = mirrored(column);
    let ray = ray_through(vec2f(f32(x), f32(at.y)) + 0.5);
    if ray.sample_count == 0u {
        return;
    }
    let place = SegmentPlace(at.y, column);
    let state = cast_segments(ray, view.pair.furthest, place, start_segments(ray)).state;
    if x >= 0 && x < i32(view.width) {
        store(vec2u(u32(x), at.y), finish_ray(ray, state));
    }
}
