import package::lib::cast_parameters::{parameters};

// Step components nearer to zero than this never leave a block.
const STANDING: f32 = 1e-30;

// A ray in block coordinates: block (i, j, k) covers [i, i + 1) x ...
struct Walk {
    // Position of sample 0.
    first: vec3f,
    // From one sample to the next.
    step: vec3f,
    // Samples per block, along each axis.
    samples_per_block: vec3f,
    // 0 along axes on which the ray goes up, 1 where it goes down.
    goes_down: vec3f,
    // First slice of the ray's octant in the map.
    octant_slice: i32,
}

// Walks through texture space from sample 0 by equal steps.
fn start_walk(first: vec3f, step: vec3f) -> Walk {
    let block_step = step * parameters.blocks_per_texture;
    let goes_down = block_step < vec3f(0.0);
    let octant = dot(select(vec3i(0), vec3i(1, 2, 4), goes_down), vec3i(1));
    let is_standing = abs(block_step) < vec3f(STANDING);
    return Walk(
        first * parameters.blocks_per_texture,
        block_step,
        1.0 / select(block_step, vec3f(STANDING), is_standing),
        select(vec3f(0.0), vec3f(1.0), goes_down),
        octant * parameters.octant_slices,
    );
}

// Where a sample is, in block coordinates.
fn walk_at(walk: Walk, sample: f32) -> vec3f {
    return walk.first + walk.step * sample;
}

// The block that holds a position, in block coordinates.
fn block_at(position: vec3f) -> vec3f {
    return clamp(floor(position), vec3f(0.0), parameters.last_block);
}

// Steps to the first sample at least `distance` blocks away from a block (DM Eq. 14; with distance 1, Eq. 9).
fn steps_out_of(walk: Walk, position: vec3f, block: vec3f, distance: f32) -> f32 {
    let steps = (block - position + walk.goes_down) * walk.samples_per_block
        + distance * abs(walk.samples_per_block);
    return max(ceil(min(min(steps.x, steps.y), steps.z)), 1.0);
}
