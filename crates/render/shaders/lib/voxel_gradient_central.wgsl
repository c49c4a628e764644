import package::lib::gradient_uniform::{stored_at, uniforms};

fn difference(voxel: vec3i, axis: vec3i) -> f32 {
    return stored_at(voxel + axis) - stored_at(voxel - axis);
}

// Gradient magnitude of a voxel by central differences, in the unit of `uniforms.per_difference`.
fn magnitude_at(voxel: vec3i) -> f32 {
    let differences =
        vec3f(difference(voxel, vec3i(1, 0, 0)), difference(voxel, vec3i(0, 1, 0)), difference(voxel, vec3i(0, 0, 1)));
    return length(differences * uniforms.per_difference);
}
