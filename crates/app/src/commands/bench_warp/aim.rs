//! Which pose pictures are cast for.

use crate::failure::Failure;
use clap::ValueEnum;
use wheatstone_core::head::{HeadMotion, Pose, PosePredictor};

/// What is known of where the head will be when a picture is shown first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum AimName {
    /// All: prediction is optimal (VR §6.2).
    Known,
    /// Where it was at the last two refreshes.
    Predicted,
}

/// Aims at where the eyes will be.
pub(super) struct Aim<'a> {
    name: AimName,
    motion: &'a HeadMotion,
    predictor: PosePredictor,
}

impl<'a> Aim<'a> {
    pub(super) fn new(name: AimName, motion: &'a HeadMotion) -> Self {
        Self { name, motion, predictor: PosePredictor::default() }
    }

    /// The pose to expect then; `now_s` is later each time.
    pub(super) fn eyes_at(&mut self, then_s: f64, now_s: f64) -> Result<Pose, Failure> {
        let now = self.pose_at(now_s);
        self.predictor.observe(now_s, now).map_err(Failure::input)?;
        Ok(match self.name {
            AimName::Known => self.pose_at(then_s),
            AimName::Predicted => self.predictor.predict(then_s).unwrap_or(now),
        })
    }

    /// Before the motion the head goes to and fro in the same way.
    fn pose_at(&self, time_s: f64) -> Pose {
        let there_and_back_s = 2.0 * self.motion.duration_s();
        let before_s = (-time_s).max(0.0) % there_and_back_s;
        self.motion.eyes_at(if time_s < 0.0 { before_s.min(there_and_back_s - before_s) } else { time_s })
    }
}
