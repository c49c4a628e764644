//! Measurements of a display, and the description that agrees with them best.

use super::fit::{Correspondence, Fit, FitError};
use super::ids::{IdError, place_of};
use crate::lightfield::projectors::{Description, ProjectorArray};
use crate::lightfield::{DisplayError, error};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Where beams of a display's projectors pass, as measured: `docs/displays.md` has an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measurements {
    /// Version of the form: 1.
    pub wheatstone_measurements: u64,
    /// Of each projector that was measured; the others are as the display describes them.
    pub projectors: Vec<MeasuredProjector>,
}

/// The beams of one projector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredProjector {
    /// By which the display knows it.
    pub id: u32,
    /// Pixels, and places that their beams pass.
    pub correspondences: Vec<MeasuredBeam>,
}

/// A [`Correspondence`] as it is written.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredBeam {
    /// Position in the projector's image, pixels from the top left; the first pixel's middle is at ½.
    pub pixel: [f64; 2],
    /// Place in display space, metres.
    pub place_m: [f64; 3],
}

/// A display as fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibrated {
    /// The display, with the projectors that were measured as they were found.
    pub array: ProjectorArray,
    /// What was found, in the order of the measurements.
    pub fits: Vec<Fit>,
}

/// Why measurements make no display.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CalibrationError {
    /// What is no text of measurements, or a display that is none.
    #[error(transparent)]
    Display(#[from] DisplayError),
    /// An entry that is of no projector of the display, or of one that another is of.
    #[error(transparent)]
    Id(#[from] IdError),
    /// Measurements that no projector agrees with.
    #[error("projector {id}: {source}")]
    Fit {
        /// Of which projector.
        id: u32,
        /// Why.
        source: FitError,
    },
}

/// The version that is read.
const VERSION: u64 = 1;

impl Measurements {
    /// Reads measurements from JSON.
    ///
    /// # Errors
    /// What is no JSON, lacks a field or has an unknown one, or is of another version.
    pub fn from_json(text: &str) -> Result<Self, DisplayError> {
        let measurements: Self = error::from_object(text)?;
        error::check_version(measurements.wheatstone_measurements, VERSION)?;
        Ok(measurements)
    }

    /// Fits the projectors of a display to what was measured of them, from what its description says.
    ///
    /// # Errors
    /// Ids that the display does not have or that repeat, too few or degenerate correspondences, fits that are no display.
    pub fn fit(&self, display: &ProjectorArray) -> Result<Calibrated, CalibrationError> {
        let description = display.description();
        let mut projectors = description.projectors.clone();
        let mut fits = Vec::new();
        for (index, measured) in self.projectors.iter().enumerate() {
            let described = &mut projectors[place_of(|index| self.projectors[index].id, index, display)?];
            let beams: Vec<Correspondence> = measured.correspondences.iter().map(Into::into).collect();
            let fit = Fit::of(described, description.image_size_px, &beams)
                .map_err(|source| CalibrationError::Fit { id: measured.id, source })?;
            *described = fit.projector;
            fits.push(fit);
        }
        let array = ProjectorArray::new(Description { projectors, ..description.clone() })?;
        Ok(Calibrated { array, fits })
    }
}

impl From<&MeasuredBeam> for Correspondence {
    fn from(beam: &MeasuredBeam) -> Self {
        Self { pixel: DVec2::from(beam.pixel), place_m: DVec3::from(beam.place_m) }
    }
}
