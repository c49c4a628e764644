//! Rigs: from one middle view to the views that a display needs.

use super::{Projection, View};
use glam::{DAffine3, DVec3};

/// Which views a display needs of one eye pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rig {
    /// One view.
    Mono,
    /// A left and a right view with parallel axes.
    Stereo {
        /// Distance between the eyes, metres.
        eye_distance_m: f64,
        /// Depth at which both eyes see a point at the same place of the picture, metres. Infinite keeps both
        /// frusta as they are; a finite distance shears them (off-axis, never toed in).
        convergence_m: f64,
    },
}

impl Rig {
    /// The views of the rig about a middle view, left eye first; all of them are shaded from the middle view.
    pub fn views(&self, middle: &View) -> Vec<View> {
        match *self {
            Self::Mono => vec![*middle],
            Self::Stereo { eye_distance_m, convergence_m } => {
                [-0.5, 0.5].map(|side| moved(middle, side * eye_distance_m, convergence_m)).to_vec()
            }
        }
    }
}

/// The view of an eye moved along view +X that keeps the plane at the convergence depth in place.
fn moved(view: &View, right_m: f64, convergence_m: f64) -> View {
    let tangent = -right_m / convergence_m;
    let projection = match view.projection {
        Projection::Perspective(frustum) => Projection::Perspective(frustum.sheared(tangent)),
        other @ (Projection::Orthographic(_) | Projection::Mcop(_)) => other,
    };
    let view_from_world = DAffine3::from_translation(DVec3::NEG_X * right_m) * view.view_from_world;
    View { view_from_world, projection, shaded_from: Some(view.viewpoint()), ..*view }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Frustum, Orbit, RayField};

    /// Picture column of a world point.
    fn column(view: &View, world: DVec3) -> f64 {
        let Projection::Perspective(f) = view.projection else { unreachable!() };
        let p = view.view_from_world.transform_point3(world);
        (p.x / -p.z - f.left) / (f.right - f.left) * f64::from(view.size[0])
    }

    fn middle() -> View {
        let frustum = Frustum::from_fov(1.0, [100, 100]).unwrap();
        Orbit::default().view(Projection::Perspective(frustum), [100, 100])
    }

    #[test]
    fn near_points_lie_further_left_for_the_right_eye() {
        let rig = Rig::Stereo { eye_distance_m: 0.065, convergence_m: f64::INFINITY };
        let views = rig.views(&middle());
        let disparity = |world| column(&views[0], world) - column(&views[1], world);
        let (near, far) = (disparity(DVec3::Z * 0.5), disparity(DVec3::Z * -0.5));
        assert!(near > far && far > 0.0, "{near} {far}");
        let k = 100.0 * 0.065 / (2.0 * 0.5_f64.tan());
        assert!((near - k / (3.0_f64.sqrt() - 0.5)).abs() < 1e-9);
    }

    #[test]
    fn convergence_puts_its_depth_at_zero_disparity() {
        let rig = Rig::Stereo { eye_distance_m: 0.065, convergence_m: 3.0_f64.sqrt() };
        let views = rig.views(&middle());
        let disparity = |world| column(&views[0], world) - column(&views[1], world);
        assert!(disparity(DVec3::ZERO).abs() < 1e-9);
        assert!(disparity(DVec3::Z * 0.5) > 0.0 && disparity(DVec3::Z * -0.5) < 0.0);
    }

    #[test]
    fn rays_pass_through_the_points_that_they_picture() {
        let world = DVec3::new(0.1, -0.2, 0.3);
        for view in (Rig::Stereo { eye_distance_m: 0.1, convergence_m: 1.0 }).views(&middle()) {
            let rays = RayField::new(&view, DAffine3::IDENTITY);
            let x = column(&view, world);
            let p = view.view_from_world.transform_point3(world);
            let Projection::Perspective(f) = view.projection else { unreachable!() };
            let y = (f.up - p.y / -p.z) / (f.up - f.down) * 100.0;
            let (origin, direction) = rays.at(x, y);
            assert!((origin + direction * -p.z - world).length() < 1e-12);
        }
    }
}
