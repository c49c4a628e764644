//! One refresh to come.

use super::{Eye, Hand};
use crate::head::Pose;

/// What is known of a refresh when its picture is to be made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tick {
    /// When it will be shown, in seconds of the headset's own clock.
    pub display_time_s: f64,
    /// From refresh to refresh, seconds.
    pub period_s: f64,
    /// Left and right eye at that time, as predicted; `None` while the head is not tracked or nothing is to be drawn.
    pub eyes: Option<[Eye; 2]>,
    /// Left and right hand at that time, as predicted.
    pub hands: [Hand; 2],
}

impl Tick {
    /// The pose of the middle between the eyes, turned half-way from one to the other; `None` without eyes.
    pub fn between_eyes(&self) -> Option<Pose> {
        self.eyes.map(|[left, right]| left.pose.between(&right.pose, 0.5))
    }
}
