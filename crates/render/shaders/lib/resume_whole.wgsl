import package::lib::accumulate::{start_ray};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};

// Rays that are cast in one go.

fn begin_ray(ray: Ray, slot: u32) -> RayState {
    return start_ray(ray);
}

fn keep_ray(slot: u32, state: RayState) {}
