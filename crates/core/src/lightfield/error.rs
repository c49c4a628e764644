//! Why a description is no display.

use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use thiserror::Error;

/// What is wrong with the description of a display.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum DisplayError {
    /// Not JSON, or a field missing, unknown or of another type.
    #[error("{reason} (line {line}, column {column})")]
    Syntax {
        /// What was expected.
        reason: String,
        /// Counted from 1.
        line: usize,
        /// Counted from 1.
        column: usize,
    },
    /// A form that this program does not know.
    #[error("version {found} of the description; this program reads version {expected}")]
    Version {
        /// Version of the description.
        found: u64,
        /// Version that is read.
        expected: u64,
    },
    /// A number out of its bounds.
    #[error("{field} is {}: must be {expected}", written(*value))]
    Number {
        /// Which field, with its place in lists.
        field: String,
        /// As it is.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// Lenses that are too few on a panel to show directions by, or narrower than what they are to show.
    #[error(
        "pitch is {}, with slope {} and DPI {}: {} lenses lie across the panel, must be from 10 to {most}, one for each sub-pixel",
        written(*pitch_per_inch), written(*slope), written(*dots_per_inch), written(*lenses)
    )]
    LensCount {
        /// Lenses per inch.
        pitch_per_inch: f64,
        /// Height over width of their slant.
        slope: f64,
        /// Pixels per inch.
        dots_per_inch: f64,
        /// Lenses across the panel.
        lenses: f64,
        /// Sub-pixels across the panel.
        most: u32,
    },
    /// A field that is needed and not there.
    #[error("{field} is missing: must be a number")]
    Missing {
        /// Which field.
        field: &'static str,
    },
    /// Something else where a number must be.
    #[error("{field} is {found}: must be a number")]
    NotANumber {
        /// Which field.
        field: String,
        /// What is there.
        found: String,
    },
    /// Something else where a list must be.
    #[error("{field} is {found}: must be a list")]
    NotAList {
        /// Which field.
        field: &'static str,
        /// What is there.
        found: String,
    },
    /// A list with too few or too many entries.
    #[error("{field} has {count} entries: must have {expected}")]
    Count {
        /// Which list.
        field: &'static str,
        /// Entries that it has.
        count: usize,
        /// How many it must have.
        expected: &'static str,
    },
    /// Two projectors with one id.
    #[error("projectors[{second}].id is {id}, as of projectors[{first}]: ids must differ")]
    RepeatedId {
        /// The id.
        id: u32,
        /// Which projector has it first.
        first: usize,
        /// Which has it again.
        second: usize,
    },
    /// A frame in which there is no room for one image below the header.
    #[error(
        "packing.frame_size_px is {}x{} with {header_rows} header rows: there is no room for an image of {}x{}",
        frame[0], frame[1], image[0], image[1]
    )]
    FrameTooSmall {
        /// Width and height of a frame, pixels.
        frame: [u32; 2],
        /// Rows of the header.
        header_rows: u32,
        /// Width and height of an image, pixels.
        image: [u32; 2],
    },
    /// A header that cannot tell whose all the images of a frame are.
    #[error(
        "packing.frame_size_px[0] is {columns}: must be at least {places}, a column of the header for each image that a frame has room for"
    )]
    HeaderTooNarrow {
        /// Width of a frame, pixels.
        columns: u32,
        /// Images that a frame has room for.
        places: u64,
    },
    /// A description of neither kind of display.
    #[error(
        "neither wheatstone_projector_array is in it, as in the description of a display of projectors, nor columns, as in that of a display \
        behind lenses"
    )]
    UnknownKind,
    /// More pixels than are handled.
    #[error("{field}: {count} in all, must be at most {most}")]
    TooManyPixels {
        /// Which pixels.
        field: &'static str,
        /// How many there are.
        count: u64,
        /// How many there may be.
        most: u64,
    },
}

impl From<serde_json::Error> for DisplayError {
    fn from(error: serde_json::Error) -> Self {
        let text = error.to_string();
        let reason = text.split(" at line ").next().unwrap_or(&text).to_owned();
        Self::Syntax { reason, line: error.line(), column: error.column() }
    }
}

/// A number as errors tell it: one that is huge or tiny in scientific form, instead of by hundreds of digits.
pub(super) fn written(value: f64) -> String {
    let is_short = value == 0.0 || !value.is_finite() || (1e-6..1e12).contains(&value.abs());
    if is_short { value.to_string() } else { format!("{value:e}") }
}

/// What the object of a text in JSON tells. Lists of the values alone are refused.
pub(super) fn from_object<T: DeserializeOwned>(text: &str) -> Result<T, DisplayError> {
    serde_json::from_str::<Map<String, Value>>(text)?;
    Ok(serde_json::from_str(text)?)
}

/// A number that keeps a rule.
pub(super) fn check(
    is_kept: bool,
    field: impl Into<String>,
    value: f64,
    expected: &'static str,
) -> Result<(), DisplayError> {
    if is_kept && value.is_finite() {
        return Ok(());
    }
    Err(DisplayError::Number { field: field.into(), value, expected })
}

/// The version of a form.
pub(super) fn check_version(found: u64, expected: u64) -> Result<(), DisplayError> {
    if found == expected { Ok(()) } else { Err(DisplayError::Version { found, expected }) }
}

/// A length that is above zero and of a size that displays have.
pub(super) fn check_length_m(field: impl Into<String>, value: f64) -> Result<(), DisplayError> {
    check(value > 0.0 && value <= LONGEST_M, field, value, "above 0 and at most 1000 m")
}

/// A coordinate about a display.
pub(super) fn check_place_m(field: impl Into<String>, value: f64) -> Result<(), DisplayError> {
    check(value.abs() <= LONGEST_M, field, value, "from -1000 to 1000 m")
}

/// Longest distance of anything from a display, metres.
pub(super) const LONGEST_M: f64 = 1000.0;

/// Most pixels along a side of any picture of a display.
pub const LONGEST_SIDE_PX: u32 = 32_768;

/// Most pixels of a picture, or of all that a display needs at once: as floats they take 1.6 GB.
pub const MOST_PIXELS: u64 = 1 << 27;

/// The sides of a picture, and how many pixels it has.
pub(super) fn check_size_px(field: &'static str, size: [u32; 2]) -> Result<(), DisplayError> {
    for (axis, side) in size.into_iter().enumerate() {
        let is_kept = (1..=LONGEST_SIDE_PX).contains(&side);
        check(is_kept, format!("{field}[{axis}]"), f64::from(side), "from 1 to 32768 pixels")?;
    }
    check_pixels(field, size, 1)
}

/// How many pixels so many pictures of a size have.
pub(super) fn check_pixels(field: &'static str, size: [u32; 2], pictures: usize) -> Result<(), DisplayError> {
    let [width, height] = size.map(u64::from);
    let count = width * height * pictures as u64;
    if count <= MOST_PIXELS {
        Ok(())
    } else {
        Err(DisplayError::TooManyPixels { field, count, most: MOST_PIXELS })
    }
}
