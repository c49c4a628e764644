//! The picture as a mesh of its first hits.

use super::cells::Cells;
use super::sheet::Band;
use super::{PixelMap, WarpError};
use crate::image::Image;
use crate::view::View;
use rayon::prelude::*;

/// How [`grid`] treats edges of depth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GridSettings {
    /// How far apart near and far side of a cell may move before it is torn, pixels of the wanted picture.
    pub tear_px: f64,
    /// Widest hole that is closed with the colours of its far side, pixels of the wanted picture.
    pub close_px: f64,
}

impl Default for GridSettings {
    fn default() -> Self {
        Self { tear_px: 1.0, close_px: 64.0 }
    }
}

/// Rows that are drawn at once.
const BAND_ROWS: usize = 16;

/// The picture of the shown view as the wanted view sees it if each pixel is a piece of surface at its first hit (VR §5.3.2).
/// Pixels without a hit are infinitely far away, so that without any depth this is [`quad`](super::quad).
///
/// Pixel centres are the vertices of a mesh, with a transparent ring around the picture. A cell whose corners stay together
/// is one sheet: two triangles, cut from top left to bottom right, with colours that are bilinear in the place within the
/// cell. In a torn cell each side is a sheet of its own, carried on at its own depth to the middle of the cell, so no colour
/// is between both. A hole that opens there shows the far side's colours, stretched up to the near side and behind all
/// that was seen; the furthest of several. A hole before nothing is transparent, and no hole is closed where the cell faces
/// away.
///
/// A shader does the same with an instance of three quadrilaterals per cell (corners at `matrix · (x, y, 1) + q · epipole`
/// of the [`PixelMap`], unused ones collapsed to a point), places interpolated without perspective, quarters discarded by
/// place, and the greater depth passing: `½ + ½·n·q` for sheets, `½ − ½·n·q` for what is behind holes, where n is the least
/// depth in the wanted picture.
///
/// # Errors
/// A picture that is not of the shown view, a parallel projection, views with numbers that are not finite or without area,
/// settings below zero.
pub fn grid(shown: &View, image: &Image, wanted: &View, settings: GridSettings) -> Result<Image, WarpError> {
    let map = PixelMap::between(shown, wanted)?;
    WarpError::unless_of(image, shown)?;
    let GridSettings { tear_px, close_px } = settings;
    WarpError::unless_distance("distance at which cells tear", tear_px)?;
    WarpError::unless_distance("width of holes that are closed", close_px)?;
    let cells = Cells::new(&map, image, settings, wanted.projection.depth_range_m().0);
    let extents: Vec<(f64, f64)> =
        (0..cells.blocks()).into_par_iter().map(|block| extent_y(&cells, block)).collect();
    let [width, height] = wanted.size;
    let mut warped = Image::transparent(width, height);
    let band_pixels = width as usize * BAND_ROWS;
    let colors = warped.color.par_chunks_mut(band_pixels);
    colors.zip(warped.depth_m.par_chunks_mut(band_pixels)).enumerate().for_each(
        |(index, (color, depth_m))| {
            let rank = vec![f64::NEG_INFINITY; color.len()];
            let first_row = index * BAND_ROWS;
            let end = (first_row + BAND_ROWS) as f64;
            let mut band = Band { first_row, width: width as usize, color, depth_m, rank };
            for (block, &(top, bottom)) in extents.iter().enumerate() {
                if top < end && bottom > first_row as f64 {
                    cells.for_each_sheet_of_block(block, |sheet| sheet.draw(&mut band));
                }
            }
        },
    );
    Ok(warped)
}

/// Lowest and highest pixel position along y of all that is drawn of a block of cells.
fn extent_y(cells: &Cells<'_>, block: usize) -> (f64, f64) {
    let mut extent = (f64::INFINITY, f64::NEG_INFINITY);
    cells.for_each_sheet_of_block(block, |sheet| {
        let (top, bottom) = sheet.extent_y();
        extent = (extent.0.min(top), extent.1.max(bottom));
    });
    extent
}
