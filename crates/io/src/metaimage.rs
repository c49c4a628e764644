//! MetaImage (<https://itk.org/Wiki/ITK/MetaIO/Documentation>).
//!
//! Rows of `TransformMatrix` are the directions of the index axes, and positions are LPS, as ITK reads them.

use crate::{
    Format, Loaded, ReadError, Warning, geometry,
    siblings::Siblings,
    stream::{Compression, MAX_HEADER_BYTES, Stream},
    text_header,
    voxel_data::{self, Layout, Scalar},
    warning::LPS_AXES,
};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::HashMap;
use wheatstone_core::volume::{VoxelType, Voxels};

const FIRST_KEYS: [&str; 8] = [
    "ObjectType",
    "ObjectSubType",
    "NDims",
    "Comment",
    "DimSize",
    "ElementType",
    "TransformType",
    "BinaryData",
];

/// Whether a file starts as MetaImage files do, which have no signature: with `Key = value` of a key known to come first.
pub(crate) fn is_magic(start: &[u8]) -> bool {
    first_key(start).is_some_and(|key| FIRST_KEYS.iter().any(|first| first.as_bytes() == key))
}

/// The key of the first line, if that is `Key = value`.
fn first_key(start: &[u8]) -> Option<&[u8]> {
    let line = start.split(|&byte| byte == b'\n').next()?;
    let equals = line.iter().position(|&byte| byte == b'=')?;
    let key = line[..equals].trim_ascii();
    key.iter().all(u8::is_ascii_alphanumeric).then_some(key)
}

/// Keys in lower case with their values.
#[derive(Debug)]
struct Fields(HashMap<String, String>);

impl Fields {
    /// Reads up to `ElementDataFile`, which ends the header.
    fn read(stream: &mut Stream<'_>) -> Result<Self, ReadError> {
        const LINE: &str = "`Key = value` up to `ElementDataFile = …`";
        let mut budget_bytes = MAX_HEADER_BYTES;
        let mut fields = HashMap::new();
        let mut number = 0;
        while let Some(line) = stream.header_line(&mut budget_bytes)? {
            number += 1;
            if line.trim().is_empty() {
                continue;
            }
            let bad_line =
                || ReadError::BadLine { line: number, text: crate::error::shorten(&line), expected: LINE };
            let (key, value) = line.split_once('=').ok_or_else(bad_line)?;
            let key = key.trim().to_ascii_lowercase();
            let is_last = key == "elementdatafile";
            fields.insert(key, value.trim().to_owned());
            if is_last {
                return Ok(Self(fields));
            }
        }
        Err(ReadError::MissingField {
            field: "ElementDataFile",
            expected: "it as the last line of the header",
        })
    }

    fn optional(&self, key: &str) -> Option<&str> {
        self.0.get(&key.to_ascii_lowercase()).map(String::as_str)
    }

    /// The first of several names for the same thing.
    fn any(&self, keys: &[&'static str]) -> Option<(&'static str, &str)> {
        keys.iter().find_map(|key| self.optional(key).map(|value| (*key, value)))
    }

    fn required(&self, key: &'static str) -> Result<&str, ReadError> {
        self.optional(key)
            .ok_or(ReadError::MissingField { field: key, expected: "it in every MetaImage header" })
    }

    fn flag(&self, keys: &[&'static str], default: bool) -> Result<bool, ReadError> {
        let Some((key, value)) = self.any(keys) else { return Ok(default) };
        match value.to_ascii_lowercase().as_str() {
            "true" | "t" | "1" => Ok(true),
            "false" | "f" | "0" => Ok(false),
            _ => Err(ReadError::bad_field(key, value, "True or False")),
        }
    }

    /// Numbers for each axis, the first three of them; missing axes get `default`.
    fn vector(
        &self,
        keys: &[&'static str],
        axis_count: usize,
        default: f64,
    ) -> Result<Option<(&'static str, DVec3)>, ReadError> {
        let Some((key, text)) = self.any(keys) else { return Ok(None) };
        let numbers: Vec<f64> = text_header::numbers(key, text, axis_count, "one number for each dimension")?;
        let at = |axis: usize| numbers.get(axis).copied().unwrap_or(default);
        let vector = DVec3::new(at(0), at(1), at(2));
        if vector.is_finite() { Ok(Some((key, vector))) } else { Err(ReadError::NotFinite { field: key }) }
    }

    /// The matrix in RAS+ mm and the field to blame if it is singular.
    fn patient_from_index(
        &self,
        axis_count: usize,
        warnings: &mut Vec<Warning>,
    ) -> Result<(DAffine3, &'static str), ReadError> {
        let mut field = "ElementSpacing";
        let spacing = match self.vector(&["ElementSpacing", "ElementSize"], axis_count, 1.0)? {
            Some((key, spacing)) => {
                field = key;
                spacing
            }
            None => {
                warnings.extend((1..=axis_count.min(3)).map(|axis| Warning::SpacingAssumed { axis }));
                DVec3::ONE
            }
        };
        let origin = self.vector(&["Offset", "Position", "Origin"], axis_count, 0.0)?;
        let mut direction = DMat3::IDENTITY;
        if let Some((key, text)) = self.any(&["TransformMatrix", "Orientation", "Rotation"]) {
            let expected = "as many numbers as the square of the dimension";
            let numbers: Vec<f64> = text_header::numbers(key, text, axis_count * axis_count, expected)?;
            for axis in 0..axis_count.min(3) {
                for world in 0..axis_count.min(3) {
                    direction.col_mut(axis)[world] = numbers[axis * axis_count + world];
                }
            }
            field = key;
            if !direction.is_finite() {
                return Err(ReadError::NotFinite { field });
            }
        } else if origin.is_none() {
            warnings.push(Warning::OrientationUnknown { axes: LPS_AXES });
        }
        let translation = origin.map_or(DVec3::ZERO, |(_, origin)| origin);
        let linear = direction * DMat3::from_diagonal(spacing);
        let mm = self.optional("DistanceUnits").map_or(1.0, geometry::mm_per_unit);
        let matrix = DAffine3::from_mat3_translation(linear, translation);
        Ok((geometry::flipped(mm * geometry::RAS_FROM_LPS, matrix), field))
    }
}

/// How the voxels are stored after the header or in the data file.
#[derive(Debug)]
struct Data {
    layout: Layout,
    is_binary: bool,
    is_compressed: bool,
    header_bytes: i64,
}

impl Data {
    fn read(&self, mut stream: Stream<'_>, warnings: &mut Vec<Warning>) -> Result<Voxels, ReadError> {
        let bad = |expected| ReadError::bad_field("HeaderSize", &self.header_bytes.to_string(), expected);
        match u64::try_from(self.header_bytes) {
            Ok(count) => stream.skip(count)?,
            Err(_) if self.header_bytes != -1 => {
                return Err(bad("a whole number of bytes, 0 or more, or -1"));
            }
            Err(_) if self.is_compressed || !self.is_binary || !stream.is_plain() => {
                return Err(bad("0 or more bytes; -1 goes with plain binary data only"));
            }
            Err(_) => voxel_data::skip_to_last(&mut stream, self.layout)?,
        }
        if self.is_compressed {
            stream = stream.decompress(Compression::Zlib);
        }
        if self.is_binary {
            voxel_data::read_binary(&mut stream, self.layout, warnings)
        } else {
            voxel_data::read_text(&mut stream, self.layout, warnings)
        }
    }
}

pub(crate) fn read(mut stream: Stream<'_>, siblings: Siblings<'_>) -> Result<Loaded, ReadError> {
    let start = stream.peek(512)?;
    if first_key(&start).is_none() {
        let found = start[..start.len().min(32)].escape_ascii().to_string();
        return Err(ReadError::WrongMagic { found, expected: "`ObjectType = Image` or `NDims = …`" });
    }
    let fields = Fields::read(&mut stream)?;
    let mut warnings = Vec::new();
    if let Some(object) = fields.optional("ObjectType")
        && object != "Image"
    {
        return Err(ReadError::bad_field("ObjectType", object, "Image"));
    }
    let expected = "a whole number from 1 to 10";
    let dimensions = fields.required("NDims")?;
    let axis_count: usize = text_header::number("NDims", dimensions, expected)?;
    if !(1..=10).contains(&axis_count) {
        return Err(ReadError::bad_field("NDims", dimensions, expected));
    }
    let sizes = text_header::sizes("DimSize", fields.required("DimSize")?, axis_count)?;
    let scalar = scalar(fields.required("ElementType")?)?;
    let components = match fields.optional("ElementNumberOfChannels") {
        None => 1,
        Some(text) => {
            let expected = "a whole number from 1 to 65536";
            let components: usize = text_header::number("ElementNumberOfChannels", text, expected)?;
            if !(1..=65536).contains(&components) {
                return Err(ReadError::bad_field("ElementNumberOfChannels", text, expected));
            }
            components
        }
    };
    let size = |axis: usize| sizes.get(axis).copied().unwrap_or(1);
    let (dims, voxel_count) =
        voxel_data::checked_voxel_count([size(0), size(1), size(2)], scalar.byte_size())?;
    let (matrix, field) = fields.patient_from_index(axis_count, &mut warnings)?;
    let grid = geometry::grid(dims, matrix, field)?;
    let frames = sizes.iter().skip(3).fold(1_u64, |product, &size| product.saturating_mul(size));
    if frames > 1 {
        warnings.push(Warning::FirstFrameOnly { frames });
    }
    if components > 1 {
        warnings.push(Warning::FirstComponentOnly { components: components as u64 });
    }

    let byte_order_keys = ["BinaryDataByteOrderMSB", "ElementByteOrderMSB"];
    let is_binary = fields.flag(&["BinaryData"], true)?;
    if scalar.byte_size() > 1 && is_binary && fields.any(&byte_order_keys).is_none() {
        warnings.push(Warning::ByteOrderAssumed);
    }
    let big_endian = fields.flag(&byte_order_keys, false)?;
    let mut layout = Layout::dense(scalar, big_endian, voxel_count).with_components(components);
    layout.ends_stream = frames == 1;
    let data = Data {
        layout,
        is_binary,
        is_compressed: fields.flag(&["CompressedData"], false)?,
        header_bytes: fields.optional("HeaderSize").map_or(Ok(0), |text| {
            text_header::number("HeaderSize", text, "a whole number of bytes, 0 or more, or -1")
        })?,
    };
    let name = fields.required("ElementDataFile")?;
    let voxels = if name.eq_ignore_ascii_case("LOCAL") {
        data.read(stream, &mut warnings)?
    } else if name.split_whitespace().next() == Some("LIST") || name.contains('%') {
        return Err(ReadError::Unsupported {
            what: format!("the list of data files {:?}", crate::error::shorten(name)),
            expected: "LOCAL or a single data file",
        });
    } else {
        siblings.read_named("ElementDataFile", name, |stream| data.read(stream, &mut warnings))?
    };
    Loaded::new(grid, voxels, warnings, Format::MetaImage)
}

fn scalar(name: &str) -> Result<Scalar, ReadError> {
    Ok(match name.strip_suffix("_ARRAY").unwrap_or(name) {
        "MET_CHAR" | "MET_ASCII_CHAR" => Scalar::Voxel(VoxelType::I8),
        "MET_UCHAR" => Scalar::Voxel(VoxelType::U8),
        "MET_SHORT" => Scalar::Voxel(VoxelType::I16),
        "MET_USHORT" => Scalar::Voxel(VoxelType::U16),
        "MET_INT" | "MET_LONG" => Scalar::Voxel(VoxelType::I32),
        "MET_UINT" | "MET_ULONG" => Scalar::Voxel(VoxelType::U32),
        "MET_LONG_LONG" => Scalar::I64,
        "MET_ULONG_LONG" => Scalar::U64,
        "MET_FLOAT" => Scalar::Voxel(VoxelType::F32),
        "MET_DOUBLE" => Scalar::Voxel(VoxelType::F64),
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("element type {:?}", crate::error::shorten(name)),
                expected: "MET_CHAR to MET_ULONG_LONG, MET_FLOAT or MET_DOUBLE",
            });
        }
    })
}
