import package::lib::cast_parameters::{parameters};

// A volume that the device's sampler filters.
@group(1) @binding(0) var volume: texture_3d<f32>;
@group(1) @binding(1) var trilinear: sampler;

// The normalised value at a texture position.
fn value_at(position: vec3f) -> f32 {
    let stored = textureSampleLevel(volume, trilinear, position, 0.0).x;
    return saturate(stored * parameters.value_scale + parameters.value_offset);
}
