//! How near and far what is in a picture may be.

use crate::view::View;
use glam::DVec3;

/// Nearest depth that is told from the eye itself, metres.
const NEAREST_M: f64 = 1e-3;

/// The inverse depths of what of a body is in front of a view, 1/m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The largest.
    pub nearest: f64,
    /// The least.
    pub furthest: f64,
}

impl Reach {
    /// That of a convex body with some corners, world space, metres.
    pub fn of(view: &View, corners_world: &[DVec3]) -> Self {
        let least_m = view.projection.depth_range_m().0.max(NEAREST_M);
        let (nearest_m, furthest_m) = view.depths_m(corners_world);
        Self { nearest: 1.0 / nearest_m.max(least_m), furthest: 1.0 / furthest_m.max(least_m) }
    }

    /// Inverse depth of the plane halfway between both ends, 1/m.
    pub fn middle(&self) -> f64 {
        2.0 / (1.0 / self.nearest + 1.0 / self.furthest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Orbit;
    use crate::view::{Frustum, Projection};

    #[test]
    fn the_middle_is_that_of_what_is_in_front() {
        let frustum = Frustum::from_fov(1.0, [4, 3]).unwrap();
        let at = |distance_m| {
            let orbit = Orbit { distance_m, ..Orbit::default() };
            let corners = [DVec3::splat(-0.5), DVec3::splat(0.5)];
            Reach::of(&orbit.view(Projection::Perspective(frustum), [4, 3]), &corners)
        };
        assert!((at(2.0).middle() - 0.5).abs() < 1e-9, "{:?}", at(2.0));
        let inside = at(0.1);
        assert!(inside.nearest > 1.0 / 0.1 && inside.middle() < 2.0 * inside.furthest + 1e-9, "{inside:?}");
    }
}
