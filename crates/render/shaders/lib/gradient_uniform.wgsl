// Mirror of `gradient_map::GradientUniform`.

struct GradientUniform {
    // Part of the gradient along each axis for each of its differences, in the unit of the magnitudes.
    per_difference: vec3f,
    // First slice of the slab.
    first_slice: u32,
    // Slices of the slab.
    slices: u32,
    // Stored number of a sampled one.
    stored_per_sampled: f32,
    // One over the largest magnitude.
    normalised_per_magnitude: f32,
}

@group(0) @binding(0) var<uniform> uniforms: GradientUniform;
@group(0) @binding(1) var volume: texture_3d<f32>;

// The stored number of a voxel; beyond a face that of the face.
fn stored_at(voxel: vec3i) -> f32 {
    let last = vec3i(textureDimensions(volume)) - 1;
    return textureLoad(volume, clamp(voxel, vec3i(0), last), 0).x * uniforms.stored_per_sampled;
}
