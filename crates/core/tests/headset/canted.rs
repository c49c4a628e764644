//! Eyes of a headset as views: which can share their rays.

use crate::hands::at;
use glam::DQuat;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::Eye;
use wheatstone_core::stereo::{Epipolar, StereoError};
use wheatstone_core::view::{Frustum, View};

const SIZE: [u32; 2] = [1440, 1600];

/// Left and right view of eyes whose displays are turned outwards by an angle, with windows that mirror each other.
fn views(cant_rad: f64) -> [View; 2] {
    let frustum = Frustum { left: -1.4, right: 1.1, down: -1.2, up: 1.0, near_m: 0.01, far_m: 100.0 };
    let head = DQuat::from_rotation_y(0.4) * DQuat::from_rotation_x(-0.3);
    [(-1.0, -1.4, 1.1), (1.0, -1.1, 1.4)].map(|(side, left, right)| {
        let position_m = at(0.2, 1.6, 0.1).position_m + head * glam::DVec3::X * (side * 0.0315);
        let pose = Pose { position_m, orientation: head * DQuat::from_rotation_y(-side * cant_rad) };
        Eye { pose, frustum: Frustum { left, right, ..frustum } }.view(SIZE)
    })
}

#[test]
fn eyes_with_parallel_displays_share_rays_though_their_frusta_differ() {
    let [left, right] = views(0.0);
    let epipolar = Epipolar::new(&left, &right).unwrap();
    assert!((epipolar.eye_distance_m() - 0.063).abs() < 1e-9);
    assert!((epipolar.c() + 0.3 * 1440.0 / 2.5).abs() < 1e-6);
}

#[test]
fn eyes_with_canted_displays_are_refused_with_the_angle_between_them() {
    let [left, right] = views(5.0_f64.to_radians());
    let Err(StereoError::Orientation { angle_rad }) = Epipolar::new(&left, &right) else {
        panic!("{:?}", Epipolar::new(&left, &right));
    };
    assert!((angle_rad - 10.0_f64.to_radians()).abs() < 1e-9);
}
