//! Why numbers are no motion.

use thiserror::Error;

/// Numbers that cannot be simulated.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum HeadError {
    /// A number that must be above zero and finite.
    #[error("{0} {1}: must be above 0 and finite")]
    NotPositive(&'static str, f64),
    /// A number that must be finite.
    #[error("{0} {1}: must be finite")]
    NotFinite(&'static str, f64),
    /// A pose with coordinates that are not finite.
    #[error("a pose must have finite coordinates and a unit orientation")]
    Pose,
    /// A pose that is not newer than the one before.
    #[error("pose of {time_s} s after one of {last_s} s: poses must come in order of time")]
    Order {
        /// Of the pose, seconds.
        time_s: f64,
        /// Of the newest pose so far, seconds.
        last_s: f64,
    },
}

impl HeadError {
    pub(super) fn unless_positive(what: &'static str, value: f64) -> Result<f64, Self> {
        if value > 0.0 && value.is_finite() { Ok(value) } else { Err(Self::NotPositive(what, value)) }
    }

    pub(super) fn unless_finite(what: &'static str, value: f64) -> Result<f64, Self> {
        if value.is_finite() { Ok(value) } else { Err(Self::NotFinite(what, value)) }
    }
}
