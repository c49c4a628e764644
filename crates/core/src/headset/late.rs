//! Refreshes that were missed.

use std::collections::VecDeque;

/// How long a session runs before misses count, seconds: caches are empty and costs unknown until then.
const WARM_UP_S: f64 = 1.0;

/// How many seconds are remembered one by one.
const SECONDS: usize = 60;

/// What happened within a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Second {
    /// Refreshes that got a picture of their own.
    pub shown: u32,
    /// Refreshes that did not: the one before was shown again.
    pub dropped: u32,
}

/// Counts refreshes without a picture of their own, by the display times that a runtime predicts for those that have one: where
/// the next is n periods after the last, n − 1 have been dropped.
///
/// The first second of a session does not count, nor does the time while it is [paused](Self::pause).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Late {
    /// Display times of the first picture and of the newest one, seconds.
    first_and_last_s: Option<[f64; 2]>,
    is_paused: bool,
    total: Second,
    /// Number of the newest second since the first picture.
    newest: u64,
    /// Up to the newest second.
    seconds: VecDeque<Second>,
}

impl Late {
    /// A picture is submitted for a display time in seconds, refreshes being a period apart. A time that is not after the last
    /// one's, or is none, is left out.
    pub fn submit(&mut self, display_time_s: f64, period_s: f64) {
        let Some([first_s, last_s]) = self.first_and_last_s else {
            if display_time_s.is_finite() {
                self.first_and_last_s = Some([display_time_s; 2]);
                self.enter(0, Second { shown: 1, dropped: 0 });
            }
            return;
        };
        let gap_s = display_time_s - last_s;
        if !(gap_s > 0.0 && gap_s.is_finite()) {
            return;
        }
        let periods = (gap_s / period_s).round();
        let is_counted = !self.is_paused && periods >= 1.0 && period_s > 0.0;
        // A cast to an integer keeps within its bounds.
        let dropped = if is_counted { (periods - 1.0) as u32 } else { 0 };
        self.is_paused = false;
        self.first_and_last_s = Some([first_s, display_time_s]);
        let picture = Second { shown: 1, dropped };
        self.enter((display_time_s - first_s) as u64, picture);
        if display_time_s - first_s > WARM_UP_S {
            self.total = sum(self.total, picture);
        }
    }

    /// The session does not show pictures for a while: the time until the next one does not count.
    pub fn pause(&mut self) {
        self.is_paused = true;
    }

    /// What has been shown and dropped after the first second.
    pub fn total(&self) -> Second {
        self.total
    }

    /// The last minute, second by second from the first picture on, the first of them too; the newest is not over yet.
    pub fn seconds(&self) -> impl Iterator<Item = Second> {
        self.seconds.iter().copied()
    }

    fn enter(&mut self, second: u64, picture: Second) {
        let gone_by = usize::try_from(second - self.newest).unwrap_or(SECONDS).min(SECONDS);
        self.seconds.extend(std::iter::repeat_n(Second::default(), gone_by));
        self.newest = second;
        if self.seconds.is_empty() {
            self.seconds.push_back(Second::default());
        }
        self.seconds.drain(..self.seconds.len().saturating_sub(SECONDS));
        if let Some(newest) = self.seconds.back_mut() {
            *newest = sum(*newest, picture);
        }
    }
}

fn sum(a: Second, b: Second) -> Second {
    Second { shown: a.shown.saturating_add(b.shown), dropped: a.dropped.saturating_add(b.dropped) }
}
