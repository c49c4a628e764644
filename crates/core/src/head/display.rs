//! When pictures are shown.

use super::{Cadence, HeadError};

/// Share of a period by which a time may miss a refresh and still be on it: rounding.
pub(super) const ROUNDING: f64 = 1e-9;

/// A display that shows a picture at fixed intervals; refresh 0 is at 0 s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Display {
    period_s: f64,
}

impl Default for Display {
    /// 90 Hz.
    fn default() -> Self {
        Self { period_s: 1.0 / 90.0 }
    }
}

impl Display {
    /// A display of a refresh rate in Hz.
    ///
    /// # Errors
    /// A rate that is not above zero and finite, or whose period is not.
    pub fn new(rate_hz: f64) -> Result<Self, HeadError> {
        let period_s = HeadError::unless_positive("refresh rate in Hz", rate_hz)?.recip();
        Ok(Self { period_s: HeadError::unless_positive("refresh period in s", period_s)? })
    }

    /// Time between refreshes, seconds.
    pub fn period_s(&self) -> f64 {
        self.period_s
    }

    /// When a refresh is, seconds.
    pub fn refresh_s(&self, refresh: u64) -> f64 {
        refresh as f64 * self.period_s
    }

    /// The first refresh at a time in seconds or after it; refresh 0 for negative times and what is no number.
    pub fn refresh_from(&self, time_s: f64) -> u64 {
        (time_s / self.period_s - ROUNDING).ceil() as u64
    }

    /// Which view is shown at which refresh, if each takes so many seconds to render.
    ///
    /// # Errors
    /// A duration that is negative or not finite.
    pub fn cadence(&self, render_s: f64) -> Result<Cadence, HeadError> {
        Cadence::new(*self, render_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refreshes_are_found_by_their_time() {
        for rate_hz in [60.0, 72.0, 90.0, 144.0] {
            let display = Display::new(rate_hz).unwrap();
            for refresh in [0, 1, 7, 89, 100_003] {
                let time_s = display.refresh_s(refresh);
                assert_eq!(display.refresh_from(time_s), refresh);
                assert_eq!(display.refresh_from(time_s + 0.1 * display.period_s()), refresh + 1);
            }
        }
        assert_eq!([-3.0, f64::NAN].map(|s| Display::default().refresh_from(s)), [0, 0]);
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for rate_hz in [0.0, -90.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert!(Display::new(rate_hz).is_err(), "{rate_hz}");
        }
    }
}
