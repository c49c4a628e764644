//! Pictures that others are measured by.

use super::{Engine, Shot};
use crate::failure::Failure;
use wheatstone_core::image::RgbImage;
use wheatstone_core::view::View;

/// Rays through each pixel of the truth, along each of its sides: pixels are areas, not points.
const RAYS: u32 = 2;

impl Engine<'_> {
    /// The picture of a view before black, and how many samples it took.
    pub(crate) fn pictured(&mut self, shot: Shot, view: &View) -> Result<(RgbImage, u64), Failure> {
        self.cast(shot, &[*view])?;
        let cast = self.read()?.swap_remove(0);
        Ok((cast.image.over_background([0.0; 3]), cast.samples))
    }

    fn over_black(&mut self, shot: Shot, view: &View) -> Result<RgbImage, Failure> {
        Ok(self.pictured(shot, view)?.0)
    }

    /// The mean of the pictures of views of one size, before black.
    pub(crate) fn mean(
        &mut self,
        shot: Shot,
        views: impl Iterator<Item = View>,
    ) -> Result<RgbImage, Failure> {
        let pictures = views.map(|view| self.over_black(shot, &view)).collect::<Result<Vec<_>, _>>()?;
        Ok(RgbImage::mean(&pictures))
    }

    /// What there is to see in a view, before black: means of several rays through each pixel.
    pub(crate) fn truth(&mut self, shot: Shot, view: &View) -> Result<RgbImage, Failure> {
        let finer = View { size: view.size.map(|side| side * RAYS), ..*view };
        Ok(self.over_black(shot, &finer)?.averaged(RAYS))
    }
}
