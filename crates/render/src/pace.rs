//! How much work fits into a time, by what the last steps of it took.

use std::collections::VecDeque;
use std::time::Duration;

/// Steps that are remembered: so many that one or two which others have held up do not count.
const REMEMBERED: usize = 5;

/// How many times as large as those that are remembered a step may be: what a small one takes tells little of a large one.
const GROWTH: f64 = 4.0;

/// Sizes steps of work that is counted in units of one kind. Nothing is learnt from the first one: it takes what is done once as well, such
/// as compiling a kernel or emptying a texture.
#[derive(Debug)]
pub(crate) struct Pace {
    first: usize,
    has_begun: bool,
    last: VecDeque<Step>,
}

#[derive(Debug)]
struct Step {
    units: f64,
    seconds: f64,
}

impl Pace {
    /// The first steps are of so many units.
    pub(crate) fn beginning_with(first: usize) -> Self {
        Self { first, has_begun: false, last: VecDeque::with_capacity(REMEMBERED) }
    }

    /// Units that take no longer than a time, if they take as long as in the middle one of the last steps.
    pub(crate) fn fitting(&self, time: Duration) -> usize {
        let Some(largest) = self.last.iter().map(|step| step.units).reduce(f64::max) else {
            return self.first;
        };
        let mut s_per_unit: Vec<f64> = self.last.iter().map(|step| step.seconds / step.units).collect();
        s_per_unit.sort_by(f64::total_cmp);
        // A cast to an integer keeps within its bounds.
        (time.as_secs_f64() / s_per_unit[s_per_unit.len() / 2]).min(GROWTH * largest) as usize
    }

    /// A step took so long.
    pub(crate) fn learn(&mut self, units: usize, took: Duration) {
        if !std::mem::replace(&mut self.has_begun, true) {
            return;
        }
        self.last.truncate(REMEMBERED - 1);
        self.last.push_front(Step { units: units as f64, seconds: took.as_secs_f64() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// A pace at which so many steps of 100 units took so long, after a first one.
    fn pace(took: &[Duration]) -> Pace {
        let mut pace = Pace::beginning_with(100);
        for &took in [9 * MS].iter().chain(took) {
            pace.learn(100, took);
        }
        pace
    }

    #[test]
    fn steps_grow_to_what_fits_and_shrink_where_that_takes_longer() {
        assert_eq!(Pace::beginning_with(100).fitting(4 * MS), 100);
        let mut pace = pace(&[]);
        assert_eq!(pace.fitting(4 * MS), 100);
        let mut sizes = Vec::new();
        for us_per_unit in [1; 8].into_iter().chain([2; 8]) {
            let units = pace.fitting(4 * MS);
            sizes.push(units);
            pace.learn(units, MS * units as u32 * us_per_unit / 1000);
        }
        assert_eq!(sizes[..5], [100, 400, 1600, 4000, 4000]);
        assert_eq!(sizes.last(), Some(&2000));
    }

    #[test]
    fn two_steps_that_were_held_up_change_nothing_three_do() {
        assert_eq!(pace(&[MS; 5]).fitting(2 * MS), 200);
        assert_eq!(pace(&[MS, 50 * MS, MS, MS, 50 * MS]).fitting(2 * MS), 200);
        assert_eq!(pace(&[50 * MS, 50 * MS, MS, MS, 50 * MS]).fitting(2 * MS), 4);
    }

    #[test]
    fn all_the_time_there_is_lets_steps_grow_and_none_leaves_nothing() {
        let mut pace = Pace::beginning_with(1);
        pace.learn(1, MS);
        pace.learn(1000, MS);
        assert_eq!(pace.fitting(Duration::MAX), 4000);
        assert_eq!(pace.fitting(Duration::ZERO), 0);
        let mut pace = Pace::beginning_with(1);
        pace.learn(1, MS);
        pace.learn(1000, Duration::ZERO);
        assert_eq!(pace.fitting(MS), 4000);
    }
}
