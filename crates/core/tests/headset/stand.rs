//! Where the volume is at first.

use crate::hands::*;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Hand, Interaction, Scale, Stand, Tick};
use wheatstone_core::scene::Clip;
use wheatstone_core::view::AnatomicalDirection::{self, Anterior, Superior};
use wheatstone_core::view::Frustum;
use wheatstone_core::volume::Grid;

fn world_from_patient_direction(
    stand: &Stand,
    grid: &Grid,
    up: AnatomicalDirection,
    patient: DVec3,
) -> DVec3 {
    let world_from_texture = stand.placement(grid, up).world_from_texture();
    let world_from_patient = world_from_texture * grid.patient_from_texture().inverse();
    world_from_patient.transform_vector3(patient).normalize_or_zero()
}

proptest! {
    #[test]
    fn the_patient_is_upright_and_faces_the_eyes(eyes in poses(), pitch_rad in -1.4..1.4_f64, roll_rad in -0.5..0.5_f64, yaw_rad in -3.1..3.1_f64) {
        let tilt = DQuat::from_rotation_x(pitch_rad);
        let eyes = Pose { orientation: DQuat::from_rotation_y(yaw_rad) * tilt, ..eyes };
        let grid = grid();
        let stand = Stand::before(&eyes, &grid, Superior, Scale::Human);
        let up = world_from_patient_direction(&stand, &grid, Superior, DVec3::Z);
        prop_assert!((up - DVec3::Y).length() < ROUNDING, "{up}");
        let nose = world_from_patient_direction(&stand, &grid, Superior, DVec3::Y);
        let to_eyes = (eyes.position_m - stand.pose.position_m).with_y(0.0).normalize_or_zero();
        prop_assert!((nose - to_eyes).length() < ROUNDING, "{nose} {to_eyes}");
        // In the direction that the eyes look, however far up or down.
        let ahead = DQuat::from_rotation_y(yaw_rad) * DVec3::NEG_Z;
        prop_assert!((ahead + to_eyes).length() < ROUNDING);
        // A head that is also tilted to the side does not tilt the volume.
        let rolled = Pose { orientation: eyes.orientation * DQuat::from_rotation_z(roll_rad), ..eyes };
        let stand = Stand::before(&rolled, &grid, Superior, Scale::Human);
        let up = world_from_patient_direction(&stand, &grid, Superior, DVec3::Z);
        prop_assert!((up - DVec3::Y).length() < ROUNDING, "{up}");
    }

    #[test]
    fn nothing_is_too_near_for_comfort(dims in prop::array::uniform3(1..200_usize), spacing_mm in 0.1..20.0_f64) {
        let grid = Grid::centred(dims, [spacing_mm; 3]).unwrap();
        let eyes = at(0.0, 1.6, 0.0);
        for scale in [Scale::Human, Scale::True] {
            for up in [Superior, Anterior] {
                let stand = Stand::before(&eyes, &grid, up, scale);
                let world_from_texture = stand.placement(&grid, up).world_from_texture();
                let nearest_m = (0..8)
                    .map(|bits| DVec3::from([0, 1, 2].map(|axis| f64::from(bits >> axis & 1))))
                    .map(|corner| -world_from_texture.transform_point3(corner).z)
                    .fold(f64::INFINITY, f64::min);
                prop_assert!(nearest_m >= 0.4 - ROUNDING, "{nearest_m}");
                prop_assert!(-stand.pose.position_m.z >= 0.6);
                prop_assert!(stand.pose.position_m.y < 1.6);
            }
        }
    }
}

#[test]
fn sizes_are_human_or_true() {
    let grid = grid();
    for (scale, longest_side_m) in [(Scale::Human, 0.3), (Scale::True, 0.1)] {
        let stand = Stand::before(&at(0.0, 1.6, 0.0), &grid, Superior, scale);
        let sides_m = stand.placement(&grid, Superior).world_from_texture().matrix3;
        let longest_m = [0, 1, 2].map(|axis| sides_m.col(axis).length()).into_iter().fold(0.0, f64::max);
        assert!((longest_m - longest_side_m).abs() < ROUNDING, "{longest_m}");
    }
}

#[test]
fn eyes_that_look_straight_back_over_their_head_get_a_volume_too() {
    let upside_down = Pose { orientation: DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0), ..at(0.0, 1.6, 0.0) };
    let stand = Stand::before(&upside_down, &grid(), Superior, Scale::Human);
    assert!(stand.pose.is_valid());
}

#[test]
fn a_head_that_moves_moves_nothing() {
    let mut interaction = interaction();
    let before = (*interaction.stand(), interaction.clip());
    let demonstration = wheatstone_core::headset::Demonstration::new(&grid(), Superior);
    for refresh in 0..90 {
        let mut tick = demonstration.tick_at(f64::from(refresh) * PERIOD_S, PERIOD_S);
        tick.hands = [Hand::default(); 2];
        let changes = interaction.update(&tick, window());
        assert!(!changes.has_moved && !changes.has_clipped && changes.window == window());
    }
    assert_eq!((*interaction.stand(), interaction.clip()), before);
}

#[test]
fn a_menu_button_brings_the_volume_back_once_and_as_large_as_it_is() {
    let mut interaction = interaction();
    let eyes = Pose {
        position_m: DVec3::new(2.0, 1.7, 1.0),
        orientation: DQuat::from_rotation_y(1.1) * DQuat::from_rotation_x(-0.4),
    };
    let frustum = Frustum { left: -1.0, right: 1.0, down: -1.0, up: 1.0, near_m: 0.01, far_m: f64::INFINITY };
    let pressed = Hand { menu: true, ..Hand::default() };
    let tick = |index: u32, hands| Tick {
        display_time_s: f64::from(index) * PERIOD_S,
        period_s: PERIOD_S,
        eyes: Some([Eye { pose: eyes, frustum }; 2]),
        hands,
    };
    let back = Stand::as_long_before(&eyes, &grid(), Superior, stand().longest_side_m);
    assert!(!interaction.update(&tick(0, [Hand::default(); 2]), window()).has_moved);
    assert!(interaction.update(&tick(1, [Hand::default(), pressed]), window()).has_moved);
    assert_eq!(interaction.stand(), &back);
    let ahead = eyes.orientation.inverse() * (back.pose.position_m - eyes.position_m);
    assert!(ahead.z < -0.3 && ahead.x.abs() < 1e-9, "{ahead}");
    // It stays there however the head moves on with the button down, until the button goes down again.
    assert!(!interaction.update(&tick(2, [Hand::default(), pressed]), window()).has_moved);
    let blind = Tick { eyes: None, ..tick(3, [pressed, Hand::default()]) };
    assert!(!interaction.update(&blind, window()).has_moved, "nobody knows where the head is");
}

#[test]
fn a_volume_that_is_put_elsewhere_is_carried_on_from_there() {
    let mut interaction = Interaction::new(&grid(), Superior, stand(), &Clip::default());
    update(&mut interaction, [Hand::default(), closed(at(0.0, 1.2, 0.0))]);
    update(&mut interaction, [Hand::default(), closed(at(0.1, 1.2, 0.0))]);
    let elsewhere = Stand { pose: at(3.0, 1.0, 2.0), longest_side_m: 0.5 };
    interaction.put(elsewhere);
    update(&mut interaction, [Hand::default(), closed(at(0.2, 1.2, 0.0))]);
    assert_eq!(*interaction.stand(), elsewhere);
    update(&mut interaction, [Hand::default(), closed(at(0.2, 1.3, 0.0))]);
    let carried = Stand { pose: at(3.0, 1.1, 2.0), longest_side_m: 0.5 };
    assert!(apart(interaction.stand(), &carried) < ROUNDING);
}
