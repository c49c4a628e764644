//! Controllers and bare hands.

use crate::inside::inside;
use crate::remote::Controller;
use crate::support::{begin, until};
use glam::{DQuat, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Side};
use wheatstone_xr::{SessionEvent, SessionOptions};

fn pose(x: f64, turn_rad: f64) -> Pose {
    Pose {
        position_m: DVec3::new(x, 1.1, -0.4),
        orientation: DQuat::from_rotation_y(turn_rad) * DQuat::from_rotation_x(0.5 * turn_rad),
    }
}

fn is_at(pose: Option<Pose>, expected: &Pose) -> bool {
    pose.is_some_and(|pose| pose.distance_to_m(expected) < 1e-5 && pose.angle_to_rad(expected) < 1e-4)
}

#[test]
fn controllers_act_as_they_are_held_and_pressed() {
    inside(controllers_act_as_they_are_held_and_pressed, |monado| {
        let mut remote = monado.remote();
        let (graphics, mut session) = begin(SessionOptions::default());
        let left = Controller {
            trigger: 0.25,
            squeeze: 0.75,
            stick: [-0.5, 0.25],
            b: true,
            ..Controller::at(pose(-0.25, 0.6))
        };
        let right = Controller { trigger: 1.0, stick: [1.0, -1.0], ..Controller::at(pose(0.3, -0.4)) };
        remote.controller(Side::Left, &left).controller(Side::Right, &right).send();
        let tick = until(&graphics, &mut session, "the controllers", |_, tick| {
            is_at(tick.hands[1].grip, &right.pose) && tick.hands[1].trigger > 0.9
        });
        for (hand, controller) in tick.hands.iter().zip([left, right]) {
            assert!(is_at(hand.grip, &controller.pose) && is_at(hand.aim, &controller.pose), "{hand:?}");
            assert!((hand.trigger - controller.trigger).abs() < 1e-6, "{hand:?}");
            assert!((hand.squeeze - controller.squeeze).abs() < 1e-6, "{hand:?}");
            assert_eq!(hand.stick, controller.stick);
            assert_eq!(hand.menu, controller.b);
        }
        for side in Side::BOTH {
            session.pulse(side, 0.02, 0.5).unwrap();
            session.pulse(side, 0.0, 2.0).unwrap();
        }
        let index = Some("/interaction_profiles/valve/index_controller".to_owned());
        let controllers = SessionEvent::ControllersChanged([index.clone(), index]);
        until(&graphics, &mut session, "the kind of controllers", |session, _| {
            session.events().any(|event| event == controllers)
        });
    });
}

#[test]
fn a_hand_without_a_controller_has_no_pose_and_nothing_pressed() {
    inside(a_hand_without_a_controller_has_no_pose_and_nothing_pressed, |monado| {
        let mut remote = monado.remote();
        let (graphics, mut session) = begin(SessionOptions::default());
        let held = Controller { squeeze: 1.0, ..Controller::at(pose(0.2, 0.1)) };
        remote.controller(Side::Left, &held).controller(Side::Right, &held).send();
        until(&graphics, &mut session, "the controller", |_, tick| tick.hands[0].squeeze == 1.0);
        let put_down = Controller { active: false, ..held };
        remote.controller(Side::Left, &put_down).send();
        let tick = until(&graphics, &mut session, "nothing", |_, tick| tick.hands[0].grip.is_none());
        assert_eq!(tick.hands[0], Hand::default());
        assert_eq!(tick.hands[1].squeeze, 1.0);
    });
}

#[test]
fn bare_hands_pinch() {
    inside(bare_hands_pinch, |monado| {
        let mut remote = monado.remote();
        let (graphics, mut session) = begin(SessionOptions::default());
        let mut pinches = Vec::new();
        for bent in [0.0_f32, 0.5, 1.0, 0.25] {
            let fingers = [0.0, 0.0, 0.0, bent, bent];
            let place = pose(-0.25 - f64::from(bent), 0.6);
            let bare = Controller {
                active: false,
                hand_seen: true,
                curl: fingers,
                trigger: 1.0,
                ..Controller::at(place)
            };
            remote.controller(Side::Left, &bare).controller(Side::Right, &bare).send();
            let is_there = |hand: &Hand| {
                hand.grip.is_some_and(|grip| grip.distance_to_m(&place) < 0.15)
                    && hand.aim.is_some_and(|aim| aim.angle_to_rad(&place) < 1e-4)
            };
            let tick = until(&graphics, &mut session, "the bare hand", |_, tick| is_there(&tick.hands[0]));
            let hand = tick.hands[0];
            assert_eq!((hand.squeeze, hand.trigger, hand.stick, hand.menu), (0.0, 0.0, [0.0; 2], false));
            let pinch = hand.pinch.unwrap();
            assert!(pinch.position_m.distance(place.position_m) < 0.25, "{pinch:?} {place:?}");
            pinches.push(pinch.closed);
        }
        let [open, half, closed, quarter] = pinches[..] else { unreachable!() };
        assert_eq!((open, closed), (0.0, 1.0));
        assert!(quarter < half && half > 0.1 && half < 0.9, "{pinches:?}");
    });
}
