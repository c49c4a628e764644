import package::lib::ray::{Ray};
import package::lib::view::{view};

// Slabs of depth in which all samples of a ray move by the same number of columns.

// Depth that counts as infinite, metres.
const INFINITY_M: f32 = 1e30;

// The slab of a depth.
fn slab_at(depth_m: f32) -> i32 {
    return clamp(i32(ceil(view.pair.k / depth_m - view.pair.offset)), view.pair.furthest, view.pair.nearest);
}

// How far right of its slab's largest shift a sample lands, columns from 0 to 1.
fn fraction_of_slab(slab: i32, depth_m: f32) -> f32 {
    return clamp(f32(slab) + view.pair.offset - view.pair.k / depth_m, 0.0, 1.0);
}

// Depths at which a slab begins and ends, metres.
fn bounds_of_slab_m(slab: i32) -> vec2f {
    let over = f32(slab) + view.pair.offset;
    return vec2f(view.pair.k / over, select(INFINITY_M, view.pair.k / (over - 1.0), over > 1.0));
}

// First sample of a slab.
fn start_of_slab(ray: Ray, slab: i32) -> u32 {
    return select(end_of_slab(ray, slab + 1), 0u, slab == view.pair.nearest);
}

// First sample behind a slab.
fn end_of_slab(ray: Ray, slab: i32) -> u32 {
    let over = f32(slab) - 1.0 + view.pair.offset;
    if over <= 0.0 || slab == view.pair.furthest {
        return ray.sample_count;
    }
    let samples = ceil((view.pair.k / over - ray.first_depth_m) / ray.step_depth_m);
    return u32(clamp(samples, 0.0, f32(ray.sample_count)));
}
