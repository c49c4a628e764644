import package::lib::accumulate::{ITERATIONS_PER_SAMPLE, start_ray};
import package::lib::ray::{Ray};
import package::lib::ray_state::{RayState, STRETCH};
import package::lib::view::{view};

// A ray on its way through the slabs, and how far an invocation may take it.

struct SegmentedRay {
    // The next sample.
    next: u32,
    // The segment's slab; nearer than all before the first, the next one while there is no segment.
    slab: i32,
    // The first sample behind it.
    slab_end: u32,
    // Sum of the segment's sample numbers, each by what it adds to the opacity.
    moment: f32,
    // What of the segment before belongs to this slab.
    carried: vec4f,
    // What the ray holds in front of the segment.
    state: RayState,
    // What it holds in the segment.
    segment: RayState,
}

// What this invocation has done: stretches of samples, and reads of the skip map.
var<private> stretches: u32;
var<private> leaps: u32;

// Iterations that end the loops of a stretch.
const ITERATIONS_PER_STRETCH: u32 = 4u;

// Whether the iterations of its loops may have come near the limit.
fn is_spent() -> bool {
    let of_samples = STRETCH * (ITERATIONS_PER_SAMPLE + view.pair.iterations_of_shading);
    let of_stretches = stretches * (of_samples + ITERATIONS_PER_STRETCH);
    return of_stretches + leaps * view.pair.lockstep_rays >= view.pair.iteration_limit;
}

fn start_segments(ray: Ray) -> SegmentedRay {
    var state = start_ray(ray);
    state.is_finished = select(0u, 1u, ray.sample_count == 0u);
    return SegmentedRay(0u, view.pair.nearest + 1, 0u, 0.0, vec4f(0.0), state, state);
}
