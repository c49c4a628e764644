//! A head and two hands that do everything once.

use super::{Eye, Hand, Recording, RecordingError, Scale, Side, Stand, Tick};
use crate::head::{Display, Pose};
use crate::scene::Clip;
use crate::view::{AnatomicalDirection, Frustum};
use crate::volume::Grid;
use glam::{DAffine3, DQuat, DVec3};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// Between the eyes, metres.
const EYE_DISTANCE_M: f64 = 0.063;

/// Of the left eye; the right one's is its mirror image.
const FRUSTUM: Frustum =
    Frustum { left: -1.2, right: 1.0, down: -1.15, up: 1.05, near_m: 0.01, far_m: f64::INFINITY };

/// Where the middle between the eyes is at first, metres: before somebody who stands on the floor.
const EYES_M: DVec3 = DVec3::new(0.0, 1.6, 0.0);

/// Where the hands are at first from the volume's middle, metres.
const HANDS_M: [DVec3; 2] = [DVec3::new(-0.25, -0.2, 0.2), DVec3::new(0.18, -0.05, 0.12)];

/// How the right hand carries the volume: by a vector in metres, and a turn in radians about +Y.
const CARRY_M: DVec3 = DVec3::new(-0.08, 0.05, 0.04);
const CARRY_RAD: f64 = 0.6;

/// Where the middle between the hands is from the volume's when both hold it, and how far they are apart, metres.
const MIDDLE_M: DVec3 = DVec3::new(0.05, 0.0, 0.1);
const APART_M: f64 = 0.3;

/// How many times as far apart the hands go, and by which turn in radians about +Z.
const GROWTH: f64 = 1.5;
const SPREAD_RAD: f64 = 0.4;

/// Which face is dragged, how far before it the hand is, metres, and how far it goes, as a part of the volume's side.
const FACE: usize = 3;
const REACH_M: f64 = 0.3;
const CROP: f64 = 0.25;

/// When what happens, seconds. Hands are at rest when they press and let go.
const SQUEEZE_ONE_S: Range<f64> = 0.8..3.6;
const CARRY_S: Range<f64> = 1.2..3.2;
const REACH_S: Range<f64> = 3.9..4.6;
const SQUEEZE_BOTH_S: Range<f64> = 4.8..7.0;
const SPREAD_S: Range<f64> = 5.1..6.6;
const POINT_S: Range<f64> = 7.3..8.0;
const PULL_S: Range<f64> = 8.2..9.6;
const CROP_S: Range<f64> = 8.5..9.3;
const FLICK_S: Range<f64> = 9.9..10.2;
const DURATION_S: f64 = 10.5;

/// How long it takes to press and to let go, seconds.
const PRESS_S: f64 = 0.1;

/// A head that sways all the time while the right hand carries and turns a volume, both hands scale it and turn it, the right
/// hand drags a face of the visible box inwards, and the left hand flicks its stick to the next preset. All of it is known at any
/// time, and so is where it leads: no headset is needed, and what comes out can be compared with [`Demonstration::outcome`] at
/// every refresh rate above 10 Hz.
#[derive(Debug, Clone)]
pub struct Demonstration {
    begin: Stand,
    carried: Stand,
    spread: Stand,
    /// Of the right hand, before and after it drags a face.
    aims: [Pose; 2],
}

/// What a demonstration leads to, beginning with everything shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// Where the volume stands.
    pub stand: Stand,
    /// What part of it is shown.
    pub clip: Clip,
    /// How many presets further it is shown by.
    pub preset_steps: i32,
}

impl Demonstration {
    /// With a volume at human scale that stands where it does [before](Stand::before) the first tick's eyes.
    pub fn new(grid: &Grid, up: AnatomicalDirection) -> Self {
        let eyes = Pose { position_m: EYES_M, orientation: DQuat::IDENTITY };
        let begin = Stand::before(&eyes, grid, up, Scale::Human);
        let hand_m = begin.pose.position_m + HANDS_M[Side::Right.index()];
        let turn = DQuat::from_rotation_y(CARRY_RAD);
        let carried = Stand {
            pose: Pose {
                position_m: hand_m + CARRY_M + turn * (begin.pose.position_m - hand_m),
                orientation: turn * begin.pose.orientation,
            },
            ..begin
        };
        let middle_m = carried.pose.position_m + MIDDLE_M;
        let turn = DQuat::from_rotation_z(SPREAD_RAD);
        let spread = Stand {
            pose: Pose {
                position_m: middle_m + GROWTH * (turn * (carried.pose.position_m - middle_m)),
                orientation: turn * carried.pose.orientation,
            },
            longest_side_m: GROWTH * carried.longest_side_m,
        };
        let aims = aims(spread.placement(grid, up).world_from_texture());
        Self { begin, carried, spread, aims }
    }

    /// How long it takes, seconds.
    pub fn duration_s(&self) -> f64 {
        DURATION_S
    }

    /// Where the volume stands at first.
    pub fn stand(&self) -> &Stand {
        &self.begin
    }

    /// What it leads to.
    pub fn outcome(&self) -> Outcome {
        let mut clip = Clip::default();
        clip.move_face(FACE, 1.0 - CROP);
        Outcome { stand: self.spread, clip, preset_steps: 1 }
    }

    /// What a headset tells of a time in seconds, refreshes being a period apart.
    pub fn tick_at(&self, time_s: f64, period_s: f64) -> Tick {
        let squeeze = pressed(time_s, &SQUEEZE_BOTH_S);
        let right = self.right_at(time_s);
        let left = self.left_at(time_s);
        let left = Hand {
            grip: Some(left),
            aim: Some(left),
            squeeze,
            stick: [pressed(time_s, &FLICK_S), 0.0],
            ..Hand::default()
        };
        let right = Hand {
            grip: Some(right),
            aim: Some(right),
            squeeze: squeeze.max(pressed(time_s, &SQUEEZE_ONE_S)),
            trigger: pressed(time_s, &PULL_S),
            ..Hand::default()
        };
        Tick { display_time_s: time_s, period_s, eyes: Some(eyes_at(time_s)), hands: [left, right] }
    }

    /// All of it, at the refreshes of a display.
    ///
    /// # Errors
    /// A display with more refreshes than a recording may have, or longer ones.
    pub fn recording(&self, display: Display) -> Result<Recording, RecordingError> {
        let refreshes = (DURATION_S / display.period_s()).ceil() as u64;
        let ticks = (0..=refreshes)
            .map(|refresh| self.tick_at(display.refresh_s(refresh), display.period_s()))
            .take(super::recording::MOST_TICKS + 1);
        Recording::new(ticks.collect())
    }

    fn left_at(&self, time_s: f64) -> Pose {
        let rest = Pose {
            position_m: self.begin.pose.position_m + HANDS_M[Side::Left.index()],
            orientation: DQuat::IDENTITY,
        };
        rest.between(&self.apart_at(time_s, -0.5), share(time_s, &REACH_S))
    }

    fn right_at(&self, time_s: f64) -> Pose {
        let carried = share(time_s, &CARRY_S);
        let carrying = Pose {
            position_m: self.begin.pose.position_m + HANDS_M[Side::Right.index()] + carried * CARRY_M,
            orientation: DQuat::from_rotation_y(carried * CARRY_RAD),
        };
        let [before, after] = self.aims;
        carrying
            .between(&self.apart_at(time_s, 0.5), share(time_s, &REACH_S))
            .between(&before, share(time_s, &POINT_S))
            .between(&after, share(time_s, &CROP_S))
    }

    /// A hand at one end of the line between both, from −½ on the left to ½ on the right.
    fn apart_at(&self, time_s: f64, end: f64) -> Pose {
        let spread = share(time_s, &SPREAD_S);
        let turn = DQuat::from_rotation_z(spread * SPREAD_RAD);
        let apart_m = APART_M * (1.0 + spread * (GROWTH - 1.0));
        let middle_m = self.carried.pose.position_m + MIDDLE_M;
        Pose { position_m: middle_m + turn * DVec3::X * (end * apart_m), orientation: turn }
    }
}

/// Before a face of the whole volume, aimed at its middle; and as far nearer as the face is to be dragged.
fn aims(world_from_texture: DAffine3) -> [Pose; 2] {
    let side_m = world_from_texture.matrix3.col(FACE % 3);
    let outwards = side_m.normalize_or_zero();
    let middle_m = world_from_texture.transform_point3(DVec3::new(1.0, 0.5, 0.5));
    let orientation = DQuat::from_rotation_arc(DVec3::Z, outwards);
    let before_m = middle_m + REACH_M * outwards;
    [before_m, before_m - CROP * side_m].map(|position_m| Pose { position_m, orientation })
}

fn eyes_at(time_s: f64) -> [Eye; 2] {
    let sway = |amplitude: f64, period_s: f64| amplitude * (TAU * time_s / period_s).sin();
    let orientation = DQuat::from_rotation_y(sway(0.15, 5.0)) * DQuat::from_rotation_x(sway(0.05, 3.5));
    let middle_m = EYES_M + DVec3::new(sway(0.06, 4.0), sway(0.02, 3.0), 0.0);
    let mirrored = Frustum { left: -FRUSTUM.right, right: -FRUSTUM.left, ..FRUSTUM };
    [(-0.5, FRUSTUM), (0.5, mirrored)].map(|(side, frustum)| {
        let position_m = middle_m + orientation * DVec3::X * (side * EYE_DISTANCE_M);
        Eye { pose: Pose { position_m, orientation }, frustum }
    })
}

/// The share of what happens within some time that is done, 0 to 1, eased by a cosine.
fn share(time_s: f64, within_s: &Range<f64>) -> f64 {
    let elapsed = ((time_s - within_s.start) / (within_s.end - within_s.start)).clamp(0.0, 1.0);
    0.5 - 0.5 * (PI * elapsed).cos()
}

/// How far something is pressed that is pressed from one time to another.
fn pressed(time_s: f64, within_s: &Range<f64>) -> f32 {
    let since_s = (time_s - within_s.start).min(within_s.end - time_s);
    (since_s / PRESS_S).clamp(0.0, 1.0) as f32
}
