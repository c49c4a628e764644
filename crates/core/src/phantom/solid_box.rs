//! A homogeneous box.

use glam::DVec3;

/// Low end of the box along each axis, texture space.
pub const BOX_LO: f64 = 0.25;
/// High end of the box along each axis, texture space.
pub const BOX_HI: f64 = 0.75;

/// The fraction of the voxel centred at `point` that lies in the box.
pub(super) fn value(point: DVec3, dims: DVec3) -> f64 {
    let half_voxel = 0.5 / dims;
    let lo = (point - half_voxel).max(DVec3::splat(BOX_LO));
    let hi = (point + half_voxel).min(DVec3::splat(BOX_HI));
    ((hi - lo).max(DVec3::ZERO) * dims).element_product()
}
