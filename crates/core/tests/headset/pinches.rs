//! Laws of bare hands.

use crate::hands::*;
use glam::DVec3;
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Handle, Interaction, Pinch, Stand};
use wheatstone_core::scene::Clip;

/// A bare hand whose fingers are somewhere, its palm behind them.
fn bare(fingers_m: DVec3, closed: f32) -> Hand {
    let palm = Pose { position_m: fingers_m + DVec3::new(0.0, -0.05, 0.1), ..at(0.0, 0.0, 0.0) };
    Hand { pinch: Some(Pinch { position_m: fingers_m, closed }), ..hand(palm) }
}

fn pinch(interaction: &mut Interaction, fingers_m: DVec3, closed: f32) {
    update(interaction, [Hand::default(), bare(fingers_m, closed)]);
}

/// A place in texture space in the room, and one a little outwards of a face there.
fn place(interaction: &Interaction, in_texture: DVec3) -> DVec3 {
    interaction.placement().world_from_texture().transform_point3(in_texture)
}

fn before_face(interaction: &Interaction, face: usize, distance_m: f64) -> DVec3 {
    let mut on_face = DVec3::new(0.4, 0.5, 0.6);
    on_face[face % 3] = if face < 3 { 0.0 } else { 1.0 };
    let side_m = interaction.placement().world_from_texture().matrix3.col(face % 3);
    let outwards = side_m.normalize_or_zero() * if face < 3 { -1.0 } else { 1.0 };
    place(interaction, on_face) + distance_m * outwards
}

proptest! {
    #[test]
    fn fingers_that_close_near_a_face_drag_it(face in 0..6_usize, beside_m in -0.015..0.02_f64, goes in 0.0..0.6_f64) {
        let mut interaction = interaction();
        let from_m = before_face(&interaction, face, beside_m);
        pinch(&mut interaction, from_m, 0.2);
        prop_assert_eq!(interaction.hovered()[1].unwrap().handle, Handle::Face(face));
        let changes = update(&mut interaction, [Hand::default(), bare(from_m, 0.9)]);
        prop_assert_eq!((changes.grabbed, changes.has_moved, changes.has_clipped), ([false, true], false, false));
        let inwards_m = interaction.placement().world_from_texture().matrix3.col(face % 3) * if face < 3 { 1.0 } else { -1.0 };
        pinch(&mut interaction, from_m + goes * inwards_m + 0.3 * inwards_m.any_orthogonal_vector(), 0.9);
        let mut expected = Clip::default();
        expected.move_face(face, if face < 3 { goes } else { 1.0 - goes });
        let found = interaction.clip();
        prop_assert!((found.box_lo - expected.box_lo).length() < ROUNDING, "{:?}", found);
        prop_assert!((found.box_hi - expected.box_hi).length() < ROUNDING, "{:?}", found);
        prop_assert_eq!(*interaction.stand(), stand());
        // What is let go stays.
        pinch(&mut interaction, from_m, 0.0);
        prop_assert_eq!(interaction.clip(), found);
    }

    #[test]
    fn fingers_that_close_elsewhere_carry_the_volume_as_a_squeeze_does(away in prop::array::uniform3(-0.5..0.5_f64), to in poses()) {
        let fingers_m = stand().pose.position_m + DVec3::from(away).normalize_or(DVec3::X) * 0.6;
        let (mut by_pinch, mut by_squeeze) = (interaction(), interaction());
        for fingers_m in [fingers_m, to.position_m] {
            let hand = bare(fingers_m, 0.8);
            update(&mut by_pinch, [Hand::default(), hand]);
            update(&mut by_squeeze, [Hand::default(), Hand { squeeze: 0.8, pinch: None, ..hand }]);
        }
        prop_assert!(apart(by_pinch.stand(), &stand()) > 0.0 && by_pinch.clip() == Clip::default());
        prop_assert_eq!(by_pinch.stand(), by_squeeze.stand());
    }

    #[test]
    fn fingers_that_are_nowhere_do_nothing(what in 0..3_usize, closed in prop::num::f32::ANY) {
        let mut interaction = interaction();
        let from_m = before_face(&interaction, 0, 0.0);
        let nowhere = DVec3::splat([f64::NAN, f64::INFINITY, 1e9][what]);
        let hands = [bare(nowhere, closed), Hand { aim: None, grip: None, ..bare(from_m, closed) }];
        let changes = update(&mut interaction, hands);
        prop_assert_eq!(changes.grabbed, [false; 2]);
        prop_assert_eq!((*interaction.stand(), interaction.clip()), (stand(), Clip::default()));
    }
}

#[test]
fn what_fingers_have_taken_they_hold_wherever_they_go() {
    let mut interaction = interaction();
    let middle_m = place(&interaction, DVec3::splat(0.5));
    pinch(&mut interaction, middle_m, 0.9);
    let to_m = before_face(&interaction, 4, 0.0);
    pinch(&mut interaction, to_m, 0.9);
    assert!(
        (interaction.stand().pose.position_m - stand().pose.position_m - (to_m - middle_m)).length()
            < ROUNDING
    );
    assert_eq!(interaction.clip(), Clip::default());
}

#[test]
fn two_pinches_scale() {
    let mut interaction = interaction();
    let middle_m = stand().pose.position_m;
    let apart = |m: f64| [bare(middle_m - m * DVec3::X, 1.0), bare(middle_m + m * DVec3::X, 1.0)];
    update(&mut interaction, apart(0.3));
    update(&mut interaction, apart(0.6));
    assert!((interaction.stand().longest_side_m / stand().longest_side_m - 2.0).abs() < ROUNDING);
}

#[test]
fn the_plane_is_dragged_where_it_cuts_and_faces_it_has_cut_away_are_not() {
    let mut interaction = with_plane();
    let plane = interaction.clip().plane.unwrap();
    let (normal, length) = (plane.normal.normalize_or_zero(), plane.normal.length());
    let middle_m = place(&interaction, DVec3::splat(0.5));
    let foot_m = middle_m - normal * (normal.dot(middle_m) - plane.offset_m / length);
    pinch(&mut interaction, foot_m + 0.01 * normal, 0.9);
    assert_eq!(interaction.hovered()[1].unwrap().handle, Handle::Plane);
    pinch(&mut interaction, foot_m + 0.03 * normal, 0.9);
    let moved = interaction.clip().plane.unwrap();
    let by_m = moved.offset_m / moved.normal.length() - plane.offset_m / length;
    assert!((by_m - 0.02).abs() < ROUNDING, "{by_m}");
    pinch(&mut interaction, foot_m, 0.0);

    // The corner that is cut away the furthest.
    let corners = (0..8_u32).map(|bits| DVec3::from([0, 1, 2].map(|axis| f64::from(bits >> axis & 1))));
    let corners = corners.map(|corner| place(&interaction, corner));
    let furthest_m = corners.min_by(|a, b| normal.dot(*a).total_cmp(&normal.dot(*b))).unwrap();
    pinch(&mut interaction, furthest_m, 0.2);
    assert_eq!(interaction.hovered()[1], None);
}

#[test]
fn a_small_volume_can_still_be_held() {
    let mut interaction = interaction();
    interaction.put(Stand { longest_side_m: 0.05, ..stand() });
    let middle_m = place(&interaction, DVec3::splat(0.5));
    pinch(&mut interaction, middle_m, 0.9);
    pinch(&mut interaction, middle_m + 0.1 * DVec3::Y, 0.9);
    assert!(
        (interaction.stand().pose.position_m - stand().pose.position_m - 0.1 * DVec3::Y).length() < ROUNDING
    );
}
