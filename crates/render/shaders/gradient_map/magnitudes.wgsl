import package::lib::gradient_uniform::{uniforms, volume};
import package::lib::pack::{VOXELS_PER_WORD, texels_of};
import package::lib::voxel_gradient::{magnitude_at};

// Texels of the slab; rows padded to 64 words, which are 256 bytes.
@group(0) @binding(2) var<storage, read_write> texels: array<u32>;

@compute @workgroup_size(8, 8)
fn find_magnitudes(@builtin(global_invocation_id) id: vec3u) {
    let dims = textureDimensions(volume);
    let first = id.x * VOXELS_PER_WORD;
    if first >= dims.x || id.y >= dims.y {
        return;
    }
    var numbers = vec4f(0.0);
    for (var i = 0u; i < VOXELS_PER_WORD; i++) {
        let magnitude = magnitude_at(vec3i(vec3u(first + i, id.y, uniforms.first_slice + id.z)));
        numbers[i] = saturate(magnitude * uniforms.normalised_per_magnitude);
    }
    let words = (dims.x + VOXELS_PER_WORD - 1u) / VOXELS_PER_WORD;
    let row = (words + 63u) / 64u * 64u;
    texels[id.x + row * (id.y + dims.y * id.z)] = texels_of(numbers);
}
