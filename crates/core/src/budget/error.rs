//! Why numbers cannot be scheduled.

use thiserror::Error;

/// Numbers that no schedule can be made of.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum BudgetError {
    /// A picture without area, or cells without.
    #[error(
        "picture of {}×{} pixels in cells of {cell_side_px} pixels: all must be at least 1", size[0], size[1]
    )]
    Empty {
        /// Width and height of the picture, pixels.
        size: [u32; 2],
        /// Side of a cell, pixels.
        cell_side_px: u32,
    },
    /// Cells so small that keeping account of them costs more than they do.
    #[error("{cells} cells: at most {most}, make them larger")]
    Cells {
        /// Cells that the picture would have.
        cells: u64,
        /// Most that a grid has.
        most: u64,
    },
    /// A duration that is negative or not finite.
    #[error("duration of {0} s: must be finite and not negative")]
    Seconds(f64),
    /// As many durations as cells are needed.
    #[error("{durations} durations for {cells} cells: one for each is needed")]
    Durations {
        /// Durations given.
        durations: usize,
        /// Cells that were cast.
        cells: usize,
    },
    /// A number of samples per pixel, or of refreshes, that is not above zero.
    #[error("{0} {1}: must be above 0 and finite")]
    NotPositive(&'static str, f64),
}

impl BudgetError {
    /// The value, if it is above zero and finite.
    pub(super) fn unless_positive(what: &'static str, value: f64) -> Result<f64, Self> {
        if value > 0.0 && value.is_finite() { Ok(value) } else { Err(Self::NotPositive(what, value)) }
    }

    /// The duration, if it is finite and not negative.
    pub(super) fn unless_duration(seconds: f64) -> Result<f64, Self> {
        if seconds >= 0.0 && seconds.is_finite() { Ok(seconds) } else { Err(Self::Seconds(seconds)) }
    }
}
