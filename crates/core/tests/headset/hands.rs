//! Hands, poses and volumes to make ticks of.

use glam::{DAffine3, DMat3, DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Changes, Hand, Interaction, Stand, Tick};
use wheatstone_core::scene::{Clip, ClipPlane};
use wheatstone_core::view::AnatomicalDirection;
use wheatstone_core::volume::{Grid, Window};

pub(crate) const PERIOD_S: f64 = 1.0 / 90.0;

/// Rounding of what is about a metre, after some hundred steps.
pub(crate) const ROUNDING: f64 = 1e-11;

/// A box of unequal sides whose axes are those of no anatomical direction.
pub(crate) fn grid() -> Grid {
    let turned =
        DMat3::from_quat(DQuat::from_rotation_z(0.2)) * DMat3::from_diagonal(DVec3::new(1.0, 1.5, -2.0));
    Grid::new([40, 30, 50], DAffine3::from_mat3_translation(turned, DVec3::new(7.0, -60.0, 30.0))).unwrap()
}

pub(crate) fn stand() -> Stand {
    Stand {
        pose: Pose {
            position_m: DVec3::new(0.1, 1.4, -0.6),
            orientation: DQuat::from_rotation_y(0.3) * DQuat::from_rotation_x(0.1),
        },
        longest_side_m: 0.3,
    }
}

pub(crate) fn interaction() -> Interaction {
    Interaction::new(&grid(), AnatomicalDirection::Superior, stand(), &Clip::default())
}

/// The same with a plane across it that cuts away what is in front.
pub(crate) fn with_plane() -> Interaction {
    let clip = Clip {
        plane: Some(ClipPlane { normal: DVec3::new(0.0, 0.0, -2.0), offset_m: 1.16 }),
        ..Clip::default()
    };
    Interaction::new(&grid(), AnatomicalDirection::Superior, stand(), &clip)
}

pub(crate) fn window() -> Window {
    Window::new(-100.0, 300.0).unwrap()
}

pub(crate) fn hand(pose: Pose) -> Hand {
    Hand { grip: Some(pose), aim: Some(pose), ..Hand::default() }
}

pub(crate) fn closed(pose: Pose) -> Hand {
    Hand { squeeze: 1.0, ..hand(pose) }
}

pub(crate) fn pulled(pose: Pose) -> Hand {
    Hand { trigger: 1.0, ..hand(pose) }
}

/// The next refresh of an interaction.
pub(crate) fn update(interaction: &mut Interaction, hands: [Hand; 2]) -> Changes {
    let tick = Tick { display_time_s: 0.0, period_s: PERIOD_S, eyes: None, hands };
    interaction.update(&tick, window())
}

pub(crate) fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { position_m: DVec3::new(x, y, z), orientation: DQuat::IDENTITY }
}

/// Poses within reach, turned anyhow.
pub(crate) fn poses() -> impl Strategy<Value = Pose> {
    let position = prop::array::uniform3(-0.8..0.8_f64);
    (position, prop::array::uniform3(-3.0..3.0_f64)).prop_map(|(position, turn)| Pose {
        position_m: DVec3::from(position) + DVec3::new(0.0, 1.3, -0.5),
        orientation: DQuat::from_scaled_axis(DVec3::from(turn)),
    })
}

/// How far apart two stands are: positions in metres, angles in radians, and sizes in logarithms.
pub(crate) fn apart(a: &Stand, b: &Stand) -> f64 {
    let growth = (a.longest_side_m / b.longest_side_m).ln().abs();
    a.pose.distance_to_m(&b.pose).max(a.pose.angle_to_rad(&b.pose)).max(growth)
}
