//! The Shepp–Logan head: ten ellipsoids (Kak and Slaney 1988 for the shapes, Toft 1996 for the contrast).

use super::shape::{ellipsoid_distance, filled};
use glam::DVec3;

struct Ellipsoid {
    value: f64,
    radii: [f64; 3],
    centre: [f64; 3],
    turn_about_z_deg: f64,
}

const fn ellipsoid(value: f64, radii: [f64; 3], centre: [f64; 3], turn_about_z_deg: f64) -> Ellipsoid {
    Ellipsoid { value, radii, centre, turn_about_z_deg }
}

/// Added up, in coordinates from −1 to 1.
const HEAD: [Ellipsoid; 10] = [
    ellipsoid(1.0, [0.69, 0.92, 0.81], [0.0, 0.0, 0.0], 0.0),
    ellipsoid(-0.8, [0.6624, 0.874, 0.78], [0.0, -0.0184, 0.0], 0.0),
    ellipsoid(-0.2, [0.11, 0.31, 0.22], [0.22, 0.0, 0.0], -18.0),
    ellipsoid(-0.2, [0.16, 0.41, 0.28], [-0.22, 0.0, 0.0], 18.0),
    ellipsoid(0.1, [0.21, 0.25, 0.41], [0.0, 0.35, -0.15], 0.0),
    ellipsoid(0.1, [0.046, 0.046, 0.05], [0.0, 0.1, 0.25], 0.0),
    ellipsoid(0.1, [0.046, 0.046, 0.05], [0.0, -0.1, 0.25], 0.0),
    ellipsoid(0.1, [0.046, 0.023, 0.05], [-0.08, -0.605, 0.0], 0.0),
    ellipsoid(0.1, [0.023, 0.023, 0.02], [0.0, -0.606, 0.0], 0.0),
    ellipsoid(0.1, [0.023, 0.046, 0.02], [0.06, -0.605, 0.0], 0.0),
];

/// Edges fall over one voxel of the longest axis.
pub(super) fn value(point: DVec3, dims: DVec3) -> f64 {
    let p = 2.0 * point - 1.0;
    let edge = 2.0 / dims.max_element();
    let sum: f64 = HEAD
        .iter()
        .map(|part| {
            let from_centre = p - DVec3::from(part.centre);
            let (sin, cos) = part.turn_about_z_deg.to_radians().sin_cos();
            let turned = DVec3::new(
                cos * from_centre.x + sin * from_centre.y,
                cos * from_centre.y - sin * from_centre.x,
                from_centre.z,
            );
            part.value * filled(ellipsoid_distance(turned, DVec3::from(part.radii)), edge)
        })
        .sum();
    sum.clamp(0.0, 1.0)
}
