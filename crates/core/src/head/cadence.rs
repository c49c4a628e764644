//! Which view is shown when.

use super::display::ROUNDING;
use super::{Display, HeadError};

/// Views that are rendered one after the other, each from one refresh to the first one by which it is complete, and shown from
/// there until the next one is (VR §6.2 and Fig. 12). View 0 begins at refresh 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cadence {
    display: Display,
    refreshes_per_view: u64,
}

impl Cadence {
    pub(super) fn new(display: Display, render_s: f64) -> Result<Self, HeadError> {
        if render_s < 0.0 {
            return Err(HeadError::Negative("render time in s", render_s));
        }
        let periods = HeadError::unless_finite("render time in s", render_s)? / display.period_s();
        Ok(Self { display, refreshes_per_view: ((periods - ROUNDING).ceil() as u64).max(1) })
    }

    /// Refreshes from the beginning of a view to that of the next: each picture is shown this often.
    pub fn refreshes_per_view(&self) -> u64 {
        self.refreshes_per_view
    }

    /// The newest view that is complete at a refresh; none before view 0 is.
    pub fn view_shown(&self, refresh: u64) -> Option<u64> {
        (refresh / self.refreshes_per_view).checked_sub(1)
    }

    /// When the rendering of a view begins, seconds: what the head does later can only be predicted.
    pub fn begins_s(&self, view: u64) -> f64 {
        self.display.period_s() * self.refreshes_per_view as f64 * view as f64
    }

    /// When a view is shown first, seconds: the time to render it for.
    pub fn first_shown_s(&self, view: u64) -> f64 {
        self.begins_s(view) + self.display.period_s() * self.refreshes_per_view as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_is_shown_once_it_is_complete_until_the_next_one_is() {
        let display = Display::default();
        for (periods, refreshes) in [(0.0, 1), (0.5, 1), (1.0, 1), (1.1, 2), (3.0, 3), (19.0, 19)] {
            let cadence = display.cadence(periods * display.period_s()).unwrap();
            assert_eq!(cadence.refreshes_per_view(), refreshes);
            for refresh in 0..100 {
                let now_s = display.refresh_s(refresh) + 1e-9;
                let complete = (0..100).filter(|&view| cadence.first_shown_s(view) <= now_s);
                assert_eq!(cadence.view_shown(refresh), complete.max());
            }
        }
    }

    #[test]
    fn render_times_that_are_none_are_refused() {
        for render_s in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(Display::default().cadence(render_s).is_err());
        }
        let slowest = Display::default().cadence(f64::MAX).unwrap();
        assert_eq!(slowest.view_shown(u64::MAX - 1), None);
    }
}
