//! The picture that is warped.

use crate::pacer::BAND_ROWS;
use crate::renderer::Prepared;
use crate::target::Target;
use std::ops::Range;
use wheatstone_core::view::{PixelRect, View};
use wheatstone_core::warp::{PixelMap, WarpError};

/// Nearest depth that is told from the eye itself, metres.
const NEAREST_M: f64 = 1e-3;

/// A whole picture, the view that it was cast from, and how near what it shows may be.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    pub(super) target: &'a Target,
    pub(super) view: View,
    /// Largest inverse depth, 1/m.
    pub(super) nearest: f64,
    /// Least, 1/m.
    pub(super) furthest: f64,
}

impl<'a> Shown<'a> {
    /// A picture that was cast from a view with some settings.
    pub fn new(target: &'a Target, view: View, prepared: &Prepared) -> Self {
        let (nearest_m, furthest_m) = view.depths_m(&prepared.parameters().visible_corners_world());
        let near_m = view.projection.depth_range_m().0.max(NEAREST_M);
        Self { target, view, nearest: 1.0 / nearest_m.max(near_m), furthest: 1.0 / furthest_m.max(near_m) }
    }

    /// The wanted pixels that may show something of the picture between two inverse depths, 1/m.
    ///
    /// # Errors
    /// Views that do not go together, or with the picture.
    pub(super) fn covered(&self, wanted: &View, inverse_depths: Range<f64>) -> Result<PixelRect, WarpError> {
        WarpError::unless_of_size(self.target.size(), &self.view)?;
        let wanted_from_shown = PixelMap::between(&self.view, wanted)?;
        Ok(wanted_from_shown.covered(&self.drawn(), inverse_depths, wanted.size))
    }

    /// The pixels that may not be blank.
    fn drawn(&self) -> PixelRect {
        let pixels = |squares: &Range<u32>, side: u32| {
            squares.start * BAND_ROWS..side.min(squares.end.saturating_mul(BAND_ROWS))
        };
        let [width, height] = self.target.size();
        let drawn = &self.target.drawn;
        PixelRect { columns: pixels(&drawn.columns, width), rows: pixels(&drawn.bands, height) }
    }
}
