import package::lib::accumulate::{finish_ray};
import package::lib::cast_segments::{cast_segments};
import package::lib::pair::{mirrored, pair};
import package::lib::ray::{ray_through};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, view};

// Casts the reference view in strips and derives the other view from segments of its rays (Adelson and Hansen 1994, He and
// Kaufman 1996, without the layers of SP): an invocation owns a row of a strip and goes through its columns from the last to
// the first, each ray front to back, so that every derived pixel gets its segments front to back.

@compute @workgroup_size(BAND_ROWS)
fn cast_strips(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let row = first_pixel_of_group(group).y + lane;
    if row >= view.first_row + view.row_count {
        return;
    }
    let strip = group.x;
    for (var i = pair.begin; i < pair.end; i++) {
        let offset = strip * pair.width + pair.width - 1u - i;
        if offset >= pair.column_count {
            continue;
        }
        let column = pair.first_column + i32(offset);
        let x = mirrored(column, view.width);
        let ray = ray_through(vec2f(f32(x), f32(row)) + 0.5);
        if ray.sample_count == 0u {
            continue;
        }
        let state = cast_segments(ray, SegmentPlace(row, strip, column));
        if x >= 0 && x < i32(view.width) {
            store(vec2u(u32(x), row), finish_ray(ray, state));
        }
    }
}
