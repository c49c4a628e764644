//! A ball with a linear edge.

use glam::DVec3;

/// Radius of the sphere, texture space.
pub const SPHERE_RADIUS: f64 = 0.4;
/// Distance over which the value falls from 1 to 0 across the surface, voxels.
pub const SPHERE_EDGE_VOXELS: f64 = 4.0;

pub(super) fn value(point: DVec3, dims: DVec3) -> f64 {
    let from_centre = point - 0.5;
    let distance = from_centre.length();
    if distance == 0.0 {
        return 1.0;
    }
    // How fast the distance to the centre grows per voxel, along the steepest way through voxel space.
    let per_voxel = (from_centre / distance / dims).length();
    (0.5 + (SPHERE_RADIUS - distance) / (per_voxel * SPHERE_EDGE_VOXELS)).clamp(0.0, 1.0)
}
