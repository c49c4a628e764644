//! How a head moves.

use super::{HeadError, Neck, Pose};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;

/// A head that turns about its neck, moves sideways, or both, from rest to rest (VR §6.2): the pivot moves along the first
/// pose's +X while the head turns about the world's +Y, both eased by a cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadMotion {
    pivot: Pose,
    neck: Neck,
    turn_rad: f64,
    sideways_m: f64,
    duration_s: f64,
}

impl HeadMotion {
    /// From a pose of the eyes, by an angle in radians (to the left if positive) and a distance in metres (to the right if
    /// positive), within one second, with the default neck.
    ///
    /// # Errors
    /// Numbers that are not finite, or a pose that is none.
    pub fn new(eyes: Pose, turn_rad: f64, sideways_m: f64) -> Result<Self, HeadError> {
        if !eyes.is_valid() {
            return Err(HeadError::Pose);
        }
        let neck = Neck::default();
        Ok(Self {
            pivot: neck.pivot(&eyes),
            neck,
            turn_rad: HeadError::unless_finite("turn in rad", turn_rad)?,
            sideways_m: HeadError::unless_finite("sideways distance in m", sideways_m)?,
            duration_s: 1.0,
        })
    }

    /// The same motion in another time, seconds.
    ///
    /// # Errors
    /// A duration that is not above zero and finite.
    pub fn within(self, duration_s: f64) -> Result<Self, HeadError> {
        Ok(Self { duration_s: HeadError::unless_positive("duration in s", duration_s)?, ..self })
    }

    /// How long it takes, seconds.
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The pose of the middle between the eyes, seconds after the beginning; at rest before it and after the end.
    pub fn eyes_at(&self, time_s: f64) -> Pose {
        let share = self.share_at(time_s);
        let right = self.pivot.orientation * DVec3::X;
        self.neck.eyes(&Pose {
            position_m: self.pivot.position_m + share * self.sideways_m * right,
            orientation: DQuat::from_rotation_y(share * self.turn_rad) * self.pivot.orientation,
        })
    }

    /// The share of the motion that is done, 0 to 1.
    fn share_at(&self, time_s: f64) -> f64 {
        let elapsed = if time_s > 0.0 { (time_s / self.duration_s).min(1.0) } else { 0.0 };
        0.5 - 0.5 * (PI * elapsed).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn eyes() -> Pose {
        Pose { position_m: DVec3::new(0.1, 0.2, 1.5), orientation: DQuat::from_rotation_x(-0.2) }
    }

    #[test]
    fn it_begins_and_ends_at_rest() {
        let motion = HeadMotion::new(eyes(), 0.5, -0.3).unwrap().within(2.0).unwrap();
        let end = motion.eyes_at(2.0);
        for time_s in [-1.0, 0.0, f64::NAN] {
            assert!(motion.eyes_at(time_s).distance_to_m(&eyes()) < 1e-12);
        }
        assert_eq!(motion.eyes_at(f64::INFINITY), end);
        assert!((end.angle_to_rad(&eyes()) - 0.5).abs() < 1e-12);
        let [first, last] = [0.0, 1.99].map(|s| motion.eyes_at(s).distance_to_m(&motion.eyes_at(s + 0.01)));
        assert!(first < 1e-4 && last < 1e-4);
    }

    #[test]
    fn eyes_that_turn_move_on_a_circle_about_the_neck() {
        let level = Pose { orientation: DQuat::IDENTITY, ..eyes() };
        let motion = HeadMotion::new(level, PI / 6.0, 0.0).unwrap();
        let middle = motion.eyes_at(0.5);
        assert!((middle.angle_to_rad(&level) - PI / 12.0).abs() < 1e-12);
        let chord_m = 2.0 * 0.0805 * (PI / 24.0).sin();
        assert!((middle.distance_to_m(&level) - chord_m).abs() < 1e-12);
        let off_m = middle.position_m - level.position_m;
        assert!(off_m.x < 0.0 && off_m.y.abs() < 1e-12, "{off_m}");
        assert!((middle.orientation * DVec3::NEG_Z).x < 0.0);
    }

    #[test]
    fn heads_that_move_sideways_do_not_turn() {
        let motion = HeadMotion::new(eyes(), 0.0, 0.2).unwrap();
        for (time_s, share) in [(0.25, 0.5 - 0.5 * (0.25 * PI).cos()), (0.5, 0.5), (1.0, 1.0)] {
            let at = motion.eyes_at(time_s);
            assert!((at.position_m - eyes().position_m - 0.2 * share * DVec3::X).length() < 1e-12);
            assert!(at.angle_to_rad(&eyes()) < 1e-12);
        }
    }

    #[test]
    fn numbers_that_are_no_motion_are_refused() {
        assert!(HeadMotion::new(eyes(), f64::NAN, 0.0).is_err());
        assert!(HeadMotion::new(eyes(), 0.0, f64::INFINITY).is_err());
        assert_eq!(
            HeadMotion::new(Pose { position_m: DVec3::NAN, ..eyes() }, 0.0, 0.0),
            Err(HeadError::Pose)
        );
        for duration_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(HeadMotion::new(eyes(), 0.1, 0.0).unwrap().within(duration_s).is_err());
        }
    }
}
