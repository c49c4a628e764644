//! Eyes.

use crate::lightfield::error::check_size_px;
use crate::lightfield::quilt::screen_view;
use crate::view::View;
use glam::{DAffine3, DVec2, DVec3};
use thiserror::Error;

/// An eye in front of a screen, and how finely it looks at it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    position_m: DVec3,
    size_px: [u32; 2],
}

/// Why something is no eye.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[non_exhaustive]
pub enum EyeError {
    /// A place that is not in front of the screen.
    #[error("an eye at {0}: must be in front of the screen, z above 0, and finite")]
    Place(DVec3),
    /// A picture without pixels, or with too many.
    #[error("a picture of {}x{} pixels: each side must be from 1 to 32768, and all together at most 134217728", .0[0], .0[1])]
    Size([u32; 2]),
}

impl Eye {
    /// An eye at a place of display space, metres, that cuts the screen into so many pixels.
    ///
    /// # Errors
    /// Places that are not in front of the screen, no pixels.
    pub fn new(position_m: DVec3, size_px: [u32; 2]) -> Result<Self, EyeError> {
        if !(position_m.is_finite() && position_m.z > 0.0) {
            return Err(EyeError::Place(position_m));
        }
        check_size_px("an eye's picture", size_px).map_err(|_| EyeError::Size(size_px))?;
        Ok(Self { position_m, size_px })
    }

    /// Where it is in display space, metres.
    pub fn position_m(&self) -> DVec3 {
        self.position_m
    }

    /// Width and height of its picture, pixels.
    pub fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// What it would see through a screen of a size, metres, if the world itself were there.
    pub fn view(&self, screen_size_m: [f64; 2], display_from_world: DAffine3) -> View {
        screen_view(self.position_m, screen_size_m, self.size_px, display_from_world)
    }

    /// The place on a screen in the middle of a pixel, metres.
    pub(super) fn screen_m(&self, screen_size_m: [f64; 2], column: usize, row: usize) -> DVec2 {
        let share = (DVec2::new(column as f64, row as f64) + 0.5) / DVec2::from(self.size_px.map(f64::from));
        DVec2::new(share.x - 0.5, 0.5 - share.y) * DVec2::from(screen_size_m)
    }

    /// A picture from a function of columns and rows.
    pub(super) fn picture(&self, color: impl Fn(usize, usize) -> [f32; 3] + Sync) -> crate::image::RgbImage {
        use rayon::prelude::*;
        let [width, height] = self.size_px;
        let mut rgb = vec![[0.0; 3]; width as usize * height as usize];
        rgb.par_chunks_mut(width as usize).enumerate().for_each(|(row, pixels)| {
            pixels.iter_mut().enumerate().for_each(|(column, pixel)| *pixel = color(column, row));
        });
        crate::image::RgbImage { width, height, rgb }
    }
}
