//! What is to be seen.

use super::LiveError;
use crate::renderer::Prepared;
use crate::target::check_size;
use std::sync::Arc;
use wheatstone_core::budget::Quality;
use wheatstone_core::view::{PixelRect, View};

/// All that tells one picture from another: the views of a rig, the settings with their volume, and how coarse it is.
#[derive(Debug, Clone)]
pub(super) struct Wanted {
    /// At least one, all of the same size: that of full quality.
    views: Vec<View>,
    pub(super) settings: Arc<Prepared>,
    pub(super) quality: Quality,
}

impl PartialEq for Wanted {
    fn eq(&self, other: &Self) -> bool {
        self.is_of_same(other) && self.quality == other.quality
    }
}

impl Wanted {
    /// Views at full quality.
    ///
    /// # Errors
    /// No views, different sizes, or one that a device that takes such sides cannot hold.
    pub(super) fn new(views: &[View], settings: Arc<Prepared>, largest_side: u32) -> Result<Self, LiveError> {
        let sizes = || views.iter().map(|view| view.size);
        match views.first() {
            Some(first) if sizes().all(|size| size == first.size) => check_size(first.size, largest_side)?,
            _ => return Err(LiveError::Views(sizes().collect())),
        }
        Ok(Self { views: views.to_vec(), settings, quality: Quality::FULL })
    }

    /// Whether both show the same, be it more or less coarsely.
    pub(super) fn is_of_same(&self, other: &Self) -> bool {
        self.views == other.views && Arc::ptr_eq(&self.settings, &other.settings)
    }

    pub(super) fn with_quality(&self, quality: Quality) -> Self {
        Self { quality, ..self.clone() }
    }

    pub(super) fn with_settings(&self, settings: Arc<Prepared>) -> Self {
        Self { settings, ..self.clone() }
    }

    /// Width and height of each view in pixels, at its quality.
    pub(super) fn size(&self) -> [u32; 2] {
        self.quality.size(self.views[0].size)
    }

    pub(super) fn eyes(&self) -> usize {
        self.views.len()
    }

    /// Pixels of all views in which something may be seen.
    pub(super) fn covered_px(&self) -> f64 {
        let corners = self.settings.parameters.occupied_corners_world();
        let covered = |view: View| {
            let covered = PixelRect::around(&view, corners);
            (covered.columns.len() * covered.rows.len()) as f64
        };
        self.cast_views().map(covered).sum()
    }

    /// The views as they are cast.
    pub(super) fn cast_views(&self) -> impl Iterator<Item = View> {
        self.views.iter().map(|view| View { size: self.size(), ..*view })
    }
}
