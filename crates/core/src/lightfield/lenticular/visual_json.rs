//! The file in which a display keeps its calibration.

use super::{CellPattern, DisplayError, Lenticular, SubpixelCell};
use serde_json::Value;

/// Angle of the view cone where a file tells none, degrees: that of the maker's older displays.
const USUAL_CONE_DEG: f64 = 40.0;

impl Lenticular {
    /// Reads a `visual.json`: numbers as such or as `{"value": …}`. `pitch`, `slope`, `center`, `DPI`, `screenW` and `screenH` are
    /// needed; `viewCone`, `invView`, `flipImageX`, `flipImageY`, `flipSubp`, `CellPatternMode` (or `cellPatternMode`) and
    /// `subpixelCells` have defaults; whatever else is in it is for others.
    ///
    /// # Errors
    /// What is no JSON, lacks a number that is needed, has something else in its place, or as of [`Lenticular::checked`].
    pub fn from_visual_json(text: &str) -> Result<Self, DisplayError> {
        let file: Value = serde_json::from_str(text)?;
        let needed = |name: &'static str| number(&file, name)?.ok_or(DisplayError::Missing { field: name });
        let or =
            |name: &'static str, usual: f64| Ok::<f64, DisplayError>(number(&file, name)?.unwrap_or(usual));
        let is_set = |name: &'static str, usual: f64| Ok::<bool, DisplayError>(or(name, usual)? >= 0.5);
        Self {
            pitch_per_inch: needed("pitch")?,
            slope: needed("slope")?,
            center: needed("center")?,
            view_cone_deg: or("viewCone", USUAL_CONE_DEG)?,
            views_run_left: is_set("invView", 1.0)?,
            dots_per_inch: needed("DPI")?,
            panel_px: [whole("screenW", needed("screenW")?)?, whole("screenH", needed("screenH")?)?],
            flips_x: is_set("flipImageX", 0.0)?,
            flips_y: is_set("flipImageY", 0.0)?,
            flips_subpixels: is_set("flipSubp", 0.0)?,
            cell_pattern: cell_pattern(or("CellPatternMode", or("cellPatternMode", 0.0)?)?)?,
            cells: cells(&file)?,
        }
        .checked()
    }
}

/// A number of an object, if it is there.
fn number(object: &Value, name: &str) -> Result<Option<f64>, DisplayError> {
    let Some(entry) = object.get(name) else { return Ok(None) };
    let value = if entry.is_object() { entry.get("value").unwrap_or(&Value::Null) } else { entry };
    let found = || DisplayError::NotANumber { field: name.to_owned(), found: value.to_string() };
    value.as_f64().map(Some).ok_or_else(found)
}

fn whole(field: &str, value: f64) -> Result<u32, DisplayError> {
    let is_whole = value.fract() == 0.0 && (1.0..=f64::from(u32::MAX)).contains(&value);
    super::check(is_whole, field, value, "a whole number of pixels")?;
    Ok(value as u32)
}

fn cell_pattern(mode: f64) -> Result<CellPattern, DisplayError> {
    use CellPattern::{Checkered, Columns, One, Quadruple, Rows};
    let pattern = [One, Checkered, Columns, Quadruple, Rows].into_iter().zip(0_u32..);
    let found = pattern.into_iter().find(|&(_, number)| f64::from(number) == mode);
    let expected = || DisplayError::Number {
        field: "CellPatternMode".to_owned(),
        value: mode,
        expected: "0, 1, 2, 3 or 4",
    };
    found.map(|(pattern, _)| pattern).ok_or_else(expected)
}

fn cells(file: &Value) -> Result<Vec<SubpixelCell>, DisplayError> {
    let list = match file.get("subpixelCells") {
        None | Some(Value::Null) => return Ok(Vec::new()),
        Some(Value::Array(list)) => list,
        Some(other) => {
            return Err(DisplayError::NotAList { field: "subpixelCells", found: other.to_string() });
        }
    };
    let cell = |cell: &Value| {
        let offset = |name: &'static str| number(cell, name)?.ok_or(DisplayError::Missing { field: name });
        Ok(SubpixelCell {
            offsets_px: [
                [offset("ROffsetX")?, offset("ROffsetY")?],
                [offset("GOffsetX")?, offset("GOffsetY")?],
                [offset("BOffsetX")?, offset("BOffsetY")?],
            ],
        })
    };
    list.iter().map(cell).collect()
}
