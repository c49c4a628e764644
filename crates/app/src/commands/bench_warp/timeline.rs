//! What is shown at which refresh, in simulated time.

use super::aim::{Aim, AimName};
use super::cells::Cells;
use crate::failure::Failure;
use wheatstone_core::budget::{CastSchedule, Predictor, ViewRequest};
use wheatstone_core::head::{Display, HeadMotion, Pose};

/// Refreshes before the motion, while the head goes to and fro: so many that it is known by then how far what cells take is off.
const REFRESHES_BEFORE: f64 = 720.0;

/// Share by which what a cell takes differs from one cast to the next.
const NOISE: f64 = 0.3;

/// A display, and what it takes to make its pictures.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pace {
    pub(super) display: Display,
    /// Time to cast a whole picture, seconds.
    pub(super) render_s: f64,
    /// Time of each refresh that is kept for the warp, seconds.
    pub(super) reserve_s: f64,
}

impl Pace {
    /// Time of each refresh for casting, seconds.
    pub(super) fn available_s(&self) -> f64 {
        self.display.period_s() - self.reserve_s
    }
}

/// A refresh of the display.
#[derive(Debug, Clone, Copy)]
pub(super) struct Refresh {
    /// Where the eyes are.
    pub(super) eyes: Pose,
    /// Where they were taken to be when the picture was begun that is shown.
    pub(super) cast_from: Pose,
    /// Number of that picture.
    pub(super) picture: u64,
    /// Whether casting has gone on into the time of the warp: what the refresh before has shown is shown once more.
    pub(super) is_missed: bool,
}

/// The refreshes of a motion, from the one at which it begins to the one after it has ended, for pictures of some cells. A picture is cast for the pose at which it will be shown first, if nothing takes longer than it is expected
/// to, as far as that pose is known.
pub(super) fn refreshes(
    motion: &HeadMotion,
    aim: AimName,
    pace: &Pace,
    cells: &Cells,
) -> Result<Vec<Refresh>, Failure> {
    let mut aim = Aim::new(aim, motion);
    let grid = cells.grid;
    let period_s = pace.display.period_s();
    let available_s = pace.available_s();
    // As many as the last picture has taken.
    let mut refreshes_of_cast = (pace.render_s / available_s).ceil();
    let mut completed = -REFRESHES_BEFORE;
    let mut random = fastrand::Rng::with_seed(1);
    let request = |pose| ViewRequest::new(pose, grid, 1.0).map_err(Failure::input);
    let mut schedule = CastSchedule::new(request(motion.eyes_at(0.0))?, Predictor::Corrected);
    let mut shown = Vec::new();
    let mut picture = 0;
    let mut refresh = -REFRESHES_BEFORE;
    while (refresh - 1.0) * period_s <= motion.duration_s() {
        let begins_s = refresh * period_s;
        schedule.aim(request(aim.eyes_at(begins_s + refreshes_of_cast * period_s, begins_s)?)?);
        let mut is_missed = false;
        let mut completes = false;
        if let Some(batch) = schedule.plan(available_s) {
            let mut noise = || 1.0 + NOISE * (2.0 * random.f64() - 1.0);
            let taken_s: Vec<f64> =
                batch.cells().iter().map(|&cell| pace.render_s * cells.share(cell) * noise()).collect();
            is_missed = taken_s.iter().sum::<f64>() > available_s;
            completes = batch.completes_view();
            schedule.record(&batch, &taken_s).map_err(Failure::input)?;
        }
        refresh += 1.0;
        if completes {
            picture += 1;
            refreshes_of_cast = refresh - completed;
            completed = refresh;
        }
        if let Some(front) = schedule.front().filter(|_| refresh >= 0.0) {
            shown.push(Refresh {
                eyes: motion.eyes_at(refresh * period_s),
                cast_from: front.content,
                picture,
                is_missed,
            });
        }
    }
    Ok(shown)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    fn motion() -> HeadMotion {
        let eyes = Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY };
        HeadMotion::new(eyes, 0.5, 0.2).unwrap()
    }

    fn timeline(aim: AimName, render_s: f64) -> Vec<Refresh> {
        let pace = Pace { display: Display::default(), render_s, reserve_s: 0.002 };
        refreshes(&motion(), aim, &pace, &Cells::growing([256, 192])).unwrap()
    }

    #[test]
    fn a_motion_begins_and_ends_at_rest() {
        for render_s in [0.001, 0.02, 0.05] {
            let all = timeline(AimName::Known, render_s);
            assert!((90..94).contains(&all.len()), "{}", all.len());
            assert_eq!(all[0].eyes, motion().eyes_at(0.0));
            assert_eq!(all.last().unwrap().eyes, motion().eyes_at(1.0));
            assert!(all.windows(2).all(|pair| pair[0].picture <= pair[1].picture));
        }
    }

    #[test]
    fn pictures_are_shown_as_long_as_casting_takes() {
        let pictures = |render_s| {
            let all = timeline(AimName::Known, render_s);
            all.last().unwrap().picture - all[0].picture
        };
        assert!(pictures(0.004) >= 88);
        let of_slow = pictures(0.05);
        assert!((12..=15).contains(&of_slow), "{of_slow}");
    }

    #[test]
    fn pictures_are_shown_first_where_they_were_aimed_at() {
        let worst_off_m = |aim| {
            let all = timeline(aim, 0.03);
            let first_shown = all.windows(2).filter(|pair| pair[0].picture != pair[1].picture);
            first_shown.map(|pair| pair[1].eyes.distance_to_m(&pair[1].cast_from)).fold(0.0, f64::max)
        };
        let [known_m, predicted_m] = [AimName::Known, AimName::Predicted].map(worst_off_m);
        assert!(known_m < 1e-9 && (0.0005..0.002).contains(&predicted_m), "{known_m} {predicted_m}");
    }

    #[test]
    fn what_is_simulated_is_repeatable() {
        let [a, b] = [0, 1].map(|_| format!("{:?}", timeline(AimName::Predicted, 0.03)));
        assert_eq!(a, b);
    }
}
