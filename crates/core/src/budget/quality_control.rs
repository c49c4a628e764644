//! Which quality to cast the next view at.

use super::{BudgetError, Quality};

/// Share of the target below which a finer level is tried. It takes about twice the time, but the ratio may be as far off as
/// 3, and times are noisy.
const REFINE_BELOW: f64 = 0.25;

/// Levels by which a view at rest refines the one before: four times its work, so that all of them together take a third
/// more than the last.
const LEVELS_AT_REST: u32 = 2;

/// Levels by which a view in motion that is under way may be finer than it should be: it is then complete sooner than another.
const LEVELS_TOO_FINE: u32 = 2;

/// Chooses coarser views while something moves, so that a view takes no more than a number of refreshes, and finer ones
/// when it rests, view by view up to full quality.
///
/// A function of what it is told alone. The level in motion changes only for times measured at that level: coarser above
/// the target, finer below a quarter of it. So it comes to rest wherever a level takes 1.4 to 3 times as long as the next
/// coarser one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct QualityControl {
    target_refreshes: f64,
    rest_after_s: f64,
    in_motion: Quality,
    last_moved_s: Option<f64>,
}

impl QualityControl {
    /// Views in motion take at most `target_refreshes`; what has not moved for `rest_after_s` seconds rests.
    ///
    /// # Errors
    /// A target that is not above zero and finite, or a duration that is negative or not finite.
    pub fn new(target_refreshes: f64, rest_after_s: f64) -> Result<Self, BudgetError> {
        Ok(Self {
            target_refreshes: BudgetError::unless_positive("refreshes per view", target_refreshes)?,
            rest_after_s: BudgetError::unless_duration(rest_after_s)?,
            in_motion: Quality::FULL,
            last_moved_s: None,
        })
    }

    /// Begins with another quality in motion than full.
    #[must_use]
    pub fn beginning_at(self, in_motion: Quality) -> Self {
        Self { in_motion, ..self }
    }

    /// The quality of views in motion after one of quality `last` that takes `view_s` seconds of casting, of which a refresh has room
    /// for `refresh_s`.
    fn in_motion_after(&self, last: Quality, view_s: f64, refresh_s: f64) -> Quality {
        let refreshes = view_s / refresh_s;
        if last == self.in_motion && refreshes > 0.0 && refreshes.is_finite() {
            self.adapted(refreshes)
        } else {
            self.in_motion
        }
    }

    /// Whether a view under way of a quality, expected to take `view_s` seconds in all, is not worth its end once something moves.
    pub fn is_too_fine(&self, quality: Quality, view_s: f64, refresh_s: f64) -> bool {
        let coarser = self.in_motion_after(quality, view_s, refresh_s);
        quality < self.in_motion || quality.level() + LEVELS_TOO_FINE <= coarser.level()
    }

    /// The view, the transfer function or anything else that is seen has changed at a time in seconds.
    pub fn moved(&mut self, now_s: f64) {
        self.last_moved_s = Some(now_s);
    }

    /// Whether anything has moved lately.
    pub fn is_moving(&self, now_s: f64) -> bool {
        self.last_moved_s.is_some_and(|last_s| now_s - last_s < self.rest_after_s)
    }

    /// The quality of the view that begins now, to be asked once per view, after one of quality `last` that took `view_s` seconds of casting, of which
    /// a refresh has room for `refresh_s`. Durations that are not above zero and finite teach nothing.
    pub fn next(&mut self, now_s: f64, last: Quality, view_s: f64, refresh_s: f64) -> Quality {
        self.in_motion = self.in_motion_after(last, view_s, refresh_s);
        if self.is_moving(now_s) {
            self.in_motion
        } else {
            Quality::at(last.level().saturating_sub(LEVELS_AT_REST))
        }
    }

    /// The level in motion after a view at it has taken a number of refreshes.
    fn adapted(&self, refreshes: f64) -> Quality {
        let level = self.in_motion.level();
        let share = refreshes / self.target_refreshes;
        if share > 1.0 {
            Quality::at(level.saturating_add(share.log2().ceil() as u32))
        } else if share <= REFINE_BELOW {
            Quality::at(level.saturating_sub(1))
        } else {
            self.in_motion
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const REFRESH_S: f64 = 0.009;
    const REST_AFTER_S: f64 = 0.2;

    #[test]
    fn targets_and_durations_are_checked() {
        assert!(QualityControl::new(0.0, 0.1).is_err());
        assert!(QualityControl::new(f64::NAN, 0.1).is_err());
        assert!(QualityControl::new(1.0, -0.1).is_err());
        let mut control = QualityControl::new(2.0, 0.1).unwrap();
        control.moved(0.0);
        for view_s in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
            assert_eq!(control.next(0.0, Quality::FULL, view_s, REFRESH_S), Quality::FULL);
        }
        assert_eq!(control.next(f64::NAN, Quality::FULL, 1.0, 0.0), Quality::FULL);
    }

    #[test]
    fn a_view_coarsens_in_motion_and_refines_at_rest() {
        let mut control = QualityControl::new(2.0, REST_AFTER_S).unwrap();
        let view_s = |quality: Quality| 10.0 * REFRESH_S * 0.5_f64.powi(quality.level() as i32);
        control.moved(0.0);
        let moving = control.next(0.1, Quality::FULL, view_s(Quality::FULL), REFRESH_S);
        assert_eq!(moving, Quality::at(3));
        let mut shown = moving;
        let mut levels = vec![];
        for view in 1..5 {
            shown = control.next(0.2 * f64::from(view) + 0.1, shown, view_s(shown), REFRESH_S);
            levels.push(shown.level());
        }
        assert_eq!(levels, [1, 0, 0, 0]);
        control.moved(2.0);
        assert_eq!(control.next(2.0, Quality::FULL, view_s(Quality::FULL), REFRESH_S), moving);
    }

    #[test]
    fn views_that_turn_out_dear_are_too_fine_to_be_ended_in_motion() {
        let control = QualityControl::new(4.0, REST_AFTER_S).unwrap().beginning_at(Quality::at(2));
        let is_too_fine =
            |level, refreshes: f64| control.is_too_fine(Quality::at(level), refreshes * REFRESH_S, REFRESH_S);
        assert!(is_too_fine(1, 1.0) && !is_too_fine(3, 400.0));
        assert_eq!(
            [1.0, 4.1, 7.9, 8.1, f64::NAN].map(|n| is_too_fine(2, n)),
            [false, false, false, true, false]
        );
    }

    proptest! {
        #[test]
        fn the_level_in_motion_never_goes_to_and_fro(
            full_refreshes in 0.01..100.0_f64, target in 1.0..4.0_f64, ratio in 1.4..3.0_f64,
            noises in prop::collection::vec(0.9..1.1_f64, 200),
        ) {
            let mut control = QualityControl::new(target, REST_AFTER_S).unwrap();
            control.moved(0.0);
            let mut quality = Quality::FULL;
            let mut levels = vec![0];
            for noise in noises {
                let view_s = full_refreshes * REFRESH_S * ratio.powi(-(quality.level() as i32)) * noise;
                quality = control.next(0.0, quality, view_s, REFRESH_S);
                levels.push(quality.level());
            }
            levels.dedup();
            let turns = levels.windows(3).filter(|l| (l[1] > l[0]) != (l[2] > l[1])).count();
            prop_assert!(turns <= 1 && levels.len() <= 8, "{levels:?}");
        }
    }
}
