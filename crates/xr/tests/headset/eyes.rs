//! Where the eyes are and what they see.

use crate::inside::inside;
use crate::support::{begin, until};
use glam::{DQuat, DVec3, EulerRot};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::Eye;
use wheatstone_core::view::Frustum;
use wheatstone_xr::{Floor, SessionOptions};

fn pose(position_m: [f64; 3], turns_rad: [f64; 3]) -> Pose {
    let [yaw, pitch, roll] = turns_rad;
    Pose { position_m: position_m.into(), orientation: DQuat::from_euler(EulerRot::YXZ, yaw, pitch, roll) }
}

fn frustum(angles_rad: [f64; 4]) -> Frustum {
    let [left, right, down, up] = angles_rad.map(f64::tan);
    Frustum { left, right, down, up, near_m: 0.001, far_m: f64::INFINITY }
}

fn is_near(eye: &Eye, expected: &Pose) -> bool {
    eye.pose.distance_to_m(expected) < 1e-5 && eye.pose.angle_to_rad(expected) < 1e-4
}

#[test]
fn eyes_are_where_the_head_is_and_see_what_the_lenses_show() {
    inside(eyes_are_where_the_head_is_and_see_what_the_lenses_show, |monado| {
        let mut remote = monado.remote();
        let (graphics, mut session) = begin(SessionOptions::default());
        assert_eq!(session.floor(), Floor::Stage);
        // Different frusta, different places in the head, and the last pair is canted.
        let pairs = [
            [
                (frustum([-0.9, 0.7, -0.8, 0.6]), pose([-0.031, 0.002, 0.0], [0.0; 3])),
                (frustum([-0.65, 0.95, -0.75, 0.55]), pose([0.034, -0.001, 0.003], [0.0; 3])),
            ],
            [
                (frustum([-1.0, 0.6, -0.7, 0.7]), pose([-0.032, 0.0, 0.0], [0.1, 0.0, 0.02])),
                (frustum([-0.6, 1.0, -0.7, 0.7]), pose([0.032, 0.0, 0.0], [-0.1, 0.0, -0.01])),
            ],
        ];
        let heads = [
            pose([0.3, 1.5, -0.2], [0.4, -0.2, 0.1]),
            pose([0.31, 1.52, -0.2], [0.45, -0.2, 0.1]),
            pose([-0.5, 1.2, 0.7], [-2.5, 0.6, -0.3]),
        ];
        for pair in pairs {
            for head in heads {
                remote.eyes(&pair).head(&head).send();
                let expected = pair.map(|(_, in_head)| Pose {
                    position_m: head.position_m + head.orientation * in_head.position_m,
                    orientation: head.orientation * in_head.orientation,
                });
                let tick = until(&graphics, &mut session, "the head", |_, tick| {
                    tick.eyes.is_some_and(|eyes| is_near(&eyes[0], &expected[0]))
                });
                let eyes = tick.eyes.unwrap();
                for ((eye, expected), (wanted, _)) in eyes.iter().zip(&expected).zip(&pair) {
                    assert!(is_near(eye, expected), "{eye:?} {expected:?}");
                    assert!(eye.pose.orientation.is_normalized());
                    let sides = |f: &Frustum| [f.left, f.right, f.down, f.up];
                    for (is, should) in sides(&eye.frustum).into_iter().zip(sides(wanted)) {
                        assert!((is - should).abs() < 1e-5, "{:?} {wanted:?}", eye.frustum);
                    }
                }
            }
        }
    });
}

#[test]
fn what_lenses_hide_lies_at_the_edge_of_what_eyes_see() {
    inside(what_lenses_hide_lies_at_the_edge_of_what_eyes_see, |_| {
        let (graphics, mut session) = begin(SessionOptions::default());
        let tick = until(&graphics, &mut session, "the eyes", |_, tick| tick.eyes.is_some());
        for (index, eye) in tick.eyes.unwrap().iter().enumerate() {
            let hidden = session.hidden_area(index).unwrap().unwrap();
            assert!(!hidden.triangles.is_empty());
            for [x, y] in hidden.corners.iter().map(|corner| corner.map(f64::from)) {
                let Frustum { left, right, down, up, .. } = eye.frustum;
                assert!(x > left - 1e-4 && x < right + 1e-4 && y > down - 1e-4 && y < up + 1e-4, "{x} {y}");
            }
            // The middle of the view is seen.
            for triangle in &hidden.triangles {
                let [a, b, c] = triangle.map(|corner| {
                    DVec3::from((glam::DVec2::from(hidden.corners[corner as usize].map(f64::from)), 0.0))
                });
                let side = |from: DVec3, to: DVec3| (to - from).cross(-from).z;
                let sides = [side(a, b), side(b, c), side(c, a)];
                let has_middle =
                    sides.iter().all(|side| *side > 1e-9) || sides.iter().all(|side| *side < -1e-9);
                assert!(!has_middle, "{a} {b} {c}");
            }
        }
        assert_eq!(session.hidden_area(2).unwrap(), None);
    });
}
