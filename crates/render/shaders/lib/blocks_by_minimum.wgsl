import package::lib::block_range::{block_range};

// Blocks whose smallest value cannot lower the minimum so far.
fn empty_distance(block: vec3f, octant_slice: i32, best: f32) -> f32 {
    return select(1.0, 0.0, block_range(block).x < best);
}
