import package::lib::field::{field_word};

// A pass along y or z as DM Algorithm 3 does it: each block searches outwards, to both sides in turn, until nothing can be
// nearer. The baseline of the benchmark.

// Step from a block to the next along the axis of the pass; words from a row to the next.
@group(0) @binding(0) var<uniform> axis_and_row: vec4u;
@group(0) @binding(1) var<storage, read_write> field: array<u32>;
// Distances so far (DM's swap image).
@group(0) @binding(2) var so_far: texture_3d<u32>;

fn nearest_along_axis(block: vec3u, blocks: vec3u) -> u32 {
    let at = dot(block, axis_and_row.xyz);
    let length = dot(blocks, axis_and_row.xyz);
    var distance = textureLoad(so_far, block, 0).x;
    for (var n = 1u; n < distance; n++) {
        if at >= n {
            distance = min(distance, max(n, textureLoad(so_far, block - n * axis_and_row.xyz, 0).x));
        }
        if at + n < length && n < distance {
            distance = min(distance, max(n, textureLoad(so_far, block + n * axis_and_row.xyz, 0).x));
        }
    }
    return distance;
}

@compute @workgroup_size(8, 8)
fn zigzag(@builtin(global_invocation_id) id: vec3u) {
    let blocks = textureDimensions(so_far);
    let first = 4u * id.x;
    if first >= blocks.x || id.y >= blocks.y {
        return;
    }
    var word = 0u;
    for (var i = 0u; i < min(4u, blocks.x - first); i++) {
        word |= nearest_along_axis(vec3u(first + i, id.yz), blocks) << (8u * i);
    }
    field[field_word(id, blocks, axis_and_row.w)] = word;
}
