// Codes of the smallest and the largest value of each block.
@group(0) @binding(2) var values: texture_3d<u32>;
// For each smallest code the lowest largest code with which a block is occupied; 256 codes per row.
@group(0) @binding(3) var occupied_from: texture_2d<u32>;

fn block_dims() -> vec3u {
    return textureDimensions(values);
}

// By value alone.
fn is_occupied(block: vec3u) -> bool {
    let interval = textureLoad(values, block, 0).xy;
    return interval.y >= textureLoad(occupied_from, vec2u(interval.x & 255u, interval.x >> 8u), 0).x;
}
