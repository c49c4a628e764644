// Mirror of `skip::range_search::RangeUniform`.

struct RangeUniform {
    // Voxels along each side of a block.
    block_size: vec3u,
    // First layer of blocks of the part.
    first_layer: u32,
    // Blocks along each axis; rows and layers of the part only.
    blocks: vec3u,
    // The last code.
    last_code: u32,
    // Stored number of a sampled one.
    stored_per_sampled: f32,
    // From one code to the next, stored units.
    stored_per_code: f32,
    // Stored number of code 0.
    stored_at_zero: f32,
    // Stored number of the last code.
    largest_stored: f32,
    // How far rounding may carry an interpolated number out of the interval of its voxels, stored units.
    rounding: f32,
    // First row of blocks of the part, in each of its layers.
    first_row: u32,
}

@group(0) @binding(0) var<uniform> uniforms: RangeUniform;
