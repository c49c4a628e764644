//! The head's motions.

use crate::failure::Failure;
use clap::ValueEnum;
use wheatstone_core::head::{HeadMotion, Pose};

/// A motion of the thesis's kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum MotionName {
    /// The head turns about the neck.
    Rotation,
    /// It moves sideways.
    Translation,
    /// It does both.
    Both,
}

/// How far the head moves, in one second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    pub(super) turn_rad: f64,
    pub(super) sideways_m: f64,
}

impl MotionName {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Rotation => "rotation",
            Self::Translation => "translation",
            Self::Both => "both",
        }
    }

    /// The motion whose middle is a pose.
    pub(super) fn about(self, middle: Pose, extent: Extent) -> Result<HeadMotion, Failure> {
        let turn_rad = if self == Self::Translation { 0.0 } else { extent.turn_rad };
        let sideways_m = if self == Self::Rotation { 0.0 } else { extent.sideways_m };
        let to_begin = HeadMotion::new(middle, -0.5 * turn_rad, -0.5 * sideways_m).map_err(Failure::input)?;
        let begin = to_begin.eyes_at(to_begin.duration_s());
        HeadMotion::new(begin, turn_rad, sideways_m).map_err(Failure::input)
    }
}
