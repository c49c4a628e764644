import package::lib::ray::{Ray, ray_at, ray_depth_m};
import package::lib::ray_state::{RayState};
import package::lib::volume::{value_at};

fn start_ray(ray: Ray) -> RayState {
    return RayState(vec3f(0.0), 0.0, ray_depth_m(ray, 0.0), 0.0, 0u, 0u);
}

// Sum of the values.
fn accumulate(ray: Ray, begin: u32, end: u32, before: RayState) -> RayState {
    var state = before;
    for (var i = begin; i < end; i++) {
        state.scalar += value_at(ray_at(ray, f32(i)));
    }
    state.samples += end - begin;
    return state;
}
