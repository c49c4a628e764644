import package::lib::block_range::{block_range};

// Blocks whose largest value cannot raise the maximum so far.
fn empty_distance(block: vec3f, octant_slice: i32, best: f32) -> f32 {
    return select(1.0, 0.0, block_range(block).y > best);
}
