//! What is wanted next.

use super::{BudgetError, CellGrid};

/// A picture to cast.
#[derive(Debug, Clone, PartialEq)]
pub struct ViewRequest<C> {
    /// All that tells this picture from another: pose, settings, volume, quality.
    pub content: C,
    grid: CellGrid,
    work_per_pixel: f64,
}

impl<C> ViewRequest<C> {
    /// A picture of the given cells, each of whose pixels takes a relative amount of work, such as
    /// [`Quality::work_per_pixel`](super::Quality::work_per_pixel): traced costs are scaled by it when it changes.
    ///
    /// # Errors
    /// Work that is not above zero and finite.
    pub fn new(content: C, grid: CellGrid, work_per_pixel: f64) -> Result<Self, BudgetError> {
        let work_per_pixel = BudgetError::unless_positive("work per pixel", work_per_pixel)?;
        Ok(Self { content, grid, work_per_pixel })
    }

    /// The cells of the picture.
    pub fn grid(&self) -> &CellGrid {
        &self.grid
    }

    /// Relative work of a pixel.
    pub fn work_per_pixel(&self) -> f64 {
        self.work_per_pixel
    }
}
