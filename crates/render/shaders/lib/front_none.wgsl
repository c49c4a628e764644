import package::lib::accumulate::{start_ray};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};

// Rays with nothing in front of them.

fn start_behind(ray: Ray, pixel: vec2u) -> RayState {
    return start_ray(ray);
}
