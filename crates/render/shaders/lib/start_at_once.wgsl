import package::lib::ray::{Ray};

// Rays that start with their first sample.

fn start_of(ray: Ray, pixel: vec2u) -> u32 {
    return 0u;
}
