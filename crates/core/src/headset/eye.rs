//! One eye of a headset.

use crate::head::Pose;
use crate::view::{Frustum, Projection, View};

/// Where an eye is and what it sees through its lens. The two eyes may have different frusta, and image planes that are not
/// parallel (canted displays).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Of the eye, in the reference space that stands for the world, metres.
    pub pose: Pose,
    /// What the display covers; off-axis as a rule.
    pub frustum: Frustum,
}

impl Eye {
    /// The view of a picture of so many pixels; shaded from the eye itself.
    pub fn view(&self, size: [u32; 2]) -> View {
        View {
            view_from_world: self.pose.world_from_own().inverse(),
            projection: Projection::Perspective(self.frustum),
            size,
            shaded_from: None,
        }
    }
}
