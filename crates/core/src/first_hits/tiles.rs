//! What a picture saw first, tile by tile.

use super::{Passage, RayStarts};
use crate::cast::CastParameters;
use crate::view::View;

/// Pixels along each side of a tile.
pub const TILE: u32 = 8;

/// Columns and rows of the tiles of a picture.
pub fn tiles_of(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(TILE))
}

/// Where the rays of a picture saw something first.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstHits {
    /// From where.
    view: View,
    /// How much nearer something may be than what was seen, metres: between two rays or two samples.
    margin_m: f64,
    /// The nearest of each tile, row by row, metres along the view's −Z; infinite where nothing was seen.
    nearest_m: Vec<f32>,
}

impl FirstHits {
    /// Those of a picture by tiles: the depth of the nearest sample of each tile that is visible at all, metres, infinite without one;
    /// something may be nearer by [`margin_m`].
    ///
    /// # Panics
    /// If there are not as many as tiles.
    pub fn of_tiles(view: &View, margin_m: f64, nearest_m: Vec<f32>) -> Self {
        let [columns, rows] = tiles_of(view.size).map(|count| count as usize);
        assert_eq!(nearest_m.len(), columns * rows, "one depth for each tile");
        Self { view: *view, margin_m, nearest_m }
    }

    /// The same by pixels.
    pub(crate) fn of_pixels(view: &View, parameters: &CastParameters, visible_from_m: &[f32]) -> Self {
        let [columns, rows] = tiles_of(view.size).map(|count| count as usize);
        let mut nearest_m = vec![f32::INFINITY; columns * rows];
        let (width, tile) = (view.size[0] as usize, TILE as usize);
        for (y, row) in visible_from_m.chunks(width.max(1)).enumerate() {
            for (x, &depth_m) in row.iter().enumerate() {
                let of_tile = &mut nearest_m[y / tile * columns + x / tile];
                *of_tile = of_tile.min(depth_m);
            }
        }
        Self { view: *view, margin_m: margin_m(parameters), nearest_m }
    }

    /// The view that the picture was seen from.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// How much nearer something may be than what was seen, metres.
    pub fn margin_m(&self) -> f64 {
        self.margin_m
    }

    /// The nearest depth of each tile, row by row, metres; infinite where nothing was seen.
    pub fn nearest_m(&self) -> &[f32] {
        &self.nearest_m
    }

    /// Where the rays of another view of the same scene may start.
    pub fn starts(&self, view: &View, parameters: &CastParameters) -> RayStarts {
        match Passage::between(view, &self.view, self.margin_m, parameters) {
            Some(passage) => RayStarts::through(&passage, view, self),
            None => RayStarts::at_once(view),
        }
    }

    /// The nearest depth of a tile, metres.
    pub(super) fn of_tile(&self, column: u32, row: u32) -> f64 {
        let [columns, _] = tiles_of(self.view.size);
        f64::from(self.nearest_m[(row * columns + column) as usize])
    }
}

/// How much nearer something may be than what a cast saw first, metres: a voxel, which may stand out between two rays, and a step.
pub fn margin_m(parameters: &CastParameters) -> f64 {
    parameters.voxel_length_m() * (1.0 + 1.0 / f64::from(parameters.sampling_factor))
}
