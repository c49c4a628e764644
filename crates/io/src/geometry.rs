//! From the geometry in a header to a grid in RAS+ millimetres.

use crate::ReadError;
use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::volume::{Grid, GridError};

/// Turns positions in LPS (left, posterior, superior) into RAS.
pub(crate) const RAS_FROM_LPS: DVec3 = DVec3::new(-1.0, -1.0, 1.0);

/// Flips the world axes of a matrix by the signs of `flip`.
pub(crate) fn flipped(flip: DVec3, matrix: DAffine3) -> DAffine3 {
    DAffine3::from_scale(flip) * matrix
}

/// A grid from a header's matrix; `field` is the one to blame.
pub(crate) fn grid(dims: [usize; 3], matrix: DAffine3, field: &'static str) -> Result<Grid, ReadError> {
    if !matrix.is_finite() {
        return Err(ReadError::NotFinite { field });
    }
    Grid::new(dims, without_negative_zeros(matrix)).map_err(|error| match error {
        GridError::NotInvertible(matrix) => ReadError::NotInvertible { field, matrix: matrix.to_string() },
        _ => ReadError::TooLarge {
            dims: dims.map(|d| d as u64),
            bytes_per_voxel: 1,
            limit_bytes: crate::MAX_VOXEL_BYTES,
        },
    })
}

/// The direction of a third axis for two-dimensional images: 1 mm along the normal.
pub(crate) fn normal_mm(x_axis: DVec3, y_axis: DVec3) -> DVec3 {
    x_axis.cross(y_axis).try_normalize().unwrap_or(DVec3::Z)
}

/// The direction of a second axis for one-dimensional images: 1 mm across the first.
pub(crate) fn perpendicular_mm(x_axis: DVec3) -> DVec3 {
    x_axis.any_orthogonal_vector().try_normalize().unwrap_or(DVec3::Y)
}

/// A matrix whose axes have the spacing as their length.
pub(crate) fn diagonal(spacing_mm: DVec3) -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_diagonal(spacing_mm))
}

/// Millimetres per unit, for the names that headers use. Names that are not lengths count as millimetres.
pub(crate) fn mm_per_unit(name: &str) -> f64 {
    match name.trim().to_ascii_lowercase().as_str() {
        "m" | "meter" | "metre" | "meters" | "metres" => 1e3,
        "cm" | "centimeter" | "centimetre" => 10.0,
        "um" | "µm" | "μm" | "micron" | "microns" | "micrometer" | "micrometre" => 1e-3,
        "nm" | "nanometer" | "nanometre" => 1e-6,
        _ => 1.0,
    }
}

fn without_negative_zeros(matrix: DAffine3) -> DAffine3 {
    let positive = |v: DVec3| v + DVec3::ZERO;
    let linear = matrix.matrix3;
    let linear = DMat3::from_cols(positive(linear.x_axis), positive(linear.y_axis), positive(linear.z_axis));
    DAffine3::from_mat3_translation(linear, positive(matrix.translation))
}
