//! Laws of dragging faces and the plane.

use crate::hands::*;
use glam::{DAffine3, DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Handle, Interaction, Stand};
use wheatstone_core::scene::{Clip, ClipPlane};
use wheatstone_core::view::AnatomicalDirection::Superior;

fn world_from_texture(interaction: &Interaction) -> DAffine3 {
    interaction.placement().world_from_texture()
}

/// From a point, aimed at another.
fn aimed(from_m: DVec3, at_m: DVec3) -> Pose {
    let direction = (at_m - from_m).normalize_or_zero();
    Pose { position_m: from_m, orientation: DQuat::from_rotation_arc(DVec3::NEG_Z, direction) }
}

/// Outside of the middle of a face of the whole volume, aimed at it.
fn before_face(interaction: &Interaction, face: usize) -> Pose {
    let mut middle = DVec3::splat(0.5);
    middle[face % 3] = if face < 3 { 0.0 } else { 1.0 };
    let world_from_texture = world_from_texture(interaction);
    let outwards = world_from_texture.matrix3.col(face % 3) * if face < 3 { -1.0 } else { 1.0 };
    let middle_m = world_from_texture.transform_point3(middle);
    aimed(middle_m + 2.0 * outwards, middle_m)
}

fn drag(interaction: &mut Interaction, pose: Pose) {
    update(interaction, [Hand::default(), pulled(pose)]);
}

fn moved(pose: &Pose, by_m: DVec3) -> Pose {
    Pose { position_m: pose.position_m + by_m, ..*pose }
}

/// The plane as the volume sees it: what it keeps of some points in texture space, metres, signed.
fn heights_m(interaction: &Interaction) -> [f64; 4] {
    let plane = interaction.clip().plane.unwrap();
    let world_from_texture = world_from_texture(interaction);
    [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]
        .map(|corner| plane.normal.dot(world_from_texture.transform_point3(corner)) - plane.offset_m)
}

proptest! {
    #[test]
    fn a_face_goes_with_the_hand_and_stops_at_the_opposite_one(face in 0..6_usize, goes in -0.5..1.5_f64) {
        let mut interaction = interaction();
        let pose = before_face(&interaction, face);
        let inwards_m = world_from_texture(&interaction).matrix3.col(face % 3) * if face < 3 { 1.0 } else { -1.0 };
        let sideways_m = inwards_m.any_orthogonal_vector() * 0.7;
        drag(&mut interaction, pose);
        prop_assert_eq!(interaction.clip(), Clip::default());
        prop_assert_eq!(interaction.hovered()[1].unwrap().handle, Handle::Face(face));
        drag(&mut interaction, moved(&pose, goes * inwards_m + sideways_m));
        let mut expected = Clip::default();
        expected.move_face(face, if face < 3 { goes } else { 1.0 - goes });
        let found = interaction.clip();
        prop_assert!((found.box_lo - expected.box_lo).length() < ROUNDING, "{:?}", found);
        prop_assert!((found.box_hi - expected.box_hi).length() < ROUNDING, "{:?}", found);
        // And back, from beyond the opposite face, too.
        drag(&mut interaction, pose);
        prop_assert_eq!(interaction.clip(), Clip::default());
    }

    #[test]
    fn a_face_goes_with_the_far_end_of_the_rod_when_the_hand_turns(face in 0..6_usize, turn in prop::array::uniform3(-0.2..0.2_f64)) {
        let mut interaction = interaction();
        let pose = before_face(&interaction, face);
        drag(&mut interaction, pose);
        let picked_m = interaction.hovered()[1].unwrap().point_m;
        let turn = DQuat::from_scaled_axis(turn.into());
        let turned = Pose { orientation: turn * pose.orientation, ..pose };
        drag(&mut interaction, turned);
        let end_m = pose.position_m + turn * (picked_m - pose.position_m);
        prop_assert!((interaction.hovered()[1].unwrap().point_m - end_m).length() < ROUNDING);
        let end = world_from_texture(&interaction).inverse().transform_point3(end_m);
        let mut expected = Clip::default();
        expected.move_face(face, end[face % 3]);
        prop_assert!((interaction.clip().face(face) - expected.face(face)).abs() < ROUNDING);
    }

    #[test]
    fn a_face_stays_under_the_hand_when_the_other_hand_carries_the_volume(carry in poses()) {
        let mut interaction = interaction();
        let pose = before_face(&interaction, 4);
        let inwards_m = -0.3 * world_from_texture(&interaction).matrix3.col(1);
        let grip = at(-0.3, 1.0, 0.0);
        update(&mut interaction, [closed(grip), pulled(pose)]);
        // Both hands go along together: the face stays where it is in the volume.
        let turn = carry.orientation;
        let together = |pose: &Pose| Pose {
            position_m: turn * pose.position_m + carry.position_m,
            orientation: turn * pose.orientation,
        };
        update(&mut interaction, [closed(together(&grip)), pulled(together(&pose))]);
        prop_assert!((interaction.clip().face(4) - 1.0).abs() < ROUNDING);
        update(&mut interaction, [closed(together(&grip)), pulled(together(&moved(&pose, inwards_m)))]);
        prop_assert!((interaction.clip().face(4) - 0.7).abs() < ROUNDING, "{:?}", interaction.clip());
    }

    #[test]
    fn a_plane_goes_along_with_the_volume(from in (poses(), poses()), to in (poses(), poses())) {
        prop_assume!(from.0.distance_to_m(&from.1) > 0.1 && to.0.distance_to_m(&to.1) > 0.1);
        let mut interaction = with_plane();
        let before = heights_m(&interaction);
        let scale = interaction.stand().longest_side_m;
        for (left, right) in [from, to] {
            let changes = update(&mut interaction, [closed(left), closed(right)]);
            prop_assert!(!changes.has_moved || changes.has_clipped);
        }
        let grown = interaction.stand().longest_side_m / scale;
        for (now, before) in heights_m(&interaction).into_iter().zip(before) {
            prop_assert!((now - grown * before).abs() < ROUNDING * (1.0 + grown));
        }
    }

    #[test]
    fn a_plane_is_fixed_to_the_hand_that_drags_it(turn in prop::array::uniform3(-0.3..0.3_f64), by in prop::array::uniform3(-0.03..0.03_f64)) {
        let mut interaction = with_plane();
        let plane = interaction.clip().plane.unwrap();
        let middle_m = stand().pose.position_m;
        let pose = aimed(middle_m + DVec3::new(0.05, 0.03, 0.5), middle_m);
        drag(&mut interaction, pose);
        prop_assert_eq!(interaction.hovered()[1].unwrap().handle, Handle::Plane);
        prop_assert_eq!(interaction.clip().plane.unwrap(), plane);
        let turn = DQuat::from_scaled_axis(turn.into());
        // About the middle of the volume, so that the plane stays in it.
        let motion = DAffine3::from_translation(middle_m + DVec3::from(by)) * DAffine3::from_quat(turn) * DAffine3::from_translation(-middle_m);
        let after = Pose { position_m: motion.transform_point3(pose.position_m), orientation: turn * pose.orientation };
        drag(&mut interaction, after);
        let found = interaction.clip().plane.unwrap();
        prop_assert!((found.normal - turn * plane.normal).length() < ROUNDING);
        let foot = motion.transform_point3(plane.normal * plane.offset_m);
        prop_assert!((found.normal.dot(foot) - found.offset_m).abs() < ROUNDING);
        drag(&mut interaction, pose);
        prop_assert_eq!(interaction.clip().plane.unwrap(), plane);
    }

    #[test]
    fn a_plane_that_is_dragged_never_leaves_the_volume(path in prop::collection::vec(poses(), 1..10)) {
        let mut interaction = with_plane();
        let middle_m = stand().pose.position_m;
        drag(&mut interaction, aimed(middle_m + DVec3::new(0.05, 0.03, 0.5), middle_m));
        for pose in path {
            drag(&mut interaction, pose);
            let plane = interaction.clip().plane.unwrap();
            let world_from_texture = world_from_texture(&interaction);
            let sides: Vec<bool> = (0..8)
                .map(|bits| DVec3::from([0, 1, 2].map(|axis| f64::from(bits >> axis & 1))))
                .map(|corner| plane.normal.dot(world_from_texture.transform_point3(corner)) >= plane.offset_m)
                .collect();
            prop_assert!(sides.contains(&true) && sides.contains(&false));
        }
    }

    #[test]
    fn what_is_picked_is_where_the_ray_meets_what_is_visible(from in poses(), target in prop::array::uniform3(0.0..1.0_f64), has_plane: bool) {
        let mut interaction = if has_plane { with_plane() } else { interaction() };
        let world_from_texture = world_from_texture(&interaction);
        let pose = aimed(from.position_m, world_from_texture.transform_point3(target.into()));
        update(&mut interaction, [hand(pose), Hand::default()]);
        let clip = interaction.clip();
        let is_visible = |point_m: DVec3| {
            let point = world_from_texture.inverse().transform_point3(point_m);
            let is_kept = clip.plane.is_none_or(|plane| plane.normal.dot(point_m) >= plane.offset_m);
            is_kept && point.min_element() >= 0.0 && point.max_element() <= 1.0
        };
        // The first point of the ray that is visible, by many small steps.
        let direction = pose.orientation * DVec3::NEG_Z;
        let step_m = 1e-3;
        let along = |step: i32| pose.position_m + f64::from(step) * step_m * direction;
        let starts_in = is_visible(pose.position_m);
        let first = (0..4000).find(|&step| is_visible(along(step)) != starts_in);
        let Some(picked) = interaction.hovered()[0] else {
            prop_assert!(first.is_none(), "{:?}", first);
            return Ok(());
        };
        let Some(first) = first else {
            // Shorter than a step, or a plane where nothing is visible.
            return Ok(());
        };
        let off_m = (picked.point_m - along(first)).length();
        let is_plane_beyond = picked.handle == Handle::Plane && clip.plane.is_some_and(|plane| (plane.normal.dot(picked.point_m) - plane.offset_m).abs() < ROUNDING);
        prop_assert!(off_m < 2.0 * step_m || is_plane_beyond || starts_in, "{} {:?}", off_m, picked);
        if starts_in {
            prop_assert!(off_m < 2.0 * step_m, "{} {:?}", off_m, picked);
        }
    }
}

#[test]
fn a_hand_within_the_volume_pushes_the_face_that_it_points_at() {
    let mut interaction = interaction();
    let world_from_texture = world_from_texture(&interaction);
    let [middle_m, side_m] = [DVec3::new(0.5, 0.5, 0.5), DVec3::new(0.5, 0.5, 0.0)]
        .map(|at| world_from_texture.transform_point3(at));
    let pose = aimed(middle_m, side_m);
    drag(&mut interaction, pose);
    assert_eq!(interaction.hovered()[1].unwrap().handle, Handle::Face(2));
    drag(&mut interaction, moved(&pose, -0.4 * (side_m - middle_m)));
    assert!((interaction.clip().box_lo.z - 0.2).abs() < ROUNDING);
}

#[test]
fn a_pull_in_the_void_drags_nothing_until_it_is_let_go() {
    let mut interaction = interaction();
    let pose = before_face(&interaction, 3);
    let away = Pose { orientation: pose.orientation * DQuat::from_rotation_y(3.0), ..pose };
    let pull = |interaction: &mut Interaction, pose| update(interaction, [Hand::default(), pulled(pose)]);
    assert_eq!(pull(&mut interaction, away).grabbed, [false; 2]);
    for by_m in [0.0, 0.1] {
        let changes = pull(&mut interaction, moved(&pose, DVec3::splat(by_m)));
        assert!(!changes.has_clipped && changes.grabbed == [false; 2]);
    }
    update(&mut interaction, [Hand::default(), hand(pose)]);
    assert_eq!(pull(&mut interaction, pose).grabbed, [false, true]);
}

#[test]
fn holding_the_volume_beats_dragging() {
    let mut interaction = interaction();
    let pose = before_face(&interaction, 3);
    let all = Hand { squeeze: 1.0, ..pulled(pose) };
    update(&mut interaction, [Hand::default(), all]);
    assert_eq!(interaction.hovered(), [None; 2]);
    let further = Hand { squeeze: 1.0, ..pulled(moved(&pose, DVec3::X)) };
    let changes = update(&mut interaction, [Hand::default(), further]);
    assert!(changes.has_moved && !changes.has_clipped);
    // A drag that is under way ends when the hand closes, and does not come back when it opens.
    let mut interaction = crate::hands::interaction();
    drag(&mut interaction, pose);
    update(&mut interaction, [Hand::default(), all]);
    drag(&mut interaction, pose);
    let changes = update(&mut interaction, [Hand::default(), pulled(moved(&pose, DVec3::splat(0.05)))]);
    assert!(!changes.has_moved && !changes.has_clipped);
}

#[test]
fn a_hand_that_is_lost_while_it_drags_goes_on_without_a_jump() {
    let mut interaction = interaction();
    let pose = before_face(&interaction, 3);
    let inwards_m = -world_from_texture(&interaction).matrix3.col(0);
    drag(&mut interaction, pose);
    drag(&mut interaction, moved(&pose, 0.2 * inwards_m));
    update(&mut interaction, [Hand::default(); 2]);
    assert_eq!(interaction.hovered(), [None; 2]);
    let found = moved(&pose, DVec3::new(0.4, -0.2, 0.3));
    drag(&mut interaction, found);
    assert!((interaction.clip().box_hi.x - 0.8).abs() < ROUNDING);
    drag(&mut interaction, moved(&found, 0.1 * inwards_m));
    assert!((interaction.clip().box_hi.x - 0.7).abs() < ROUNDING);
}

#[test]
fn two_hands_drag_two_faces_but_not_one() {
    let mut interaction = interaction();
    let [low, high] = [before_face(&interaction, 0), before_face(&interaction, 3)];
    let along_m = world_from_texture(&interaction).matrix3.col(0);
    let changes = update(&mut interaction, [pulled(high), pulled(high)]);
    assert_eq!(changes.grabbed, [true, false]);
    update(&mut interaction, [hand(low), hand(high)]);
    assert_eq!(update(&mut interaction, [pulled(low), pulled(high)]).grabbed, [true, true]);
    update(&mut interaction, [pulled(moved(&low, 0.3 * along_m)), pulled(moved(&high, -0.2 * along_m))]);
    let clip = interaction.clip();
    assert!((clip.box_lo.x - 0.3).abs() < ROUNDING && (clip.box_hi.x - 0.8).abs() < ROUNDING, "{clip:?}");
    assert_eq!([clip.box_lo.y, clip.box_hi.y], [0.0, 1.0]);
}

#[test]
fn a_plane_that_hides_everything_can_be_taken_again() {
    let clip = Clip { box_lo: DVec3::new(0.0, 0.0, 0.6), ..Clip::default() };
    let mut interaction = Interaction::new(&grid(), Superior, stand(), &clip);
    let world_from_texture = world_from_texture(&interaction);
    // Keeps the other part of the volume.
    let normal = -world_from_texture.matrix3.col(2).normalize_or_zero();
    let point_m = world_from_texture.transform_point3(DVec3::new(0.5, 0.5, 0.4));
    let plane = Some(ClipPlane { normal, offset_m: normal.dot(point_m) });
    interaction.show(&Clip { plane, ..clip });
    update(&mut interaction, [hand(aimed(point_m + 0.5 * normal, point_m)), Hand::default()]);
    assert_eq!(interaction.hovered()[0].unwrap().handle, Handle::Plane);
    let stand: &Stand = interaction.stand();
    assert_eq!(*stand, crate::hands::stand());
}
