import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{RayState, new_ray_state};
import package::lib::skip::{next_run, start_walk};
import package::lib::volume::{value_at};

fn start_ray(ray: Ray) -> RayState {
    return new_ray_state(0.0, ray_depth_m(ray, 0.0));
}

// Sum of the values.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    let walk = start_walk(ray.first, ray.step);
    var state = before;
    var next = begin;
    while next < end {
        let run = next_run(walk, next, end, state.scalar);
        for (var i = run.begin; i < run.end; i++) {
            state.scalar += value_at(ray_at(ray, f32(i)));
        }
        state.samples += run.end - run.begin;
        state.map_reads += run.map_reads;
        next = run.end;
    }
    return state;
}
