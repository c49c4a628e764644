import package::lib::front::{start_behind};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};

// Rays that are cast in one go.

fn begin_ray(ray: Ray, pixel: vec2u, slot: u32) -> RayState {
    return start_behind(ray, pixel);
}

fn keep_ray(slot: u32, state: RayState) {}
