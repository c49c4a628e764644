//! A hand and what it does with its controller, or bare.

use crate::head::Pose;
use glam::DVec3;

/// Which hand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Side {
    /// Both, in the order of arrays of two hands.
    pub const BOTH: [Self; 2] = [Self::Left, Self::Right];

    /// Its place in arrays of two hands.
    pub fn index(self) -> usize {
        self as usize
    }
}

/// Farthest from the world's origin that a head or a hand is tracked, metres.
pub(super) const FARTHEST_M: f64 = 1000.0;

/// What a hand does. A hand that is not tracked has no poses, and nothing pressed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Hand {
    /// Of what is held in the fist, world space; −Z points away from the body along the thumb.
    pub grip: Option<Pose>,
    /// Of the ray that points, along its −Z, world space.
    pub aim: Option<Pose>,
    /// How far the grip is squeezed, 0 to 1.
    pub squeeze: f32,
    /// How far the trigger is pulled, 0 to 1.
    pub trigger: f32,
    /// The thumb-stick: right and up, −1 to 1.
    pub stick: [f32; 2],
    /// Whether the menu button is down.
    pub menu: bool,
    /// Of a bare hand that is seen well enough: it squeezes, or pulls a trigger, by pinching.
    pub pinch: Option<Pinch>,
}

/// Thumb and index finger of a bare hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pinch {
    /// The middle between their tips, world space, metres.
    pub position_m: DVec3,
    /// How far they are closed: 0 to 1, when their skins touch.
    pub closed: f32,
}

/// A pose that can be reckoned with: valid, its orientation of unit length to the last digit, and not absurdly far away.
pub(super) fn tracked(pose: Option<Pose>) -> Option<Pose> {
    pose?.normalized().filter(|pose| pose.position_m.abs().max_element() <= FARTHEST_M)
}
