import package::lib::cast_parameters::{parameters};
import package::lib::volume::{trilinear};

// Gradient magnitudes interpolated from a map of the voxels' (DM section 3.2).
@group(1) @binding(5) var gradient_map: texture_3d<f32>;

const HAS_GRADIENT = false;

// No gradient, but its magnitude in metric space.
fn steepness_at(position: vec3f) -> vec4f {
    let sampled = textureSampleLevel(gradient_map, trilinear, position, 0.0).x;
    return vec4f(vec3f(0.0), sampled * parameters.magnitude_scale);
}
