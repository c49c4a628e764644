//! The edges of a box.

use super::shape::sheet;
use super::solid_box::{BOX_HI, BOX_LO};
use glam::DVec3;

/// Distance from an edge at which the value is 0, voxels.
pub const WIRE_HALF_WIDTH_VOXELS: f64 = 2.0;

pub(super) fn value(point: DVec3, dims: DVec3) -> f64 {
    let from_faces = [BOX_LO, BOX_HI].map(|face| ((point - face) * dims).abs());
    // The nearest face across each axis, and how far beyond both a position is.
    let from_nearest = from_faces[0].min(from_faces[1]);
    let beyond = (DVec3::splat(BOX_LO) - point).max(point - BOX_HI).max(DVec3::ZERO) * dims;
    let from_edge = |along: usize| {
        let [a, b] = [(along + 1) % 3, (along + 2) % 3];
        DVec3::new(beyond[along], from_nearest[a], from_nearest[b]).length()
    };
    let distance = from_edge(0).min(from_edge(1)).min(from_edge(2));
    sheet(distance, WIRE_HALF_WIDTH_VOXELS)
}
