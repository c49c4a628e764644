import package::lib::gradient_uniform::{stored_at, uniforms};

fn at_corner(voxel: vec3i, corner: vec3i) -> vec3f {
    return vec3f(corner) * stored_at(voxel + corner);
}

// Gradient magnitude of a voxel by the tetrahedron method (DM Algorithm 1), in the unit of `uniforms.per_difference`.
fn magnitude_at(voxel: vec3i) -> f32 {
    let differences = at_corner(voxel, vec3i(1, -1, -1)) + at_corner(voxel, vec3i(-1, -1, 1))
        + at_corner(voxel, vec3i(-1, 1, -1)) + at_corner(voxel, vec3i(1, 1, 1));
    return length(differences * uniforms.per_difference);
}
