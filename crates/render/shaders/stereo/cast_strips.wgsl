import package::lib::classify::{VALUE_OFFSET, may_be_visible};
import package::lib::composite::{FIRST_HIT_ALPHA, SEARCHES, STRETCH, blend, finish_ray, start_ray};
import package::lib::cast_parameters::{parameters};
import package::lib::ray::{Ray, ray_at, ray_depth_m, ray_through};
import package::lib::ray_state::{NOTHING_HIT, RayState};
import package::lib::skip::{next_run, start_walk};
import package::lib::strips::{mirrored, partial_at, partial_depths_m, partials, strips};
import package::lib::target::{store};
import package::lib::view::{BAND_ROWS, first_pixel_of_group, view};
import package::lib::volume::{value_at};

// Casts the reference view in strips and derives the other view from segments of its rays (Adelson and Hansen 1994, He and
// Kaufman 1996, without the layers of SP): an invocation owns a row of a strip and goes through its columns from the last to
// the first, each ray front to back, so that every derived pixel gets its segments front to back.

// Puts what a ray holds behind what others have left in the derived column of its slab, and behind the ray itself.
fn flush(partial: u32, depth_m: f32, segment: RayState, before: RayState) -> RayState {
    let alpha = 1.0 - segment.transmittance;
    let held = partials[partial];
    let passed = 1.0 - held.a;
    let sum = held + vec4f(segment.color, alpha) * passed;
    partials[partial] = sum;
    if held.a < FIRST_HIT_ALPHA && sum.a >= FIRST_HIT_ALPHA {
        partial_depths_m[partial] = depth_m;
    }
    var state = before;
    state.color += segment.color * state.transmittance;
    state.transmittance *= segment.transmittance;
    if state.depth_m == NOTHING_HIT && state.transmittance <= 1.0 - FIRST_HIT_ALPHA {
        state.depth_m = depth_m;
    }
    return state;
}

// The slab of a depth.
fn slab_at(depth_m: f32) -> i32 {
    return clamp(i32(ceil(strips.k / depth_m - strips.offset)), strips.furthest, strips.nearest);
}

// First sample behind a slab.
fn end_of_slab(ray: Ray, slab: i32) -> u32 {
    let over = f32(slab) - 1.0 + strips.offset;
    if over <= 0.0 || slab == strips.furthest {
        return ray.sample_count;
    }
    let samples = ceil((strips.k / over - ray.first_depth_m) / ray.step_depth_m);
    return u32(clamp(samples, 0.0, f32(ray.sample_count)));
}

fn cast_column(ray: Ray, row: u32, strip: u32, column: i32) -> RayState {
    let walk = start_walk(ray.first, ray.step);
    let end = ray.sample_count;
    var state = start_ray(ray);
    var segment = state;
    var slab = strips.nearest;
    var slab_end = 0u;
    var run_end = 0u;
    var i = 0u;
    while i < end && state.is_finished == 0u {
        if i >= run_end {
            let run = next_run(walk, i, end, 0.0);
            state.map_reads += run.map_reads;
            if VALUE_OFFSET != 0.0 && run.begin != i {
                segment.scalar = value_at(ray_at(ray, f32(run.begin) + VALUE_OFFSET - 1.0));
            }
            i = run.begin;
            run_end = run.end;
        }
        if i >= slab_end {
            if segment.transmittance < 1.0 {
                state = flush(partial_at(row, strip, column - slab), segment.depth_m, segment, state);
                segment.color = vec3f(0.0);
                segment.transmittance = 1.0;
            }
            segment.depth_m = ray_depth_m(ray, f32(i));
            slab = slab_at(segment.depth_m);
            slab_end = max(end_of_slab(ray, slab), i + 1u);
        }
        let begin = i;
        let stretch_end = min(i + STRETCH, min(run_end, slab_end));
        while i < stretch_end {
            var value = 0.0;
            var is_found = false;
            loop {
                value = value_at(ray_at(ray, f32(i) + VALUE_OFFSET));
                is_found = may_be_visible(value, segment.scalar);
                if is_found || !SEARCHES || i + 1u >= stretch_end {
                    break;
                }
                segment.scalar = value;
                i++;
            }
            if is_found {
                segment = blend(ray, i, value, segment);
            }
            segment.scalar = value;
            i++;
            if state.transmittance * segment.transmittance <= 1.0 - parameters.termination_alpha {
                state.is_finished = 1u;
                break;
            }
        }
        state.samples += i - begin;
    }
    if segment.transmittance < 1.0 {
        state = flush(partial_at(row, strip, column - slab), segment.depth_m, segment, state);
    }
    return state;
}

@compute @workgroup_size(BAND_ROWS)
fn cast_strips(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let row = first_pixel_of_group(group).y + lane;
    if row >= view.first_row + view.row_count {
        return;
    }
    let strip = group.x;
    for (var i = strips.begin; i < strips.end; i++) {
        let offset = strip * strips.width + strips.width - 1u - i;
        if offset >= strips.column_count {
            continue;
        }
        let column = strips.first_column + i32(offset);
        let x = mirrored(column, view.width);
        let ray = ray_through(vec2f(f32(x), f32(row)) + 0.5);
        if ray.sample_count == 0u {
            continue;
        }
        let state = cast_column(ray, row, strip, column);
        if x >= 0 && x < i32(view.width) {
            store(vec2u(u32(x), row), finish_ray(ray, state));
        }
    }
}
