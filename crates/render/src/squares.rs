//! Rectangles of a picture, in the squares that workgroups take.

use crate::pacer::BAND_ROWS;
use glam::DVec3;
use std::ops::Range;
use wheatstone_core::view::{PixelRect, View};

/// Squares of `BAND_ROWS` pixels that a body can cover.
#[derive(Debug, Clone, Default)]
pub(crate) struct Squares {
    /// From the left.
    pub(crate) columns: Range<u32>,
    /// From the top.
    pub(crate) bands: Range<u32>,
}

impl Squares {
    pub(crate) fn covered(view: &View, corners_world: &[DVec3]) -> Self {
        let covered = PixelRect::around(view, corners_world.iter().copied());
        let squares = |pixels: Range<u32>| pixels.start / BAND_ROWS..pixels.end.div_ceil(BAND_ROWS);
        Self { columns: squares(covered.columns), bands: squares(covered.rows) }
    }

    pub(crate) fn counts(&self) -> [u32; 2] {
        [self.columns.len() as u32, self.bands.len() as u32]
    }

    /// Rows of pixels of a picture of the given height.
    pub(crate) fn rows(&self, height: u32) -> u32 {
        height.min(self.bands.end * BAND_ROWS).saturating_sub(self.bands.start * BAND_ROWS)
    }
}
