import package::lib::classify::{EMPTY_IS_CLEAR, log2_transmittance_at};
import package::lib::ray::{is_inside};
import package::lib::skip::{is_empty_at, next_beyond_empty, next_run, start_walk};

// Distance of neighbouring samples of shadow and directional rays, voxel lengths.
const SHADING_STEP: f32 = 2.0;

// Log2 transmittance of one voxel length, 0 outside the visible part of the volume. A single sample of an isosurface is
// always taken: its block may be all inside.
fn log2_transmittance_inside(position: vec3f) -> f32 {
    if !is_inside(position) || (EMPTY_IS_CLEAR && is_empty_at(position)) {
        return 0.0;
    }
    return log2_transmittance_at(position);
}

// Log2 transmittance of four samples, the first of them a step away from a position: too few to leap, and not in a loop,
// for drivers limit the iterations of all loops together.
fn log2_transmittance_of_four(position: vec3f, step: vec3f) -> f32 {
    return log2_transmittance_if_inside(position + step)
        + log2_transmittance_if_inside(position + 2.0 * step)
        + log2_transmittance_if_inside(position + 3.0 * step)
        + log2_transmittance_if_inside(position + 4.0 * step);
}

fn log2_transmittance_if_inside(position: vec3f) -> f32 {
    let log2_transmittance = log2_transmittance_at(position);
    return select(0.0, log2_transmittance, is_inside(position));
}

// Log2 transmittance of `count` samples, the first of them a step away from a position.
fn log2_transmittance_along(position: vec3f, step: vec3f, count: u32) -> f32 {
    if EMPTY_IS_CLEAR {
        return log2_transmittance_of_occupied(position, step, count);
    }
    return log2_transmittance_past_surfaces(position, step, count);
}

// Leaps over empty blocks: they let all light through.
fn log2_transmittance_of_occupied(position: vec3f, step: vec3f, count: u32) -> f32 {
    let walk = start_walk(position, step);
    var sum = 0.0;
    var next = 1u;
    while next <= count {
        let run = next_run(walk, next, count + 1u, 0.0);
        for (var i = run.begin; i < run.end; i++) {
            let at = position + step * f32(i);
            if is_inside(at) {
                sum += log2_transmittance_at(at);
            }
        }
        next = run.end;
    }
    return sum;
}

// Blocks without a surface are all clear or all opaque: the first sample in one tells, and a clear one is leapt from.
fn log2_transmittance_past_surfaces(position: vec3f, step: vec3f, count: u32) -> f32 {
    let walk = start_walk(position, step);
    var sum = 0.0;
    var i = 1u;
    while i <= count {
        let at = position + step * f32(i);
        let log2_transmittance = log2_transmittance_at(at);
        if is_inside(at) {
            sum += log2_transmittance;
        }
        i = select(i + 1u, next_beyond_empty(walk, i), log2_transmittance >= 0.0);
    }
    return sum;
}
