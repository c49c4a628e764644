//! Where the eyes are, from located views.

use crate::space::pose_from_xr;
use openxr as xr;
use std::f32::consts::FRAC_PI_2;
use wheatstone_core::headset::Eye;
use wheatstone_core::view::Frustum;

/// Nearest visible depth, metres: the eye may be inside the volume.
pub(crate) const NEAR_M: f64 = 0.001;

/// Left and right eye; none while the head is not tracked or the views make no pictures.
pub(crate) fn eyes(flags: xr::ViewStateFlags, views: [xr::View; 2]) -> Option<[Eye; 2]> {
    let valid = xr::ViewStateFlags::POSITION_VALID | xr::ViewStateFlags::ORIENTATION_VALID;
    if !flags.contains(valid) {
        return None;
    }
    let eye = |view: xr::View| Some(Eye { pose: pose_from_xr(view.pose)?, frustum: frustum(view.fov)? });
    let [left, right] = views.map(eye);
    Some([left?, right?])
}

/// The frustum of four angles from −Z; none unless they are in order and all in front.
fn frustum(fov: xr::Fovf) -> Option<Frustum> {
    let angles = [fov.angle_left, fov.angle_right, fov.angle_down, fov.angle_up];
    let in_front = angles.iter().all(|angle| angle.abs() < FRAC_PI_2);
    let in_order = fov.angle_left < fov.angle_right && fov.angle_down < fov.angle_up;
    let [left, right, down, up] = angles.map(|angle| f64::from(angle).tan());
    (in_front && in_order).then_some(Frustum { left, right, down, up, near_m: NEAR_M, far_m: f64::INFINITY })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fov(angle_left: f32, angle_right: f32, angle_down: f32, angle_up: f32) -> xr::Fovf {
        xr::Fovf { angle_left, angle_right, angle_up, angle_down }
    }

    #[test]
    fn angles_become_tangents_side_by_side() {
        let frustum = frustum(fov(-0.9, 0.7, -0.8, 0.6)).unwrap();
        let tangents = [frustum.left, frustum.right, frustum.down, frustum.up];
        for (tangent, angle) in tangents.into_iter().zip([-0.9_f32, 0.7, -0.8, 0.6]) {
            assert!((tangent.atan() - f64::from(angle)).abs() < 1e-12, "{tangent} {angle}");
        }
        assert!(frustum.near_m > 0.0 && frustum.far_m.is_infinite());
    }

    #[test]
    fn angles_that_make_no_picture_are_none() {
        for fov in [
            fov(0.0, 0.0, 0.0, 0.0),
            fov(0.7, -0.9, -0.8, 0.6),
            fov(-0.9, 0.7, 0.6, -0.8),
            fov(-1.6, 0.7, -0.8, 0.6),
            fov(f32::NAN, 0.7, -0.8, 0.6),
        ] {
            assert_eq!(frustum(fov), None, "{:?}", [fov.angle_left, fov.angle_right]);
        }
    }

    #[test]
    fn eyes_are_known_only_while_the_head_is() {
        let view = xr::View { pose: xr::Posef::IDENTITY, fov: fov(-0.9, 0.7, -0.8, 0.6) };
        let valid = xr::ViewStateFlags::POSITION_VALID | xr::ViewStateFlags::ORIENTATION_VALID;
        assert!(eyes(valid, [view; 2]).is_some());
        assert_eq!(eyes(xr::ViewStateFlags::ORIENTATION_VALID, [view; 2]), None);
        let blind = xr::View { fov: fov(0.0, 0.0, 0.0, 0.0), ..view };
        assert_eq!(eyes(valid, [view, blind]), None);
    }
}
