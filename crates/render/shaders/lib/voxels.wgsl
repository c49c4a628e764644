// Mirror of `skip::baseline::VoxelUniform`.

struct VoxelUniform {
    // Voxels along each side of a block.
    block_size: vec3u,
    // Normalised value of a sampled one.
    value_scale: f32,
    // Blocks along each axis.
    blocks: vec3u,
    // Normalised value of a sampled zero.
    value_offset: f32,
    // Normalised gradient magnitude of a sampled one.
    gradient_scale: f32,
}

@group(0) @binding(2) var<uniform> uniforms: VoxelUniform;
@group(0) @binding(3) var volume: texture_3d<f32>;
// Opacity by normalised value and, down the rows, gradient magnitude.
@group(0) @binding(4) var opacities: texture_2d<f32>;

fn block_dims() -> vec3u {
    return uniforms.blocks;
}

// Whether an entry of the table is visible.
fn is_entry_visible(value: f32, gradient: f32) -> bool {
    let last = textureDimensions(opacities) - 1u;
    return textureLoad(opacities, vec2u(round(vec2f(value, gradient) * vec2f(last))), 0).x > 0.0;
}

fn value_of(voxel: vec3u) -> f32 {
    return saturate(textureLoad(volume, voxel, 0).x * uniforms.value_scale + uniforms.value_offset);
}
