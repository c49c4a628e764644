//! What is corrected of each projector's picture after it was rendered.

use super::ids::{IdError, place_of};
use super::{ColorTable, GeometryWarp, NotATable, NotAWarp};
use crate::image::RgbImage;
use crate::lightfield::projectors::ProjectorArray;
use crate::lightfield::{DisplayError, error};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Warps and colour tables of a display's projectors (LF §5, the second pass): `docs/displays.md` has an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Corrections {
    /// Version of the form: 1.
    pub wheatstone_corrections: u64,
    /// Of each projector that needs some; the others' pictures are left alone.
    pub projectors: Vec<Correction>,
}

/// What is corrected of one projector's picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correction {
    /// By which the display knows it.
    pub id: u32,
    /// Where its image looks in the ideal picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub warp: Option<GeometryWarp>,
    /// What it is sent for the colours that are to be seen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colors: Option<ColorTable>,
}

/// Why a text tells no corrections of a display.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CorrectionError {
    /// Not JSON, a field missing or unknown, another version.
    #[error(transparent)]
    Form(#[from] DisplayError),
    /// An entry that is of no projector of the display, or of one that another is of.
    #[error(transparent)]
    Id(#[from] IdError),
    /// A warp that is none.
    #[error("projectors[{index}].warp: {source}")]
    Warp {
        /// Counted from 0.
        index: usize,
        /// Why.
        source: NotAWarp,
    },
    /// A colour table that is none.
    #[error("projectors[{index}].colors: {source}")]
    Colors {
        /// Counted from 0.
        index: usize,
        /// Why.
        source: NotATable,
    },
}

/// The version that is read.
const VERSION: u64 = 1;

impl Corrections {
    /// Reads the corrections of a display from JSON.
    ///
    /// # Errors
    /// What is no JSON, lacks a field or has an unknown one, is of another version, has ids that the display does not have or that
    /// repeat, or warps or tables that are none.
    pub fn from_json(text: &str, display: &ProjectorArray) -> Result<Self, CorrectionError> {
        let corrections: Self = error::from_object(text)?;
        error::check_version(corrections.wheatstone_corrections, VERSION)?;
        for (index, correction) in corrections.projectors.iter().enumerate() {
            correction.check(index)?;
            place_of(|index| corrections.projectors[index].id, index, display)?;
        }
        Ok(corrections)
    }

    /// What the projector of an id is sent for an ideal picture of its size.
    pub fn apply(&self, id: u32, ideal: RgbImage) -> RgbImage {
        let Some(correction) = self.projectors.iter().find(|correction| correction.id == id) else {
            return ideal;
        };
        let warped = match &correction.warp {
            Some(warp) => warp.apply(&ideal),
            None => ideal,
        };
        match &correction.colors {
            Some(colors) => colors.apply(&warped),
            None => warped,
        }
    }
}

impl Correction {
    fn check(&self, index: usize) -> Result<(), CorrectionError> {
        let warp = self.warp.clone().map(GeometryWarp::checked).transpose();
        warp.map_err(|source| CorrectionError::Warp { index, source })?;
        let colors = self.colors.clone().map(ColorTable::checked).transpose();
        colors.map_err(|source| CorrectionError::Colors { index, source })?;
        Ok(())
    }
}
