import package::lib::cast_segments::{cast_segments};
import package::lib::composite::{finish_ray};
import package::lib::pair::{mirrored, pair};
import package::lib::ray::{ray_through};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::target::{store};
import package::lib::tiles_all::{LANES, pixel_of_lane};
import package::lib::view::{view};

// Casts the reference view and leaves the segments in layers (SP Alg. 1 and 2): an invocation owns a row of a strip, here of
// one column. Workgroups are squares of strips and rows.

@compute @workgroup_size(LANES)
fn cast_layers(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let at = pixel_of_lane(group, lane);
    let row = at.y;
    let strip = at.x - view.first_column;
    if row >= view.first_row + view.row_count {
        return;
    }
    // A loop also for one column: Mesa 22's software Vulkan crashes on branches outside of loops whose conditions read much.
    for (var i = pair.begin; i < pair.end; i++) {
        let offset = strip * pair.width + i;
        if offset >= pair.column_count {
            continue;
        }
        let column = pair.first_column + i32(offset);
        let x = mirrored(column, view.width);
        let ray = ray_through(vec2f(f32(x), f32(row)) + 0.5);
        if ray.sample_count == 0u {
            continue;
        }
        let state = cast_segments(ray, SegmentPlace(row, column));
        if x >= 0 && x < i32(view.width) {
            store(vec2u(u32(x), row), finish_ray(ray, state));
        }
    }
}
