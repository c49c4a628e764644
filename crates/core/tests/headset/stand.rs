//! Where the volume is at first.

use crate::hands::*;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Interaction, Scale, Stand};
use wheatstone_core::scene::Clip;
use wheatstone_core::view::AnatomicalDirection::{self, Anterior, Superior};
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
