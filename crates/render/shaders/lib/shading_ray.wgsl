import package::lib::classify::{EMPTY_IS_CLEAR, log2_transmittance_at};
import package::lib::ray::{is_inside};
import package::lib::run::{Run};
import package::lib::skip::{is_empty_at, next_run, start_walk};

// Distance of neighbouring samples of shadow and directional rays, voxel lengths.
const SHADING_STEP: f32 = 2.0;

// Log2 transmittance of one voxel length, 0 outside the visible part of the volume.
fn log2_transmittance_inside(position: vec3f) -> f32 {
    if !is_inside(position) || (EMPTY_IS_CLEAR && is_empty_at(position)) {
        return 0.0;
    }
    return log2_transmittance_at(position);
}

// Log2 transmittance of `count` samples, the first of them a step away from a position.
fn log2_transmittance_along(position: vec3f, step: vec3f, count: u32) -> f32 {
    let walk = start_walk(position, step);
    var sum = 0.0;
    var next = 1u;
    while next <= count {
        var run = Run(next, count + 1u, 0u);
        if EMPTY_IS_CLEAR {
            run = next_run(walk, next, count + 1u, 0.0);
        }
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
