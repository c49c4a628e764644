//! Which warp a refresh has time for, by what warps took.

use crate::viewer::state::WarpName;
use std::collections::HashMap;
use std::time::Duration;

/// Part of a refresh that drawing may take.
const SHARE: f64 = 0.4;

/// Refreshes after which a warp that took too long is tried again.
const TRY_AGAIN: u64 = 90;

/// How much the newest time counts for what a warp takes: as much as all before it.
const NEWEST: f64 = 0.5;

/// From the warp that is asked for to the cheapest that still follows the eyes.
#[derive(Debug, Default)]
pub(crate) struct Ladder {
    /// What each warp took, seconds, and the refresh at which it did last.
    taken: HashMap<WarpName, (f64, u64)>,
    refresh: u64,
}

impl Ladder {
    /// The best warp, no better than what is asked for, that a refresh of so long has time for, as far as is known.
    pub(crate) fn choose(&self, asked: WarpName, period_s: f64) -> WarpName {
        let steps: &[WarpName] = match asked {
            WarpName::None => &[WarpName::None],
            WarpName::Quad => &[WarpName::Quad],
            WarpName::Grid => &[WarpName::Grid, WarpName::Quad],
            WarpName::Volumetric => &[WarpName::Volumetric, WarpName::Grid, WarpName::Quad],
        };
        let fits = |warp: &WarpName| {
            self.taken
                .get(warp)
                .is_none_or(|&(seconds, last)| seconds <= SHARE * period_s || self.refresh - last > TRY_AGAIN)
        };
        steps.iter().copied().find(fits).unwrap_or(steps[steps.len() - 1])
    }

    /// A refresh was drawn with a warp, and that took so long.
    pub(crate) fn note(&mut self, warp: WarpName, took: Duration) {
        self.refresh += 1;
        let newest_s = took.as_secs_f64();
        let (seconds, last) = self.taken.entry(warp).or_insert((newest_s, 0));
        *seconds += NEWEST * (newest_s - *seconds);
        *last = self.refresh;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warp_that_takes_too_long_gives_way_and_comes_back() {
        let mut ladder = Ladder::default();
        let period_s = 0.01;
        let choose = |ladder: &Ladder| ladder.choose(WarpName::Volumetric, period_s);
        assert_eq!(choose(&ladder), WarpName::Volumetric);
        ladder.note(WarpName::Volumetric, Duration::from_millis(9));
        assert_eq!(choose(&ladder), WarpName::Grid);
        ladder.note(WarpName::Grid, Duration::from_millis(5));
        assert_eq!(choose(&ladder), WarpName::Quad);
        for _ in 0..=TRY_AGAIN {
            ladder.note(WarpName::Quad, Duration::from_millis(8));
        }
        assert_eq!(choose(&ladder), WarpName::Volumetric);
        for _ in 0..4 {
            ladder.note(WarpName::Volumetric, Duration::from_millis(1));
        }
        assert_eq!(choose(&ladder), WarpName::Volumetric);
    }

    #[test]
    fn no_better_warp_is_chosen_than_what_is_asked_for() {
        let ladder = Ladder::default();
        for warp in WarpName::ALL {
            assert_eq!(ladder.choose(warp, 0.01), warp);
        }
    }
}
