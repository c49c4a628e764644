//! Between which depths parts of a picture have something.

use super::EmissionAbsorption;
use glam::DVec2;
use rayon::prelude::*;
use std::ops::Range;

/// Side of a tile, pixels.
const SIDE: usize = 16;

/// Nearest and furthest depth of what is in the layers of each tile, metres.
pub(super) struct DepthTiles {
    columns: usize,
    depths_m: Vec<Range<f64>>,
}

impl DepthTiles {
    pub(super) fn new(layers: &EmissionAbsorption) -> Self {
        let [width, height] = layers.size().map(|side| side as usize);
        let (columns, rows) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let depths_m = (0..columns * rows).into_par_iter().map(|tile| {
            let (left, top) = (tile % columns * SIDE, tile / columns * SIDE);
            (top..(top + SIDE).min(height))
                .flat_map(|y| (left..(left + SIDE).min(width)).map(move |x| y * width + x))
                .flat_map(|pixel| layers.of_pixel(pixel))
                .filter(|layer| !layer.is_clear())
                .map(|layer| f64::from(layer.start_m)..f64::from(layer.end_m))
                .fold(NOTHING, joined)
        });
        Self { columns, depths_m: depths_m.collect() }
    }

    /// Depths of the whole picture, if there is something.
    pub(super) fn all(&self) -> Option<Range<f64>> {
        unless_empty(self.depths_m.iter().cloned().fold(NOTHING, joined))
    }

    /// Depths of the tiles about two positions, pixels from the top left.
    pub(super) fn around(&self, first: DVec2, last: DVec2) -> Option<Range<f64>> {
        let rows = self.depths_m.len() / self.columns;
        // A pixel more on each side, which interpolation reads.
        let tile = |at: f64, count: usize| ((at / SIDE as f64) as usize).min(count - 1);
        let (low, high) = (first.min(last) - 1.0, first.max(last) + 1.0);
        let along = tile(low.x, self.columns)..=tile(high.x, self.columns);
        let depths_m = (tile(low.y, rows)..=tile(high.y, rows))
            .flat_map(|row| along.clone().map(move |column| row * self.columns + column))
            .map(|tile| self.depths_m[tile].clone());
        unless_empty(depths_m.fold(NOTHING, joined))
    }
}

const NOTHING: Range<f64> = f64::INFINITY..f64::NEG_INFINITY;

fn joined(a: Range<f64>, b: Range<f64>) -> Range<f64> {
    a.start.min(b.start)..a.end.max(b.end)
}

fn unless_empty(depths_m: Range<f64>) -> Option<Range<f64>> {
    (depths_m.start < depths_m.end).then_some(depths_m)
}
