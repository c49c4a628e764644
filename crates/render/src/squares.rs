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
        Self::of(&PixelRect::around(view, corners_world.iter().copied()))
    }

    /// The squares that hold some pixels.
    pub(crate) fn of(rect: &PixelRect) -> Self {
        let squares = |pixels: &Range<u32>| pixels.start / BAND_ROWS..pixels.end.div_ceil(BAND_ROWS);
        Self { columns: squares(&rect.columns), bands: squares(&rect.rows) }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.columns.is_empty() || self.bands.is_empty()
    }

    /// Those that are in both.
    pub(crate) fn within(&self, other: &Self) -> Self {
        let within = |a: &Range<u32>, b: &Range<u32>| a.start.max(b.start)..a.end.min(b.end);
        Self { columns: within(&self.columns, &other.columns), bands: within(&self.bands, &other.bands) }
    }

    /// The rectangle around both.
    pub(crate) fn around(&self, other: &Self) -> Self {
        let around = |a: &Range<u32>, b: &Range<u32>| a.start.min(b.start)..a.end.max(b.end);
        match (self.is_empty(), other.is_empty()) {
            (true, _) => other.clone(),
            (_, true) => self.clone(),
            _ => Self {
                columns: around(&self.columns, &other.columns),
                bands: around(&self.bands, &other.bands),
            },
        }
    }

    pub(crate) fn counts(&self) -> [u32; 2] {
        [self.columns.len() as u32, self.bands.len() as u32]
    }

    /// The pixels of a picture of the given size that they hold.
    pub(crate) fn pixels(&self, [width, height]: [u32; 2]) -> PixelRect {
        let pixels = |squares: &Range<u32>, side: u32| {
            squares.start * BAND_ROWS..side.min(squares.end.saturating_mul(BAND_ROWS))
        };
        PixelRect { columns: pixels(&self.columns, width), rows: pixels(&self.bands, height) }
    }

    /// Rows of pixels of a picture of the given height.
    pub(crate) fn rows(&self, height: u32) -> u32 {
        height.min(self.bands.end * BAND_ROWS).saturating_sub(self.bands.start * BAND_ROWS)
    }
}
