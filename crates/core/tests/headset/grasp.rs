//! Laws of taking hold of the volume.

use crate::hands::*;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Interaction, LONGEST_SIDES_M, Stand};

/// Ticks of two hands that press and let go, are lost and found again.
fn any_hands() -> impl Strategy<Value = [Hand; 2]> {
    let squeeze = || prop_oneof![Just(0.0_f32), Just(1.0_f32), 0.0_f32..=1.0];
    let hand = || {
        (prop::option::weighted(0.8, poses()), squeeze(), squeeze()).prop_map(|(pose, squeeze, trigger)| {
            Hand { grip: pose, aim: pose, squeeze, trigger, ..Hand::default() }
        })
    };
    (hand(), hand()).prop_map(|(left, right)| [left, right])
}

/// The volume as a grip sees it.
fn seen_from(grip: &Pose, stand: &Stand) -> Stand {
    let back = grip.orientation.inverse();
    let pose = Pose {
        position_m: back * (stand.pose.position_m - grip.position_m),
        orientation: back * stand.pose.orientation,
    };
    Stand { pose, ..*stand }
}

fn both(interaction: &mut Interaction, [left, right]: [Pose; 2]) {
    update(interaction, [closed(left), closed(right)]);
}

proptest! {
    #[test]
    fn what_one_hand_holds_is_fixed_to_it(path in prop::collection::vec(poses(), 2..40), side in 0..2_usize) {
        let mut interaction = interaction();
        let hands = |pose: &Pose| {
            let mut hands = [Hand::default(); 2];
            hands[side] = closed(*pose);
            hands
        };
        let changes = update(&mut interaction, hands(&path[0]));
        prop_assert!(changes.grabbed[side] && !changes.grabbed[1 - side]);
        let seen = seen_from(&path[0], &stand());
        for pose in &path {
            let changes = update(&mut interaction, hands(pose));
            prop_assert_eq!(changes.grabbed, [false; 2]);
            let now = seen_from(pose, interaction.stand());
            prop_assert!(apart(&now, &seen) < ROUNDING, "{:?} {:?}", now, seen);
        }
        // Back where it began, bit for bit: nothing has added up.
        update(&mut interaction, hands(&path[0]));
        prop_assert_eq!(*interaction.stand(), stand());
    }

    #[test]
    fn hands_that_do_not_move_change_nothing(before in prop::collection::vec(any_hands(), 1..8), rest in 1..5_usize) {
        let mut interaction = interaction();
        for hands in &before {
            update(&mut interaction, *hands);
        }
        // A change of what is held takes effect at once; then all is at rest.
        let last = before[before.len() - 1];
        let rested = (*interaction.stand(), interaction.clip(), interaction.hovered());
        for _ in 0..rest {
            let changes = update(&mut interaction, last);
            prop_assert!(!changes.has_moved && !changes.has_clipped && changes.grabbed == [false; 2]);
            prop_assert_eq!((*interaction.stand(), interaction.clip(), interaction.hovered()), rested);
        }
    }

    #[test]
    fn nothing_jumps_when_hands_take_hold_or_let_go(ticks in prop::collection::vec(any_hands(), 1..30), tremble_m in 0.0..1e-6_f64) {
        // Hands that hardly move, whatever they press and whenever they are lost, hardly move the volume.
        let poses = [at(-0.2, 1.3, -0.4), at(0.25, 1.35, -0.5)];
        let mut interaction = interaction();
        for (number, hands) in ticks.iter().enumerate() {
            let before = *interaction.stand();
            let trembling = [0, 1].map(|side: usize| {
                let mut pose = poses[side];
                pose.position_m.y += if number % 2 == 0 { tremble_m } else { 0.0 };
                let tracked = hands[side].grip.map(|_| pose);
                Hand { grip: tracked, aim: tracked, trigger: 0.0, ..hands[side] }
            });
            update(&mut interaction, trembling);
            prop_assert!(apart(interaction.stand(), &before) <= 10.0 * tremble_m);
        }
    }

    #[test]
    fn two_hands_and_back_are_undone(path in prop::collection::vec((poses(), poses()), 1..20)) {
        // Within the limits of scale, and with hands that are not all but in one place.
        let lengths: Vec<f64> = path.iter().map(|(left, right)| left.distance_to_m(right)).collect();
        prop_assume!(lengths.iter().all(|length| *length > 0.1 && length / lengths[0] > 0.07));
        // No line turns back on itself: there is no shortest turn then.
        let lines: Vec<DVec3> =
            path.iter().zip(&lengths).map(|((left, right), length)| (right.position_m - left.position_m) / *length).collect();
        prop_assume!(lines.windows(2).all(|pair| pair[0].dot(pair[1]) > -0.99));
        let mut interaction = interaction();
        for (left, right) in path.iter().chain(path.iter().rev()) {
            both(&mut interaction, [*left, *right]);
        }
        prop_assert!(apart(interaction.stand(), &stand()) < 1e-9, "{:?}", interaction.stand());
    }

    #[test]
    fn two_hands_move_turn_and_scale_as_a_similarity_of_their_own(
        from in (poses(), poses()), turn in prop::array::uniform3(-2.5..2.5_f64), growth in 0.3..3.0_f64,
        by in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        prop_assume!(from.0.distance_to_m(&from.1) > 0.1);
        // Both grips go along with a similarity, which the volume then does, too: twist and all, step by step.
        let (axis_turn, by) = (DVec3::from(turn), DVec3::from(by));
        let middle = from.0.position_m.midpoint(from.1.position_m);
        let moved = |pose: &Pose, share: f64| {
            let turn = DQuat::from_scaled_axis(share * axis_turn);
            let scale = growth.powf(share);
            Pose {
                position_m: middle + share * by + scale * (turn * (pose.position_m - middle)),
                orientation: (turn * pose.orientation).normalize(),
            }
        };
        let mut interaction = interaction();
        for step in 0..=50 {
            let share = f64::from(step) / 50.0;
            both(&mut interaction, [moved(&from.0, share), moved(&from.1, share)]);
        }
        let expected = Stand { pose: moved(&stand().pose, 1.0), longest_side_m: growth * stand().longest_side_m };
        prop_assert!(apart(interaction.stand(), &expected) < 1e-9, "{:?} {:?}", interaction.stand(), expected);
    }

    #[test]
    fn whatever_hands_do_the_volume_stays_somewhere(ticks in prop::collection::vec(any_hands(), 1..60)) {
        let mut interaction = with_plane();
        for hands in ticks {
            update(&mut interaction, hands);
            let stand = interaction.stand();
            prop_assert!(stand.pose.is_valid());
            prop_assert!((LONGEST_SIDES_M[0]..=LONGEST_SIDES_M[1]).contains(&stand.longest_side_m));
            let clip = interaction.clip();
            prop_assert!((clip.box_hi - clip.box_lo).min_element() > 0.009);
            let plane = clip.plane.unwrap();
            prop_assert!((plane.normal.length() - 1.0).abs() < ROUNDING && plane.offset_m.is_finite());
        }
    }

    #[test]
    fn hands_in_one_place_carry_the_volume_and_do_no_more(place in poses(), to in poses(), offset_m in 0.0..0.009_f64) {
        let beside = |pose: &Pose| Pose { position_m: pose.position_m + offset_m * DVec3::X, ..*pose };
        let mut interaction = interaction();
        both(&mut interaction, [place, beside(&place)]);
        both(&mut interaction, [to, beside(&to)]);
        let moved = Pose { position_m: stand().pose.position_m + to.position_m - place.position_m, ..stand().pose };
        let expected = Stand { pose: moved, ..stand() };
        prop_assert!(apart(interaction.stand(), &expected) < ROUNDING);
    }
}

#[test]
fn orientations_stay_of_unit_length() {
    let mut interaction = interaction();
    for update in 0..100_000 {
        let angle_rad = 0.01 * f64::from(update);
        let turned = |pose: Pose, rate: f64| Pose {
            position_m: pose.position_m
                + 0.1 * DVec3::new((rate * angle_rad).sin(), (0.7 * angle_rad).cos(), 0.0),
            orientation: DQuat::from_scaled_axis(rate * angle_rad * DVec3::new(0.3, 0.8, -0.5)),
        };
        both(&mut interaction, [turned(at(-0.2, 1.3, -0.4), 1.0), turned(at(0.3, 1.3, -0.5), 1.3)]);
    }
    let stand = interaction.stand();
    assert!((stand.pose.orientation.length() - 1.0).abs() < 1e-15 * 4.0);
    assert!(stand.pose.position_m.is_finite() && apart(stand, &crate::hands::stand()) > 0.01);
}

#[test]
fn scale_ends_at_its_limits_and_turns_back_at_once() {
    let apart_m = |distance_m: f64| [at(-0.5 * distance_m, 1.3, -0.5), at(0.5 * distance_m, 1.3, -0.5)];
    let mut interaction = interaction();
    both(&mut interaction, apart_m(0.02));
    both(&mut interaction, apart_m(2.0));
    assert_eq!(interaction.stand().longest_side_m, LONGEST_SIDES_M[1]);
    both(&mut interaction, apart_m(1.0));
    assert!((interaction.stand().longest_side_m - 0.5 * LONGEST_SIDES_M[1]).abs() < 1e-9);
    both(&mut interaction, apart_m(1e-2));
    both(&mut interaction, apart_m(1.0));
    both(&mut interaction, apart_m(0.01));
    assert!(interaction.stand().longest_side_m >= LONGEST_SIDES_M[0]);
}

#[test]
fn a_lost_hand_holds_still_and_goes_on_without_a_jump() {
    let mut interaction = interaction();
    let lost = Hand::default();
    update(&mut interaction, [lost, closed(at(0.2, 1.2, -0.3))]);
    update(&mut interaction, [lost, closed(at(0.3, 1.2, -0.3))]);
    let carried = *interaction.stand();
    assert!(apart(&carried, &stand()) > 0.09);
    for _ in 0..3 {
        update(&mut interaction, [lost, lost]);
        assert_eq!(*interaction.stand(), carried);
    }
    // Found elsewhere, still closed: no new grab, no jump.
    let changes = update(&mut interaction, [lost, closed(at(-0.4, 1.5, 0.1))]);
    assert_eq!((*interaction.stand(), changes.grabbed), (carried, [false; 2]));
    update(&mut interaction, [lost, closed(at(-0.4, 1.7, 0.1))]);
    let moved_m = interaction.stand().pose.position_m - carried.pose.position_m;
    assert!((moved_m - 0.2 * DVec3::Y).length() < ROUNDING);
    // Found open: let go.
    update(&mut interaction, [lost, lost]);
    update(&mut interaction, [lost, hand(at(0.0, 0.0, 0.0))]);
    let left = *interaction.stand();
    update(&mut interaction, [lost, hand(at(1.0, 0.0, 0.0))]);
    assert_eq!(*interaction.stand(), left);
}

#[test]
fn letting_go_of_one_hand_goes_on_with_the_other() {
    let mut interaction = interaction();
    let [left, right] = [at(-0.2, 1.2, -0.3), at(0.2, 1.2, -0.3)];
    both(&mut interaction, [left, right]);
    update(&mut interaction, [closed(left), hand(right)]);
    assert_eq!(*interaction.stand(), stand());
    let turned = Pose { orientation: DQuat::from_rotation_z(0.5), ..left };
    update(&mut interaction, [closed(turned), hand(at(2.0, 2.0, 2.0))]);
    let seen = seen_from(&turned, interaction.stand());
    assert!(apart(&seen, &seen_from(&left, &stand())) < ROUNDING);
    assert!(interaction.stand().pose.angle_to_rad(&stand().pose) > 0.49);
}

#[test]
fn untracked_hands_and_poses_that_are_none_never_grab() {
    let mut interaction = interaction();
    let nothing = Hand { squeeze: 1.0, trigger: 1.0, ..Hand::default() };
    let broken = closed(Pose { position_m: DVec3::NAN, ..at(0.0, 0.0, 0.0) });
    let flat = closed(Pose { orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..at(0.0, 0.0, 0.0) });
    for hands in [[nothing, nothing], [broken, flat], [flat, broken], [nothing, broken]] {
        let changes = update(&mut interaction, hands);
        assert_eq!((changes.grabbed, changes.has_moved), ([false; 2], false));
    }
    // Beyond all that is finite.
    let far = |x| closed(at(x, 0.0, 0.0));
    for hands in [[far(1e308), far(-1e308)], [far(-1e308), far(1e308)], [far(1.0), far(1e300)]] {
        update(&mut interaction, hands);
        assert!(interaction.stand().pose.is_valid(), "{:?}", interaction.stand());
    }
}
