import package::lib::voxels::{block_dims, uniforms, volume};
import package::lib::voxel_visible::{is_voxel_visible};

// Voxel by voxel, the block's own and one more to each side (DM section 3.3): the baseline of the benchmark.
fn is_occupied(block: vec3u) -> bool {
    let first = max(block * uniforms.block_size, vec3u(1u)) - 1u;
    let end = min((block + 1u) * uniforms.block_size + 1u, textureDimensions(volume));
    for (var z = first.z; z < end.z; z++) {
        for (var y = first.y; y < end.y; y++) {
            for (var x = first.x; x < end.x; x++) {
                if is_voxel_visible(vec3u(x, y, z)) {
                    return true;
                }
            }
        }
    }
    return false;
}
