//! Where a pose will be.

use super::{HeadError, Pose};
use glam::DQuat;

/// Carries the last two poses on at constant linear and angular velocity.
///
/// With poses that are τ apart, a coordinate whose acceleration is at most a is off by at most ½·a·h·(h + τ) after h seconds; an
/// eased motion by X within T has a = ½·π²·X/T². A turn by 30° within a second leaves 0.27° after five refreshes of 90 Hz, 0.2 m
/// sideways 1.8 mm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PosePredictor {
    /// Times in seconds, oldest first.
    last_two: [Option<(f64, Pose)>; 2],
}

impl PosePredictor {
    /// A pose that was measured at a time in seconds.
    ///
    /// # Errors
    /// A pose or a time that is none, or a time that is not after that of the pose before; then nothing changes.
    pub fn observe(&mut self, time_s: f64, pose: Pose) -> Result<(), HeadError> {
        if !pose.is_valid() {
            return Err(HeadError::Pose);
        }
        let time_s = HeadError::unless_finite("time in s", time_s)?;
        if let Some((last_s, _)) = self.last_two[1].filter(|(last_s, _)| *last_s >= time_s) {
            return Err(HeadError::Order { time_s, last_s });
        }
        self.last_two = [self.last_two[1], Some((time_s, pose))];
        Ok(())
    }

    /// The pose to expect at a time in seconds; none before the first is measured, the only one before the second, and the last
    /// one for times that are not after it.
    pub fn predict(&self, time_s: f64) -> Option<Pose> {
        let (last_s, last) = self.last_two[1]?;
        let ahead_s = time_s - last_s;
        let Some((before_s, before)) = self.last_two[0].filter(|_| ahead_s > 0.0 && ahead_s.is_finite())
        else {
            return Some(last);
        };
        let share = ahead_s / (last_s - before_s);
        let turn = last.orientation * before.orientation.inverse();
        let shorter_turn = if turn.w < 0.0 { -turn } else { turn };
        let on = DQuat::from_scaled_axis(share * shorter_turn.to_scaled_axis());
        let predicted = Pose {
            position_m: last.position_m + share * (last.position_m - before.position_m),
            orientation: (on * last.orientation).normalize(),
        };
        Some(if predicted.is_valid() { predicted } else { last })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::head::{Display, HeadMotion, Neck};
    use glam::DVec3;
    use std::f64::consts::PI;

    const EYES: Pose = Pose { position_m: DVec3::new(0.0, 0.0, 1.5), orientation: DQuat::IDENTITY };

    /// Worst errors of predictions over a motion, so many refreshes ahead, of poses measured at each refresh: radians and
    /// metres.
    fn worst(motion: &HeadMotion, ahead: u64) -> [f64; 2] {
        let display = Display::default();
        let mut predictor = PosePredictor::default();
        let mut worst = [0.0_f64; 2];
        for refresh in 0..120 {
            let time_s = display.refresh_s(refresh);
            predictor.observe(time_s, motion.eyes_at(time_s)).unwrap();
            let then_s = display.refresh_s(refresh + ahead);
            let (predicted, truth) = (predictor.predict(then_s).unwrap(), motion.eyes_at(then_s));
            worst[0] = worst[0].max(predicted.angle_to_rad(&truth));
            worst[1] = worst[1].max(predicted.distance_to_m(&truth));
        }
        worst
    }

    /// ½·a·h·(h + τ) of an eased motion by a unit within a second.
    fn bound(ahead: u64) -> f64 {
        let period_s = Display::default().period_s();
        let ahead_s = ahead as f64 * period_s;
        0.25 * PI * PI * ahead_s * (ahead_s + period_s)
    }

    #[test]
    fn steady_motion_is_predicted_exactly() {
        let at = |time_s: f64| Pose {
            position_m: DVec3::new(0.3, -0.1, 0.2) * time_s,
            orientation: DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 2.0 * time_s),
        };
        let mut predictor = PosePredictor::default();
        assert_eq!(predictor.predict(0.0), None);
        predictor.observe(0.0, at(0.0)).unwrap();
        assert_eq!(predictor.predict(0.1), Some(at(0.0)));
        // The same orientation with the other sign.
        let tracked = at(0.1);
        predictor.observe(0.1, Pose { orientation: -tracked.orientation, ..tracked }).unwrap();
        let predicted = predictor.predict(0.35).unwrap();
        assert!(predicted.angle_to_rad(&at(0.35)) < 1e-12 && predicted.distance_to_m(&at(0.35)) < 1e-12);
    }

    #[test]
    fn heads_that_move_sideways_are_predicted_within_the_bound_and_no_better() {
        let motion = HeadMotion::new(EYES, 0.0, 0.2).unwrap();
        for ahead in [1, 5, 10] {
            let [angle_rad, distance_m] = worst(&motion, ahead);
            assert!(angle_rad < 1e-9);
            assert!((0.5..=1.0).contains(&(distance_m / (0.2 * bound(ahead)))), "{ahead}: {distance_m}");
        }
    }

    #[test]
    fn heads_that_turn_are_predicted_within_the_bound_and_no_better() {
        let turn_rad = PI / 6.0;
        let motion = HeadMotion::new(EYES, turn_rad, 0.0).unwrap();
        for ahead in [1, 5, 10] {
            let [angle_rad, distance_m] = worst(&motion, ahead);
            assert!((0.5..=1.0).contains(&(angle_rad / (turn_rad * bound(ahead)))), "{ahead}: {angle_rad}");
            let swing_m = Neck::default().forward_m * angle_rad;
            assert!(distance_m < 1.01 * swing_m, "{ahead}: {distance_m}");
        }
    }

    #[test]
    fn constant_velocity_beats_the_last_pose() {
        let motion = HeadMotion::new(EYES, 0.5, 0.2).unwrap();
        let (then, last) = (motion.eyes_at(0.5), motion.eyes_at(0.5 - 5.0 / 90.0));
        let [angle_rad, distance_m] = worst(&motion, 5);
        assert!(5.0 * angle_rad < last.angle_to_rad(&then) && 5.0 * distance_m < last.distance_to_m(&then));
    }

    #[test]
    fn bad_poses_and_times_change_nothing() {
        let mut predictor = PosePredictor::default();
        predictor.observe(1.0, EYES).unwrap();
        let before = predictor;
        assert_eq!(predictor.observe(1.0, EYES), Err(HeadError::Order { time_s: 1.0, last_s: 1.0 }));
        assert!(predictor.observe(f64::NAN, EYES).is_err());
        assert!(predictor.observe(2.0, Pose { position_m: DVec3::INFINITY, ..EYES }).is_err());
        assert_eq!(predictor, before);
        let moved = Pose { position_m: DVec3::ZERO, orientation: DQuat::from_rotation_x(1.0) };
        predictor.observe(1.0_f64.next_up(), moved).unwrap();
        for time_s in [f64::NAN, f64::INFINITY, -5.0] {
            assert_eq!(predictor.predict(time_s), Some(moved));
        }
        assert!(predictor.predict(f64::MAX).is_some_and(|pose| pose.is_valid()));
    }
}
