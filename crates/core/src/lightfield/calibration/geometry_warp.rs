//! Moving the pixels of a projector's picture to where the ideal one would have them (LF §5, the second pass).

use crate::image::RgbImage;
use glam::DVec2;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A table of where in the ideal picture each part of the projector's image is to look.
///
/// Nodes are spread evenly from corner to corner of the image, row by row from the top left; between them positions are interpolated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeometryWarp {
    /// Nodes along a row.
    columns: u32,
    /// Rows of nodes.
    rows: u32,
    /// Of each node the position in the ideal picture, pixels from the top left.
    positions_px: Vec<[f64; 2]>,
}

/// A table that is none.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NotAWarp {
    /// Fewer than two nodes along a side.
    #[error("a warp of {columns}x{rows} nodes: at least 2x2 are needed")]
    TooSmall {
        /// Nodes along a row.
        columns: u32,
        /// Rows of nodes.
        rows: u32,
    },
    /// Another number of positions than of nodes.
    #[error("{found} positions: {expected} nodes need one each")]
    Count {
        /// Positions given.
        found: usize,
        /// Nodes.
        expected: u64,
    },
    /// A position that is not finite.
    #[error("the position of node {0} is not finite")]
    NotFinite(usize),
}

impl GeometryWarp {
    /// A warp from the positions of its nodes.
    ///
    /// # Errors
    /// Fewer than 2 × 2 nodes, another number of positions than of nodes, positions that are not finite.
    pub fn new(columns: u32, rows: u32, positions_px: Vec<[f64; 2]>) -> Result<Self, NotAWarp> {
        Self { columns, rows, positions_px }.checked()
    }

    /// The same if it can be one, as after reading it.
    ///
    /// # Errors
    /// As [`GeometryWarp::new`].
    pub fn checked(self) -> Result<Self, NotAWarp> {
        let Self { columns, rows, ref positions_px } = self;
        if columns < 2 || rows < 2 {
            return Err(NotAWarp::TooSmall { columns, rows });
        }
        let (found, expected) = (positions_px.len(), u64::from(columns) * u64::from(rows));
        if found as u64 != expected {
            return Err(NotAWarp::Count { found, expected });
        }
        match positions_px.iter().position(|at| !DVec2::from(*at).is_finite()) {
            Some(node) => Err(NotAWarp::NotFinite(node)),
            None => Ok(self),
        }
    }

    /// The warp that a function of positions in the image gives, pixels, sampled at so many nodes (at least 2 along each side).
    pub fn from_fn(
        columns: u32,
        rows: u32,
        size_px: [u32; 2],
        ideal_from_image: impl Fn(DVec2) -> DVec2,
    ) -> Self {
        let (columns, rows) = (columns.max(2), rows.max(2));
        let size = DVec2::from(size_px.map(f64::from));
        let last = DVec2::new(f64::from(columns - 1), f64::from(rows - 1));
        let node = |i: u32| DVec2::new(f64::from(i % columns), f64::from(i / columns)) / last * size;
        let positions_px = (0..columns * rows).map(|i| ideal_from_image(node(i)).to_array()).collect();
        Self { columns, rows, positions_px }
    }

    /// Where in the ideal picture a position of the image looks, pixels; the image has a size, pixels.
    pub fn ideal_px(&self, at: DVec2, size_px: [u32; 2]) -> DVec2 {
        let last = DVec2::new(f64::from(self.columns - 1), f64::from(self.rows - 1));
        let along = (at / DVec2::from(size_px.map(f64::from)) * last).clamp(DVec2::ZERO, last);
        let lower = along.floor().min(last - 1.0);
        let part = along - lower;
        let node = |x: f64, y: f64| {
            DVec2::from(
                self.positions_px[(lower.y + y) as usize * self.columns as usize + (lower.x + x) as usize],
            )
        };
        let above = node(0.0, 0.0).lerp(node(1.0, 0.0), part.x);
        above.lerp(node(0.0, 1.0).lerp(node(1.0, 1.0), part.x), part.y)
    }

    /// The image that a projector is to show of an ideal picture of its size; black where it looks beyond the picture's edges.
    pub fn apply(&self, ideal: &RgbImage) -> RgbImage {
        let (width, size) = (ideal.width as usize, [ideal.width, ideal.height]);
        let mut image = RgbImage { rgb: vec![[0.0; 3]; ideal.rgb.len()], ..*ideal };
        if width > 0 {
            image.rgb.par_chunks_mut(width).enumerate().for_each(|(y, row)| {
                for (x, pixel) in row.iter_mut().enumerate() {
                    let at = DVec2::new(x as f64, y as f64) + 0.5;
                    *pixel = ideal.sample(self.ideal_px(at, size)).unwrap_or([0.0; 3]);
                }
            });
        }
        image
    }
}
