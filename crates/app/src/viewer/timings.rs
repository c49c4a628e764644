//! How long refreshes take.

use std::collections::VecDeque;

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
}

impl Timings {
    pub(crate) fn push(&mut self, frame: Frame) {
        self.recent.truncate(RECENT - 1);
        self.recent.push_front(frame);
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
}
