//! How long refreshes take.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Refreshes that the graph shows.
const RECENT: usize = 150;

/// One refresh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Frame {
    /// From the refresh before, ms, while refreshes follow on each other.
    pub(crate) total_ms: f32,
    /// Of that for panels, warps and presenting, ms.
    pub(crate) draw_ms: f32,
}

/// The latest refreshes.
#[derive(Debug, Default)]
pub(crate) struct Timings {
    recent: VecDeque<Frame>,
    /// When the last refresh that was noted began.
    last: Option<Instant>,
}

impl Timings {
    pub(crate) fn push(&mut self, frame: Frame) {
        self.recent.truncate(RECENT - 1);
        self.recent.push_front(frame);
    }

    /// Takes in a refresh that began and was drawn, if it followed on the one before: had it not been wanted within a period of that,
    /// there was a rest between them.
    pub(crate) fn note(&mut self, wanted: Instant, begun: Instant, draw: Duration, period: Duration) {
        let milliseconds = |duration: Duration| duration.as_secs_f32() * 1e3;
        let followed =
            self.last.replace(begun).filter(|&last| wanted.saturating_duration_since(last) <= period);
        if let Some(last) = followed {
            let total = begun.saturating_duration_since(last);
            self.push(Frame { total_ms: milliseconds(total), draw_ms: milliseconds(draw) });
        }
    }

    /// The latest first.
    pub(crate) fn recent(&self) -> impl Iterator<Item = &Frame> {
        self.recent.iter()
    }

    /// Most that [`Timings::recent`] gives.
    pub(crate) fn most_recent(&self) -> usize {
        RECENT
    }

    /// Medians of the latest, in words.
    pub(crate) fn described(&self) -> String {
        let median = |part: fn(&Frame) -> f32| {
            let mut times: Vec<f32> = self.recent.iter().map(part).collect();
            times.sort_by(f32::total_cmp);
            times.get(times.len() / 2).copied().unwrap_or(0.0)
        };
        format!(
            "{:.0} ms, {:.0} of them drawing",
            median(|frame| frame.total_ms),
            median(|frame| frame.draw_ms)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_are_kept() {
        let mut timings = Timings::default();
        for index in 0..400 {
            timings.push(Frame { total_ms: index as f32, draw_ms: 1.0 });
        }
        assert_eq!(timings.recent().count(), RECENT);
        assert_eq!(timings.recent().next().unwrap().total_ms, 399.0);
        assert_eq!(timings.described(), "325 ms, 1 of them drawing");
    }

    #[test]
    fn a_rest_is_not_a_late_refresh_and_a_late_one_is() {
        let ms = Duration::from_millis;
        let (mut timings, start) = (Timings::default(), Instant::now());
        // When wanted, when begun.
        for [wanted_ms, begun_ms] in [[0, 0], [20, 40], [70, 130], [5000, 5001], [5030, 5041], [5082, 5083]] {
            timings.note(start + ms(wanted_ms), start + ms(begun_ms), ms(5), ms(40));
        }
        let totals: Vec<f32> = timings.recent().map(|frame| frame.total_ms).collect();
        assert_eq!(totals, [40.0, 90.0, 40.0]);
    }
}
