import package::lib::lut_1d::{lut_at};
import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{Pixel, RayState, new_ray_state, opaque_pixel};
import package::lib::skip::{next_run, start_walk};
import package::lib::volume::{value_at};

// The best value along a ray; the first of equal ones gives the depth. WORST and is_better are the including file's.

fn start_ray(ray: Ray) -> RayState {
    return new_ray_state(WORST, 0.0);
}

fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    let walk = start_walk(ray.first, ray.step);
    var state = before;
    var best_index = -1.0;
    var next = begin;
    while next < end {
        let run = next_run(walk, next, end, state.scalar);
        for (var i = run.begin; i < run.end; i++) {
            let value = value_at(ray_at(ray, f32(i)));
            let is_new_best = is_better(value, state.scalar);
            state.scalar = select(state.scalar, value, is_new_best);
            best_index = select(best_index, f32(i), is_new_best);
        }
        state.samples += run.end - run.begin;
        state.map_reads += run.map_reads;
        next = run.end;
    }
    if best_index >= 0.0 {
        state.depth_m = ray_depth_m(ray, best_index);
    }
    return state;
}

fn finish_ray(ray: Ray, state: RayState) -> Pixel {
    return opaque_pixel(lut_at(state.scalar).rgb, state);
}
