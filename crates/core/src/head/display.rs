//! When pictures are shown.

use super::HeadError;

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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refreshes_follow_each_other_by_the_rate() {
        let display = Display::new(72.0).unwrap();
        assert!((display.refresh_s(144) - 2.0).abs() < 1e-12);
        assert_eq!(display.refresh_s(1), display.period_s());
    }

    #[test]
    fn rates_that_are_none_are_refused() {
        for rate_hz in [0.0, -90.0, f64::NAN, f64::INFINITY, 1e-320] {
            assert!(Display::new(rate_hz).is_err(), "{rate_hz}");
        }
    }
}
