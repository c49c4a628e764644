//! One eye of a headset.

use crate::head::Pose;
use crate::view::{Frustum, Projection, View};
use glam::DVec2;

/// Largest angle between eyes whose image planes count as parallel, radians: half a pixel of a thousand per unit of tangent.
const PARALLEL_RAD: f64 = 5e-4;

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

    /// The eye in the middle between two, from which everything can be seen that either sees further than a depth in metres; `None`
    /// unless their image planes are parallel (canted displays).
    pub fn between(eyes: &[Self; 2], nearest_m: f64) -> Option<Self> {
        let [left, right] = eyes;
        if left.pose.angle_to_rad(&right.pose) > PARALLEL_RAD {
            return None;
        }
        let pose = left.pose.between(&right.pose, 0.5);
        let middle_from_world = pose.world_from_own().inverse();
        let (mut lo, mut hi) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut near_m, mut far_m) = (f64::INFINITY, 0.0_f64);
        for Self { pose, frustum } in eyes {
            let eye_m = middle_from_world.transform_point3(pose.position_m);
            // Tangents from the middle change evenly with the inverse depth: one end is at the nearest depth, the other infinitely far.
            let [nearest, furthest] = [1.0 / nearest_m, 0.0].map(|inverse_depth| {
                let seen = |tangents: DVec2| {
                    (tangents + eye_m.truncate() * inverse_depth) / (1.0 - eye_m.z * inverse_depth)
                };
                [DVec2::new(frustum.left, frustum.down), DVec2::new(frustum.right, frustum.up)].map(seen)
            });
            lo = lo.min(nearest[0]).min(furthest[0]);
            hi = hi.max(nearest[1]).max(furthest[1]);
            (near_m, far_m) = (near_m.min(frustum.near_m), far_m.max(frustum.far_m));
        }
        let frustum = Frustum { left: lo.x, right: hi.x, down: lo.y, up: hi.y, near_m, far_m };
        Some(Self { pose, frustum })
    }
}
