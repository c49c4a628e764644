import package::lib::accumulate::{start_ray};
import package::lib::pair::{pair};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState};

// A ray on its way through the slabs, and how far an invocation may take it.

struct SegmentedRay {
    // The next sample.
    next: u32,
    // The segment's slab; nearer than all before the first.
    slab: i32,
    // What the ray holds in front of the segment.
    state: RayState,
    // What it holds in the segment.
    segment: RayState,
}

// What this invocation has done: stretches of samples, and reads of the skip map.
var<private> stretches: u32;
var<private> leaps: u32;

// Whether the iterations of its loops may have come near the limit.
fn is_spent() -> bool {
    return stretches * pair.iterations_per_stretch + leaps * pair.iterations_per_leap >= pair.iteration_limit;
}

fn start_segments(ray: Ray) -> SegmentedRay {
    var state = start_ray(ray);
    state.is_finished = select(0u, 1u, ray.sample_count == 0u);
    return SegmentedRay(0u, pair.nearest + 1, state, state);
}
