//! Displays of many projectors behind a screen that transmits light sharply to the sides and scatters it up and down (LF §3, §4).

mod description;
mod packing;
mod paper;
mod projector;

pub use description::Description;
pub use packing::{Packing, PackingError};
pub use projector::{ImageRect, Projector, VirtualViewer};

use super::{DisplayError, Resolution};
use crate::view::{Projection, View};
use glam::DAffine3;

/// A checked [`Description`] of a display.
#[derive(Debug, Clone, PartialEq)]
pub struct ProjectorArray {
    description: Description,
}

impl ProjectorArray {
    /// A display as described.
    ///
    /// # Errors
    /// Numbers that are not finite or out of their bounds, emitters that are not behind the screen, images without area, ids that
    /// repeat, frames too small for an image: the first such fault, with the name of its field.
    pub fn new(description: Description) -> Result<Self, DisplayError> {
        description.check()?;
        Ok(Self { description })
    }

    /// Reads a description from JSON.
    ///
    /// # Errors
    /// What is no JSON, lacks a field or has an unknown one, is of another version, or as of [`ProjectorArray::new`].
    pub fn from_json(text: &str) -> Result<Self, DisplayError> {
        Self::new(Description::parse(text)?)
    }

    /// The description as JSON.
    pub fn to_json(&self) -> String {
        self.description.to_json()
    }

    /// What the display is like.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The projectors, virtual ones with them.
    pub fn projectors(&self) -> &[Projector] {
        &self.description.projectors
    }

    /// What each projector is to show of a world in which the display stands, in order.
    pub fn views(&self, display_from_world: DAffine3) -> Vec<View> {
        let Description { viewer, image_size_px, .. } = self.description;
        let view = |projector: &Projector| View {
            view_from_world: display_from_world,
            projection: Projection::Mcop(projector.mcop(viewer)),
            size: image_size_px,
            shaded_from: None,
        };
        self.projectors().iter().map(view).collect()
    }

    /// What the display can resolve.
    pub fn resolution(&self) -> Resolution {
        Resolution {
            pixel_size_m: self.description.pixel_size_m,
            beam_angle_rad: self.description.beam_angle_deg.to_radians(),
        }
    }
}
