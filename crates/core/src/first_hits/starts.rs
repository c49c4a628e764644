//! Where rays start.

use super::{FirstHits, Passage, TILE, tiles_of};
use crate::view::View;
use rayon::prelude::*;

/// Depths before which the rays of each tile of a picture meet nothing.
#[derive(Debug, Clone, PartialEq)]
pub struct RayStarts {
    columns: u32,
    /// Row by row, metres along the view's −Z; infinite where rays meet nothing at all.
    depths_m: Vec<f32>,
}

impl RayStarts {
    /// Nothing is leapt over.
    pub(super) fn at_once(view: &View) -> Self {
        let [columns, rows] = tiles_of(view.size);
        Self { columns, depths_m: vec![f32::NEG_INFINITY; (columns * rows) as usize] }
    }

    /// Those of a view by what was seen in another.
    pub(super) fn through(passage: &Passage, view: &View, hits: &FirstHits) -> Self {
        let [columns, rows] = tiles_of(view.size);
        let start = |tile: u32| passage.start_m(view, hits, [tile % columns, tile / columns]) as f32;
        Self { columns, depths_m: (0..columns * rows).into_par_iter().map(start).collect() }
    }

    /// The depths of all tiles, row by row, metres.
    pub fn depths_m(&self) -> &[f32] {
        &self.depths_m
    }

    /// That of a pixel's tile, metres.
    pub(crate) fn of_pixel(&self, x: usize, y: usize) -> f64 {
        let tile = TILE as usize;
        f64::from(self.depths_m[y / tile * self.columns as usize + x / tile])
    }
}
