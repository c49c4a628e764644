import package::lib::cast_parameters::{parameters};
import package::lib::volume::{value_at};

fn tetrahedron_corner(position: vec3f, corner: vec3f) -> vec3f {
    return corner * value_at(position + corner / parameters.dims);
}

// Gradient in metric space by the tetrahedron method (DM Algorithm 1): change of the normalised value per voxel length.
fn gradient_at(position: vec3f) -> vec3f {
    let per_voxel = 0.25 * (
        tetrahedron_corner(position, vec3f(1.0, -1.0, -1.0))
        + tetrahedron_corner(position, vec3f(-1.0, -1.0, 1.0))
        + tetrahedron_corner(position, vec3f(-1.0, 1.0, -1.0))
        + tetrahedron_corner(position, vec3f(1.0, 1.0, 1.0))
    );
    return (per_voxel * parameters.dims) * parameters.texture_from_metric;
}
