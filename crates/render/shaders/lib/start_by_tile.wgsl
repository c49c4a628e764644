import package::lib::first_hits::{HIT_TILE};
import package::lib::ray::{Ray};

// Rays that start where those of their tile can first meet what may not be empty (`first_hits/starts`).

// Depths, metres.
@group(2) @binding(7) var ray_starts: texture_2d<f32>;

// Least step that is divided by, metres.
const LEAST_STEP_M: f32 = 1e-12;

// The first sample not before that; their number if there is none.
fn start_of(ray: Ray, pixel: vec2u) -> u32 {
    let start_m = textureLoad(ray_starts, pixel / HIT_TILE, 0).x;
    let before = ceil((start_m - ray.first_depth_m) / max(ray.step_depth_m, LEAST_STEP_M));
    return u32(clamp(before, 0.0, f32(ray.sample_count)));
}
