import package::lib::extreme_value::{accumulate, finish_ray, start_ray};

// Minimum intensity projection.

const WORST: f32 = 2.0;

fn is_better(value: f32, best: f32) -> bool {
    return value < best;
}
