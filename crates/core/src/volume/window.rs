//! Window: the interval of values that is mapped to [0, 1].

use thiserror::Error;

/// Narrowest that a window is stretched to, as a part of its middle.
const NARROWEST: f64 = 1e-6;

/// The value interval that is normalised to [0, 1]: `v = clamp((x − lo) / (hi − lo), 0, 1)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    lo: f64,
    hi: f64,
}

/// A window whose bounds are not finite or not in order.
#[derive(Debug, Error, PartialEq)]
#[error("window {lo}..{hi}: both bounds must be finite and the first below the second")]
pub struct WindowError {
    /// Lower bound given.
    pub lo: f64,
    /// Upper bound given.
    pub hi: f64,
}

impl Window {
    /// A window from its bounds, in the volume's unit.
    ///
    /// # Errors
    /// [`WindowError`] unless both are finite and `lo < hi`.
    pub fn new(lo: f64, hi: f64) -> Result<Self, WindowError> {
        if lo.is_finite() && hi.is_finite() && lo < hi && (hi - lo).is_finite() {
            Ok(Self { lo, hi })
        } else {
            Err(WindowError { lo, hi })
        }
    }

    /// A window over a finite range, widened upwards where the range is a single value.
    pub(super) fn spanning(lo: f64, hi: f64) -> Self {
        Self::new(lo, hi).unwrap_or_else(|_| {
            let centre = lo.clamp(-1e300, 1e300);
            Self { lo: centre, hi: centre + (centre.abs() * 1e-6).max(1.0) }
        })
    }

    /// Value that maps to 0.
    pub fn lo(self) -> f64 {
        self.lo
    }

    /// Value that maps to 1.
    pub fn hi(self) -> f64 {
        self.hi
    }

    /// The window shifted by parts of its width (its *level*) and then so many times as wide about its middle (its *width*).
    /// It stays at least a millionth of its middle wide.
    ///
    /// # Errors
    /// [`WindowError`] if a bound would not be finite.
    pub fn shifted_and_stretched(self, shift: f64, stretch: f64) -> Result<Self, WindowError> {
        let level = 0.5 * (self.lo + self.hi) + shift * (self.hi - self.lo);
        let narrowest = NARROWEST * level.abs().max(f64::MIN_POSITIVE / NARROWEST);
        let half = 0.5 * ((self.hi - self.lo) * stretch).max(narrowest);
        Self::new(level - half, level + half)
    }

    /// Normalises a value, clamped to [0, 1].
    pub fn normalise(self, value: f64) -> f64 {
        ((value - self.lo) / (self.hi - self.lo)).clamp(0.0, 1.0)
    }

    /// The value that a normalised value stands for.
    pub fn denormalise(self, normalised: f64) -> f64 {
        self.lo + normalised * (self.hi - self.lo)
    }
}
