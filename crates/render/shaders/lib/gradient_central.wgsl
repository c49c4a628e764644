import package::lib::cast_parameters::{parameters};
import package::lib::volume::{value_at};

fn central_difference(position: vec3f, offset: vec3f) -> f32 {
    return 0.5 * (value_at(position + offset) - value_at(position - offset));
}

// Gradient in metric space by central differences: change of the normalised value per voxel length.
fn gradient_at(position: vec3f) -> vec3f {
    let texel = 1.0 / parameters.dims;
    let per_voxel = vec3f(
        central_difference(position, vec3f(texel.x, 0.0, 0.0)),
        central_difference(position, vec3f(0.0, texel.y, 0.0)),
        central_difference(position, vec3f(0.0, 0.0, texel.z)),
    );
    return (per_voxel * parameters.dims) * parameters.texture_from_metric;
}
