//! Tiles of a quilt: view 0 at the bottom left, then to the right and up.

use super::QuiltDisplay;
use crate::image::RgbImage;
use thiserror::Error;

/// Pictures that are no quilt's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TileError {
    /// Another number of views than of tiles.
    #[error("{found} views: the quilt has {expected} tiles")]
    Count {
        /// Views given.
        found: usize,
        /// Tiles of the quilt.
        expected: u32,
    },
    /// A picture of another size.
    #[error("{what} is of {}x{} pixels: must be of {}x{}", found[0], found[1], expected[0], expected[1])]
    Size {
        /// Which picture.
        what: &'static str,
        /// Its width and height, pixels.
        found: [u32; 2],
        /// What they must be, pixels.
        expected: [u32; 2],
    },
}

impl QuiltDisplay {
    /// Top left pixel of a view's tile.
    pub fn tile_px(&self, view: u32) -> [u32; 2] {
        let [width, height] = self.tile_size_px();
        let (column, row_from_bottom) = (view % self.columns, view / self.columns);
        [column * width, self.quilt_size_px[1] - (row_from_bottom + 1) * height]
    }

    /// A picture of the size of the display's quilts.
    pub(in crate::lightfield) fn check_quilt(&self, quilt: &RgbImage) -> Result<(), TileError> {
        check_size("the quilt", quilt, self.quilt_size_px)
    }

    /// As many views as tiles, of their size.
    pub(in crate::lightfield) fn check_views(&self, views: &[RgbImage]) -> Result<(), TileError> {
        if views.len() != self.view_count() as usize {
            return Err(TileError::Count { found: views.len(), expected: self.view_count() });
        }
        views.iter().try_for_each(|view| check_size("a view", view, self.tile_size_px()))
    }

    /// The quilt of all views.
    ///
    /// # Errors
    /// Another number of views than of tiles, views of another size than a tile's.
    pub fn quilt(&self, views: &[RgbImage]) -> Result<RgbImage, TileError> {
        self.check_views(views)?;
        let [width, height] = self.quilt_size_px;
        let mut quilt = RgbImage { width, height, rgb: vec![[0.0; 3]; width as usize * height as usize] };
        for (index, view) in views.iter().enumerate() {
            quilt.paste(view, self.tile_px(index as u32));
        }
        Ok(quilt)
    }

    /// The views of a quilt, in order.
    ///
    /// # Errors
    /// A quilt of another size.
    pub fn views_of(&self, quilt: &RgbImage) -> Result<Vec<RgbImage>, TileError> {
        self.check_quilt(quilt)?;
        Ok((0..self.view_count()).map(|view| quilt.cut(self.tile_px(view), self.tile_size_px())).collect())
    }
}

fn check_size(what: &'static str, image: &RgbImage, expected: [u32; 2]) -> Result<(), TileError> {
    let found = [image.width, image.height];
    if found == expected { Ok(()) } else { Err(TileError::Size { what, found, expected }) }
}
