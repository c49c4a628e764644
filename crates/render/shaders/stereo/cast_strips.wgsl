import package::lib::accumulate::{finish_ray};
import package::lib::cast_segments::{cast_segments};
import package::lib::cuts::{empty_cut, note_cut};
import package::lib::mirrored::{mirrored};
import package::lib::ray::{ray_through};
import package::lib::segment_sink::{SegmentPlace};
import package::lib::segmented_ray::{SegmentedRay, is_spent, leaps, start_segments, stretches};
import package::lib::strip_bands::{columns_before, last_of, strip_band_at, strips};
import package::lib::strips::{first_reached, partial_at, partial_depths_m, partials, reach};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, view};

// Casts the reference view in strips and derives the other view from segments of its rays (Adelson and Hansen 1994, He and
// Kaufman 1996, without the layers of SP): an invocation owns a row of a strip and goes through its columns from the last to
// the first, each ray front to back, so that every derived pixel gets its segments front to back.

// A row of a strip between dispatches.
struct Progress {
    // Columns that are not finished.
    left: vec2u,
    // 1 if the last of them is begun.
    is_begun: u32,
    ray: SegmentedRay,
}

@group(3) @binding(3) var<storage, read_write> progress: array<Progress>;

// Empties the first partial sums of a strip.
fn empty_partials(row: u32, strip: u32, count: u32) {
    for (var i = 0u; i < count; i++) {
        let column = first_reached(strip) + i32(i);
        let at = partial_at(row, strip, column);
        partials[at] = vec4f(0.0);
        partial_depths_m[at] = 0.0;
        empty_cut(row, strip, column);
    }
}

@compute @workgroup_size(BAND_ROWS)
fn cast_strips(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let row = first_pixel_of_group(group).y + lane;
    if row >= view.first_row + view.row_count {
        return;
    }
    let strip = group.x;
    let band = strip_band_at(row / BAND_ROWS, strip);
    let stretches_before = atomicLoad(&strips.bands[band].stretches);
    let leaps_before = atomicLoad(&strips.bands[band].leaps);
    let at = row * view.pair.count + strip;
    let is_resuming = view.pair.is_resuming == 1u;
    var left = strips.bands[band].listed;
    var under_way: SegmentedRay;
    var is_begun = false;
    if is_resuming {
        left = progress[at].left;
        under_way = progress[at].ray;
        is_begun = progress[at].is_begun == 1u;
    }
    empty_partials(row, strip, select(reach(), 0u, is_resuming));
    while any(left != vec2u(0u)) && !is_spent() {
        let offset = last_of(left);
        let column = view.pair.first_column + i32(strip * view.pair.width + offset);
        let x = mirrored(column);
        let ray = ray_through(vec2f(f32(x), f32(row)) + 0.5);
        if !is_begun {
            under_way = start_segments(ray);
        }
        let place = SegmentPlace(row, strip, column);
        under_way = cast_segments(ray, view.pair.furthest, place, under_way);
        is_begun = under_way.state.is_finished == 0u;
        if !is_begun {
            note_cut(row, strip, column, ray, under_way);
            left &= columns_before(offset);
            if x >= 0 && x < i32(view.width) && ray.sample_count > 0u {
                store(vec2u(u32(x), row), finish_ray(ray, under_way.state));
            }
        }
        // Rows that run in lockstep have waited for the one that has done the most; all of them end together.
        atomicMax(&strips.bands[band].stretches, stretches_before + stretches);
        atomicMax(&strips.bands[band].leaps, leaps_before + leaps);
        stretches = atomicLoad(&strips.bands[band].stretches) - stretches_before;
        leaps = atomicLoad(&strips.bands[band].leaps) - leaps_before;
    }
    if any(left != vec2u(0u)) {
        progress[at] = Progress(left, select(0u, 1u, is_begun), under_way);
        atomicAdd(&strips.unfinished, 1u);
    } else {
        progress[at].left = vec2u(0u);
    }
}
