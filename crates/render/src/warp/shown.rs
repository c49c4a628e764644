//! The picture that is warped.

use crate::renderer::Prepared;
use crate::target::Target;
use std::ops::Range;
use wheatstone_core::view::{PixelRect, View};
use wheatstone_core::warp::{PixelMap, Reach, WarpError};

/// A whole picture, the view that it was cast from, and how near what it shows may be.
#[derive(Debug, Clone, Copy)]
pub struct Shown<'a> {
    pub(super) target: &'a Target,
    pub(super) view: View,
    pub(super) reach: Reach,
}

impl<'a> Shown<'a> {
    /// A picture that was cast from a view with some settings.
    pub fn new(target: &'a Target, view: View, prepared: &Prepared) -> Self {
        Self { target, view, reach: Reach::of(&view, &prepared.occupied_corners_world()) }
    }

    /// The wanted pixels that may show something of the picture between two inverse depths, 1/m.
    ///
    /// # Errors
    /// Views that do not go together, or with the picture.
    pub(super) fn covered(&self, wanted: &View, inverse_depths: Range<f64>) -> Result<PixelRect, WarpError> {
        WarpError::unless_of_size(self.target.size(), &self.view)?;
        let wanted_from_shown = PixelMap::between(&self.view, wanted)?;
        Ok(wanted_from_shown.covered(&self.target.drawn_pixels(), inverse_depths, wanted.size))
    }

    /// The wanted pixels that may show something of what is in the volume.
    ///
    /// # Errors
    /// As [`Shown::covered`].
    pub(crate) fn covered_by_volume(&self, wanted: &View) -> Result<PixelRect, WarpError> {
        self.covered(wanted, self.reach.furthest..self.reach.nearest)
    }
}
