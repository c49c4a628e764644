import package::lib::run::{Run};

// No skipping: every sample may contribute.

// Whether most samples of a run are visible.
const RUNS_ARE_DENSE = false;

struct Walk {
    unused: u32,
}

fn start_walk(first: vec3f, step: vec3f) -> Walk {
    return Walk(0u);
}

fn next_run(walk: Walk, begin: u32, end: u32, scalar: f32) -> Run {
    return Run(begin, end, 0u);
}

fn next_beyond_empty(walk: Walk, sample: u32) -> u32 {
    return sample + 1u;
}

fn is_empty_at(position: vec3f) -> bool {
    return false;
}
