//! Distances and profiles that phantoms are made of.

use glam::{DVec2, DVec3};

/// Signed distance to the surface of a box around the origin, negative inside.
pub(super) fn box_distance(point: DVec3, half_size: DVec3) -> f64 {
    let outside = point.abs() - half_size;
    outside.max(DVec3::ZERO).length() + outside.max_element().min(0.0)
}

/// Approximate signed distance to the surface of an ellipsoid around the origin: exact to first order at the surface.
pub(super) fn ellipsoid_distance(point: DVec3, radii: DVec3) -> f64 {
    let scaled = (point / radii).length();
    let gradient = (point / (radii * radii)).length();
    if gradient > 0.0 { scaled * (scaled - 1.0) / gradient } else { -radii.min_element() }
}

/// Approximate distance to an ellipse around the origin of the plane: exact to first order at the curve.
pub(super) fn ellipse_distance(point: DVec2, radii: DVec2) -> f64 {
    let scaled = (point / radii).length();
    let gradient = (point / (radii * radii)).length();
    if gradient > 0.0 { scaled * (scaled - 1.0) / gradient } else { -radii.min_element() }
}

/// Signed distance to a round cone-like limb from `a` to `b` whose radius goes from `radius_a` to `radius_b`.
pub(super) fn limb_distance(point: DVec3, a: DVec3, b: DVec3, radius_a: f64, radius_b: f64) -> f64 {
    let along = b - a;
    let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (point - a - along * t).length() - (radius_a + (radius_b - radius_a) * t)
}

/// A thin sheet: 1 where the distance is 0, falling linearly to 0 at `half_width` on both sides.
pub(super) fn sheet(distance: f64, half_width: f64) -> f64 {
    (1.0 - distance.abs() / half_width).max(0.0)
}

/// A filled body: ½ where the signed distance is 0, falling linearly from 1 to 0 over `edge`.
pub(super) fn filled(signed_distance: f64, edge: f64) -> f64 {
    (0.5 - signed_distance / edge).clamp(0.0, 1.0)
}
