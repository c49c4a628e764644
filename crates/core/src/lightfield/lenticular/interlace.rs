//! The picture for a panel behind lenses, sub-pixel by sub-pixel.

use super::Lenticular;
use crate::image::RgbImage;
use crate::lightfield::quilt::{QuiltDisplay, TileError};
use rayon::prelude::*;

impl Lenticular {
    /// The picture that shows a quilt: each sub-pixel has the channel of the nearest pixel of the view that its lens sends where it
    /// sends the sub-pixel.
    ///
    /// # Errors
    /// A quilt of another size than the display's.
    pub fn interlace(&self, display: &QuiltDisplay, quilt: &RgbImage) -> Result<RgbImage, TileError> {
        display.check_quilt(quilt)?;
        let [width, height] = self.panel_px;
        let color = |column: u32, row: u32| {
            let in_tile = self.tile_pixel(display, column, row);
            [0, 1, 2].map(|channel| {
                let view = self.view(column, row, channel, display.view_count());
                let [left, top] = display.tile_px(view);
                let at = (top + in_tile[1]) as usize * quilt.width as usize + (left + in_tile[0]) as usize;
                quilt.rgb[at][channel]
            })
        };
        let rgb = (0..height)
            .into_par_iter()
            .flat_map_iter(|row| (0..width).map(move |column| color(column, row)))
            .collect();
        Ok(RgbImage { width, height, rgb })
    }

    /// The pixel of a tile that a pixel of the panel shows.
    fn tile_pixel(&self, display: &QuiltDisplay, column: u32, row: u32) -> [u32; 2] {
        let along = |at: u32, axis: usize, is_flipped: bool| {
            let [from, to] = [self.panel_px[axis], display.tile_size_px()[axis]].map(u64::from);
            let at = u64::from(if is_flipped { self.panel_px[axis] - 1 - at } else { at });
            // The middle of the pixel, in halves of pixels.
            ((2 * at + 1) * to / (2 * from)) as u32
        };
        [along(column, 0, self.flips_x), along(row, 1, self.flips_y)]
    }
}
