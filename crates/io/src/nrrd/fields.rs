//! The header: fields, key/value pairs and comments, and the geometry that they describe.

use super::{MAGIC, layout::Axes};
use crate::{
    ReadError, Warning, geometry,
    stream::{MAX_HEADER_BYTES, Stream},
    text_header,
    warning::RAS_AXES,
};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;

const VECTORS: &str = "for each axis `none` or a vector such as (1,0,0) of the space's dimension";

/// Field names in lower case with what they hold.
#[derive(Debug)]
pub(super) struct Fields(HashMap<String, String>);

impl Fields {
    /// Reads up to the empty line before the voxels, or to the end of a detached header.
    pub(super) fn read(stream: &mut Stream<'_>) -> Result<Self, ReadError> {
        let mut budget_bytes = MAX_HEADER_BYTES;
        let magic = stream.peek(MAGIC.len() + 1)?;
        if !magic.starts_with(MAGIC.as_bytes()) || !magic.last().is_some_and(u8::is_ascii_digit) {
            return Err(ReadError::WrongMagic {
                found: magic.escape_ascii().to_string(),
                expected: "NRRD0001 to NRRD0006",
            });
        }
        stream.header_line(&mut budget_bytes)?;
        let mut fields = HashMap::new();
        let mut number = 1;
        while let Some(line) = stream.header_line(&mut budget_bytes)? {
            number += 1;
            if line.is_empty() {
                break;
            }
            if line.starts_with('#') {
                continue;
            }
            let bad_line = || ReadError::BadLine {
                line: number,
                text: crate::error::shorten(&line),
                expected: "`field: value`, `key:=value`, a comment after # or an empty line before the voxels",
            };
            let (name, value) = line.split_once(':').ok_or_else(bad_line)?;
            if value.starts_with('=') {
                continue;
            }
            let name = match name.trim().to_ascii_lowercase().as_str() {
                "datafile" => "data file".to_owned(),
                "lineskip" => "line skip".to_owned(),
                "byteskip" => "byte skip".to_owned(),
                other => other.to_owned(),
            };
            fields.insert(name, value.trim().to_owned());
        }
        Ok(Self(fields))
    }

    pub(super) fn optional(&self, name: &str) -> Option<&str> {
        self.0.get(name).map(String::as_str)
    }

    pub(super) fn required(&self, name: &'static str) -> Result<&str, ReadError> {
        self.optional(name)
            .ok_or(ReadError::MissingField { field: name, expected: "it in every NRRD header" })
    }

    /// The vector of each axis of the file, `None` for axes outside space.
    pub(super) fn directions(&self, axis_count: usize) -> Result<Option<Vec<Option<DVec3>>>, ReadError> {
        let field = "space directions";
        let Some(text) = self.optional(field) else { return Ok(None) };
        let space_dimension = self.space_dimension()?;
        let bad = || ReadError::bad_field(field, text, VECTORS);
        let mut directions = Vec::new();
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            let (direction, after) = if let Some(after) = rest.strip_prefix("none") {
                (None, after)
            } else {
                let (vector, after) = split_vector(rest).ok_or_else(bad)?;
                (Some(parse_vector(field, vector, space_dimension)?), after)
            };
            directions.push(direction);
            rest = after.trim_start();
        }
        if directions.len() == axis_count { Ok(Some(directions)) } else { Err(bad()) }
    }

    /// The matrix in RAS+ mm and the field that it comes from.
    pub(super) fn patient_from_index(
        &self,
        axes: &Axes,
        warnings: &mut Vec<Warning>,
    ) -> Result<(DAffine3, &'static str), ReadError> {
        let Some(directions) = &axes.directions else {
            return self.matrix_of_spacings(axes, warnings);
        };
        let flip = self.flip_to_ras(warnings)?;
        let x_axis = directions.first().copied().unwrap_or(DVec3::X);
        let y_axis = directions.get(1).copied().unwrap_or_else(|| geometry::perpendicular_mm(x_axis));
        let z_axis = directions.get(2).copied().unwrap_or_else(|| geometry::normal_mm(x_axis, y_axis));
        let origin = match self.optional("space origin") {
            None => DVec3::ZERO,
            Some(text) => {
                let field = "space origin";
                let (vector, _) =
                    split_vector(text).ok_or_else(|| ReadError::bad_field(field, text, VECTORS))?;
                let origin = parse_vector(field, vector, self.space_dimension()?)?;
                if !origin.is_finite() {
                    return Err(ReadError::NotFinite { field });
                }
                origin
            }
        };
        let matrix = DAffine3::from_mat3_translation(DMat3::from_cols(x_axis, y_axis, z_axis), origin);
        let matrix = geometry::flipped(self.mm_per_space_unit() * flip, matrix);
        Ok((matrix, "space directions"))
    }

    fn matrix_of_spacings(
        &self,
        axes: &Axes,
        warnings: &mut Vec<Warning>,
    ) -> Result<(DAffine3, &'static str), ReadError> {
        let field = "spacings";
        warnings.push(Warning::OrientationUnknown { axes: RAS_AXES });
        let units = self.optional("units").map(quoted).unwrap_or_default();
        let mut spacing_mm = DVec3::ONE;
        if let Some(text) = self.optional(field) {
            let all: Vec<f64> = text_header::numbers(field, text, axes.count(), "one number for each axis")?;
            for (i, &axis) in axes.spatial.iter().take(3).enumerate() {
                spacing_mm[i] = if all[axis].is_nan() || all[axis] == 0.0 {
                    warnings.push(Warning::SpacingAssumed { axis: axis + 1 });
                    1.0
                } else {
                    all[axis] * units.get(axis).map_or(1.0, |unit| geometry::mm_per_unit(unit))
                };
            }
        }
        Ok((geometry::diagonal(spacing_mm), field))
    }

    fn space_dimension(&self) -> Result<usize, ReadError> {
        if let Some(space) = self.optional("space") {
            let is_4d = space.ends_with("-time") || matches!(space.trim(), "RAST" | "LAST" | "LPST");
            return Ok(if is_4d { 4 } else { 3 });
        }
        let expected = "1, 2, 3 or 4";
        let text = self.optional("space dimension").ok_or(ReadError::MissingField {
            field: "space",
            expected: "it, or `space dimension`, along with `space directions`",
        })?;
        match text_header::number("space dimension", text, expected)? {
            dimension @ 1..=4 => Ok(dimension),
            _ => Err(ReadError::bad_field("space dimension", text, expected)),
        }
    }

    fn flip_to_ras(&self, warnings: &mut Vec<Warning>) -> Result<DVec3, ReadError> {
        let Some(space) = self.optional("space") else {
            warnings.push(Warning::OrientationUnknown { axes: RAS_AXES });
            return Ok(DVec3::ONE);
        };
        let name = space.trim().to_ascii_lowercase();
        match name.strip_suffix("-time").unwrap_or(&name) {
            "right-anterior-superior" | "ras" | "rast" | "scanner-xyz" => Ok(DVec3::ONE),
            "left-anterior-superior" | "las" | "last" => Ok(DVec3::new(-1.0, 1.0, 1.0)),
            "left-posterior-superior" | "lps" | "lpst" => Ok(geometry::RAS_FROM_LPS),
            "3d-right-handed" | "3d-left-handed" => {
                warnings.push(Warning::SpaceAssumedRas { space: name });
                Ok(DVec3::ONE)
            }
            _ => Err(ReadError::bad_field(
                "space",
                space,
                "right-anterior-superior, left-anterior-superior, left-posterior-superior, scanner-xyz, \
                 3D-right-handed or 3D-left-handed, also with -time",
            )),
        }
    }

    fn mm_per_space_unit(&self) -> DVec3 {
        let units = self.optional("space units").map(quoted).unwrap_or_default();
        let mm = |axis: usize| units.get(axis).map_or(1.0, |unit| geometry::mm_per_unit(unit));
        DVec3::new(mm(0), mm(1), mm(2))
    }
}

/// The inside of the parentheses that a text starts with, and what follows them.
fn split_vector(text: &str) -> Option<(&str, &str)> {
    text.trim_start().strip_prefix('(')?.split_once(')')
}

fn parse_vector(field: &'static str, inside: &str, dimension: usize) -> Result<DVec3, ReadError> {
    let bad = || ReadError::bad_field(field, inside, VECTORS);
    let numbers: Vec<f64> =
        inside.split(',').map(|number| number.trim().parse().map_err(|_| bad())).collect::<Result<_, _>>()?;
    if numbers.len() != dimension {
        return Err(bad());
    }
    let at = |axis: usize| numbers.get(axis).copied().unwrap_or(0.0);
    Ok(DVec3::new(at(0), at(1), at(2)))
}

/// The texts between double quotes.
fn quoted(text: &str) -> Vec<&str> {
    text.split('"').skip(1).step_by(2).collect()
}
