//! The eye in the middle between two.

use crate::hands::poses;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::Eye;
use wheatstone_core::view::Frustum;

const NEAREST_M: f64 = 0.25;

fn frustum(left: f64, right: f64, down: f64, up: f64) -> Frustum {
    Frustum { left, right, down, up, near_m: 0.01, far_m: f64::INFINITY }
}

/// Eyes of a head that look straight ahead, with lenses that are each other's mirror images.
fn eyes(head: Pose, outwards: f64) -> [Eye; 2] {
    let frusta = [frustum(-outwards, 1.0, -1.15, 1.05), frustum(-1.0, outwards, -1.15, 1.05)];
    [(-0.032, frusta[0]), (0.032, frusta[1])].map(|(x, frustum)| {
        let position_m = head.position_m + head.orientation * (x * DVec3::X);
        Eye { pose: Pose { position_m, ..head }, frustum }
    })
}

fn sees(eye: &Eye, point: DVec3) -> bool {
    let size = [1000, 1000];
    let within = |at: f64| (-1e-6..=1000.0 + 1e-6).contains(&at);
    eye.view(size).pixel_position(point).is_some_and(|at| within(at.x) && within(at.y))
}

proptest! {
    #[test]
    fn it_sees_all_that_either_sees(head in poses(), outwards in 0.8..1.5_f64, at in prop::array::uniform2(0.0..1.0_f64), depth_m in NEAREST_M..50.0, side in 0..2_usize) {
        let eyes = eyes(head, outwards);
        let middle = Eye::between(&eyes, NEAREST_M).unwrap();
        let Frustum { left, right, down, up, .. } = eyes[side].frustum;
        let [x, y] = [left + at[0] * (right - left), down + at[1] * (up - down)];
        let point = eyes[side].pose.world_from_own().transform_point3(depth_m * DVec3::new(x, y, -1.0));
        prop_assert!(sees(&eyes[side], point));
        prop_assert!(sees(&middle, point));
    }
}

#[test]
fn it_sees_no_more_than_it_must() {
    let head = Pose { position_m: DVec3::new(0.1, 1.6, 0.0), orientation: DQuat::IDENTITY };
    let middle = Eye::between(&eyes(head, 1.2), NEAREST_M).unwrap();
    assert!(middle.pose.distance_to_m(&head) < 1e-12);
    let beside = 0.032 / NEAREST_M;
    let Frustum { left, right, down, up, near_m, far_m } = middle.frustum;
    for (is, expected) in [(left, -1.2 - beside), (right, 1.2 + beside), (down, -1.15), (up, 1.05)] {
        assert!((is - expected).abs() < 1e-12, "{is} {expected}");
    }
    assert_eq!((near_m, far_m), (0.01, f64::INFINITY));
}

#[test]
fn between_canted_displays_there_is_none() {
    let head = Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY };
    let mut canted = eyes(head, 1.2);
    assert!(Eye::between(&canted, NEAREST_M).is_some());
    canted[1].pose.orientation = DQuat::from_rotation_y(-5.0_f64.to_radians());
    assert_eq!(Eye::between(&canted, NEAREST_M), None);
}
