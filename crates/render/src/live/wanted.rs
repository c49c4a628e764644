//! What is to be seen.

use super::LiveError;
use crate::renderer::Prepared;
use crate::target::check_size;
use glam::DQuat;
use std::sync::Arc;
use wheatstone_core::budget::Quality;
use wheatstone_core::view::{PixelRect, View};

/// Way of an eye after which a picture tells little about what the next one takes, metres.
const FAR_M: f64 = 0.25;

/// Cosine of half of a turn after which it tells little: 20°.
const FAR_HALF_TURN_COS: f64 = 0.985;

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

    /// Whether some eye is so far from where it was, or looks elsewhere, that other parts of the volume may be seen.
    pub(super) fn is_far_from(&self, other: &Self) -> bool {
        let is_far = |(a, b): (&View, &View)| {
            let [a, b] = [a, b].map(|view| view.view_from_world.inverse());
            let turn = DQuat::from_mat3(&(a.matrix3 * b.matrix3.transpose()));
            a.translation.distance(b.translation) > FAR_M || turn.w.abs() < FAR_HALF_TURN_COS
        };
        self.eyes() != other.eyes() || self.views.iter().zip(&other.views).any(is_far)
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

    /// Samples of a pixel, as far as they depend on quality and settings.
    pub(super) fn work_per_pixel(&self) -> f64 {
        self.quality.work_per_pixel() * f64::from(self.settings.parameters.sampling_factor)
    }

    /// Samples of a view of a full size, likewise.
    pub(super) fn work(&self) -> f64 {
        self.quality.resolution().powi(2) * self.work_per_pixel()
    }

    /// Pixels of all views at full quality.
    pub(super) fn full_px(&self) -> u64 {
        self.views.iter().map(|view| view.size.map(u64::from).iter().product::<u64>()).sum()
    }

    pub(super) fn eyes(&self) -> usize {
        self.views.len()
    }

    /// Pixels of all views in which something may be seen.
    pub(super) fn covered_px(&self) -> f64 {
        let corners = self.settings.occupied_corners_world();
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
