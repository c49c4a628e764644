import package::lib::codes::{codes_of};
import package::lib::range_uniform::{uniforms};

// Smallest and largest of the voxels that trilinear samples in each block read: its own, and one more to each side.

@group(0) @binding(1) var volume: texture_3d<f32>;
// Codes of a block, lo | hi << 16; rows padded to 64 blocks, which are 256 bytes.
@group(0) @binding(2) var<storage, read_write> ranges: array<u32>;

@compute @workgroup_size(8, 8)
fn find_ranges(@builtin(global_invocation_id) id: vec3u) {
    if any(id >= uniforms.blocks) {
        return;
    }
    let block = id + vec3u(0u, uniforms.first_row, uniforms.first_layer);
    let first = max(block * uniforms.block_size, vec3u(1u)) - 1u;
    let end = min((block + 1u) * uniforms.block_size + 1u, textureDimensions(volume));
    var lo = textureLoad(volume, first, 0).x;
    var hi = lo;
    for (var z = first.z; z < end.z; z++) {
        for (var y = first.y; y < end.y; y++) {
            for (var x = first.x; x < end.x; x++) {
                let sampled = textureLoad(volume, vec3u(x, y, z), 0).x;
                lo = min(lo, sampled);
                hi = max(hi, sampled);
            }
        }
    }
    let codes = codes_of(lo * uniforms.stored_per_sampled, hi * uniforms.stored_per_sampled);
    let row = (uniforms.blocks.x + 63u) / 64u * 64u;
    ranges[id.x + row * (id.y + uniforms.blocks.y * id.z)] = codes.x | codes.y << 16u;
}
