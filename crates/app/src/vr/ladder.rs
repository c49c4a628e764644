//! Which warp a refresh has time for, by what warps took.

use crate::viewer::state::WarpName;
use std::collections::HashMap;
use std::time::Duration;

/// Part of a refresh that drawing may take.
const SHARE: f64 = 0.4;

/// Refreshes after which a warp that took too long is tried again: at first, since it may have had to be compiled, and at most.
const TRY_AGAIN: [u64; 2] = [4, 256];

/// How much the newest time counts for what a warp takes: as much as all before it.
const NEWEST: f64 = 0.5;

/// From the warp that is asked for to the cheapest that still follows the eyes.
#[derive(Debug, Default)]
pub(crate) struct Ladder {
    taken: HashMap<WarpName, Taken>,
    refresh: u64,
}

/// What a warp took.
#[derive(Debug)]
struct Taken {
    seconds: f64,
    /// The refresh at which it did last.
    last: u64,
    /// Refreshes after which it is tried again if that is too long: twice as many each time.
    pause: u64,
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
                .is_none_or(|taken| taken.fits(period_s) || self.refresh - taken.last > taken.pause)
        };
        steps.iter().copied().find(fits).unwrap_or(steps[steps.len() - 1])
    }

    /// A refresh of so long was drawn with a warp, and that took so long.
    pub(crate) fn note(&mut self, warp: WarpName, took: Duration, period_s: f64) {
        self.refresh += 1;
        let [first, most] = TRY_AGAIN;
        let newest_s = took.as_secs_f64();
        let taken = match self.taken.remove(&warp) {
            Some(before) if before.fits(period_s) => {
                let seconds = before.seconds + NEWEST * (newest_s - before.seconds);
                Taken { seconds, last: self.refresh, pause: first }
            }
            Some(before) => {
                Taken { seconds: newest_s, last: self.refresh, pause: (2 * before.pause).min(most) }
            }
            None => Taken { seconds: newest_s, last: self.refresh, pause: first },
        };
        self.taken.insert(warp, taken);
    }
}

impl Taken {
    /// Whether a refresh of so long has time for it.
    fn fits(&self, period_s: f64) -> bool {
        self.seconds <= SHARE * period_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_S: f64 = 0.01;

    fn choose(ladder: &Ladder) -> WarpName {
        ladder.choose(WarpName::Volumetric, PERIOD_S)
    }

    /// Draws refreshes for as long as a warp is chosen; how many.
    fn draw(ladder: &mut Ladder, warp: WarpName, ms: u64) -> u64 {
        let mut refreshes = 0;
        while refreshes < 1000 && choose(ladder) == warp {
            ladder.note(warp, Duration::from_millis(ms), PERIOD_S);
            refreshes += 1;
        }
        refreshes
    }

    #[test]
    fn a_warp_that_takes_too_long_gives_way_and_comes_back_ever_later() {
        let mut ladder = Ladder::default();
        let mut pauses = Vec::new();
        for _ in 0..9 {
            assert_eq!(draw(&mut ladder, WarpName::Volumetric, 9), 1);
            pauses.push(draw(&mut ladder, WarpName::Grid, 2));
        }
        assert_eq!(pauses, [5, 9, 17, 33, 65, 129, 257, 257, 257]);
        assert_eq!(draw(&mut ladder, WarpName::Volumetric, 1), 1000);
        // The load of one refresh is no reason to give way, that of some is.
        ladder.note(WarpName::Volumetric, Duration::from_millis(6), PERIOD_S);
        assert_eq!(draw(&mut ladder, WarpName::Volumetric, 6), 1);
    }

    #[test]
    fn the_cheapest_warp_is_taken_if_none_fits() {
        let mut ladder = Ladder::default();
        for warp in [WarpName::Volumetric, WarpName::Grid] {
            assert_eq!(draw(&mut ladder, warp, 9), 1);
        }
        assert_eq!(choose(&ladder), WarpName::Quad);
        ladder.note(WarpName::Quad, Duration::from_millis(9), PERIOD_S);
        assert_eq!(choose(&ladder), WarpName::Quad);
    }

    #[test]
    fn no_better_warp_is_chosen_than_what_is_asked_for() {
        let ladder = Ladder::default();
        for warp in WarpName::ALL {
            assert_eq!(ladder.choose(warp, 0.01), warp);
        }
    }
}
