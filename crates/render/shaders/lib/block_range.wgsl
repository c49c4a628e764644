import package::lib::cast_parameters::{parameters};

// Codes of the smallest and largest value of every block.
@group(1) @binding(4) var block_ranges: texture_3d<u32>;

// Smallest and largest normalised value of a block.
fn block_range(block: vec3f) -> vec2f {
    let codes = vec2f(textureLoad(block_ranges, vec3i(block), 0).xy);
    return saturate(codes * parameters.code_scale + parameters.code_offset);
}
