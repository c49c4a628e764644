//! Bare hands, which pinch.

use crate::error::{Called, XrError};
use crate::space::{World, known};
use glam::{DMat3, DQuat};
use openxr as xr;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Pinch, Side};

/// Space between the skins of thumb and index finger at which a pinch begins, metres.
const OPEN_M: f64 = 0.03;

/// Both hands' trackers.
pub(crate) struct HandTracking {
    trackers: [xr::HandTracker; 2],
}

impl HandTracking {
    pub(crate) fn new(session: &xr::Session<xr::Vulkan>) -> Result<Self, XrError> {
        let tracker = |hand| session.create_hand_tracker(hand).called("xrCreateHandTrackerEXT");
        Ok(Self { trackers: [tracker(xr::Hand::LEFT)?, tracker(xr::Hand::RIGHT)?] })
    }

    /// What a bare hand does at a time; none while it is not seen.
    pub(crate) fn hand(&self, side: Side, world: &World, time: xr::Time) -> Result<Option<Hand>, XrError> {
        let joints = world
            .space
            .locate_hand_joints(&self.trackers[side.index()], time)
            .called("xrLocateHandJointsEXT")?;
        Ok(joints.and_then(|joints| bare_hand(side, |joint| Joint::of(&joints[joint]))))
    }
}

/// A joint whose place is known.
#[derive(Debug, Clone, Copy)]
struct Joint {
    pose: Pose,
    /// From the joint to the skin, metres.
    radius_m: f64,
}

impl Joint {
    fn of(location: &xr::HandJointLocation) -> Option<Self> {
        let pose = known(location.location_flags, location.pose)?;
        Some(Self { pose, radius_m: location.radius.into() })
    }
}

/// A hand that holds nothing: its fist is about the palm, it points from the knuckle of the index finger along the palm, so that bending
/// that finger does not turn the ray, and it pinches as long as both tips are known.
fn bare_hand(side: Side, joint: impl Fn(xr::HandJoint) -> Option<Joint>) -> Option<Hand> {
    let palm = joint(xr::HandJoint::PALM)?.pose;
    let knuckle = joint(xr::HandJoint::INDEX_PROXIMAL)?.pose;
    let [thumb, index] = [xr::HandJoint::THUMB_TIP, xr::HandJoint::INDEX_TIP].map(joint);
    Some(Hand {
        grip: Some(Pose { orientation: palm.orientation * palm_from_grip(side), ..palm }),
        aim: Some(Pose { position_m: knuckle.position_m, ..palm }),
        pinch: thumb.zip(index).map(|(thumb, index)| pinch(thumb, index)),
        ..Hand::default()
    })
}

/// Two finger tips, closed by 0 from [`OPEN_M`] on, by 1 when their skins touch.
fn pinch(thumb: Joint, index: Joint) -> Pinch {
    let gap_m = thumb.pose.distance_to_m(&index.pose) - thumb.radius_m - index.radius_m;
    Pinch {
        position_m: thumb.pose.position_m.midpoint(index.pose.position_m),
        closed: (1.0 - gap_m / OPEN_M).clamp(0.0, 1.0) as f32,
    }
}

/// Turns the axes of a fist into those of the palm. Of a palm, −Z points along the fingers and +Y out of the back of the hand; of a fist,
/// −Z points from the little finger to the thumb, and +X out of the left palm or into the right one.
fn palm_from_grip(side: Side) -> DQuat {
    let [x, y, z] = DMat3::IDENTITY.to_cols_array_2d().map(glam::DVec3::from);
    let axes = match side {
        Side::Left => DMat3::from_cols(-y, z, -x),
        Side::Right => DMat3::from_cols(y, z, x),
    };
    DQuat::from_mat3(&axes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn at(x: f64, y: f64, z: f64) -> Joint {
        let pose = Pose { position_m: DVec3::new(x, y, z), orientation: DQuat::IDENTITY };
        Joint { pose, radius_m: 0.008 }
    }

    #[test]
    fn a_pinch_closes_with_the_gap_between_the_skins() {
        for (distance_m, expected) in [(0.1, 0.0), (0.046, 0.0), (0.031, 0.5), (0.016, 1.0), (0.0, 1.0)] {
            let Pinch { position_m, closed } = pinch(at(0.0, 0.0, 0.0), at(distance_m, 0.0, 0.0));
            assert!((closed - expected).abs() < 1e-6, "{distance_m} m: {closed}");
            assert_eq!(position_m, DVec3::new(0.5 * distance_m, 0.0, 0.0));
        }
    }

    /// Both palms down, fingers forwards: thumbs point to the middle.
    #[test]
    fn fists_are_turned_as_controllers_are_held() {
        for (side, to_thumb) in [(Side::Left, DVec3::X), (Side::Right, DVec3::NEG_X)] {
            let turn = palm_from_grip(side);
            assert!((turn * DVec3::NEG_Z - to_thumb).length() < 1e-12, "{side:?}");
            let through_palm = if side == Side::Left { DVec3::NEG_Y } else { DVec3::Y };
            assert!((turn * DVec3::X - through_palm).length() < 1e-12, "{side:?}");
        }
    }

    #[test]
    fn a_hand_points_along_its_palm_from_the_knuckle() {
        let hand = bare_hand(Side::Right, |joint| match joint {
            xr::HandJoint::PALM => Some(at(0.0, 0.0, 0.0)),
            xr::HandJoint::INDEX_PROXIMAL => Some(at(-0.03, 0.0, -0.04)),
            xr::HandJoint::THUMB_TIP => Some(at(-0.05, -0.05, -0.05)),
            _ => Some(at(-0.05, -0.05, -0.066)),
        })
        .unwrap();
        let aim = hand.aim.unwrap();
        assert_eq!(aim.position_m, DVec3::new(-0.03, 0.0, -0.04));
        assert_eq!(aim.orientation * DVec3::NEG_Z, DVec3::NEG_Z);
        assert!(hand.pinch.is_some_and(|pinch| pinch.closed > 0.99) && hand.squeeze == 0.0);
    }

    #[test]
    fn a_hand_without_its_palm_is_not_seen_and_without_tips_does_not_pinch() {
        assert_eq!(
            bare_hand(Side::Left, |joint| (joint != xr::HandJoint::PALM).then(|| at(0.0, 0.0, 0.0))),
            None
        );
        let without_tip =
            bare_hand(Side::Left, |joint| (joint != xr::HandJoint::THUMB_TIP).then(|| at(0.0, 0.0, 0.0)));
        assert_eq!(without_tip.map(|hand| hand.pinch), Some(None));
    }
}
