//! NRRD (<https://teem.sourceforge.net/nrrd/format.html>).

mod fields;
mod layout;
mod write;

pub use write::{encode_nrrd, write_nrrd};

use crate::{
    Format, Loaded, ReadError, Warning, geometry,
    siblings::Siblings,
    stream::{Compression, Stream},
    text_header,
    voxel_data::{self, Layout, Scalar},
};
use fields::Fields;
use layout::Axes;
use wheatstone_core::volume::{VoxelType, Voxels};

const MAGIC: &str = "NRRD000";

/// Whether a file starts as NRRD files do.
pub(crate) fn is_magic(start: &[u8]) -> bool {
    start.starts_with(MAGIC.as_bytes())
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Raw,
    Gzip,
    Text,
}

pub(crate) fn read(mut stream: Stream<'_>, siblings: Siblings<'_>) -> Result<Loaded, ReadError> {
    let fields = Fields::read(&mut stream)?;
    let mut warnings = Vec::new();
    let dimension: usize =
        text_header::number("dimension", fields.required("dimension")?, "a whole number from 1 to 16")?;
    if !(1..=16).contains(&dimension) {
        let text = dimension.to_string();
        return Err(ReadError::bad_field("dimension", &text, "a whole number from 1 to 16"));
    }
    let sizes = text_header::sizes("sizes", fields.required("sizes")?, dimension)?;
    let scalar = scalar(fields.required("type")?)?;
    let encoding = encoding(fields.required("encoding")?)?;
    let axes = Axes::classify(&fields, &sizes)?;
    let (dims, voxel_count) = voxel_data::checked_voxel_count(axes.dims(), scalar.byte_size())?;
    let (matrix, field) = fields.patient_from_index(&axes, &mut warnings)?;
    let grid = geometry::grid(dims, matrix, field)?;
    let big_endian = big_endian(&fields, scalar, encoding, &mut warnings)?;
    let layout = axes.layout(Layout::dense(scalar, big_endian, voxel_count), &mut warnings)?;

    let data = Data {
        encoding,
        layout,
        line_skip: fields.optional("line skip").map_or(Ok(0), |text| {
            text_header::number("line skip", text, "a whole number of lines, 0 or more")
        })?,
        byte_skip: fields.optional("byte skip").map_or(Ok(0), |text| {
            text_header::number("byte skip", text, "a whole number of bytes, 0 or more, or -1")
        })?,
    };
    let voxels = match fields.optional("data file") {
        None => data.read(stream, &mut warnings)?,
        Some(name) => {
            let is_list = name.split_whitespace().next() == Some("LIST") || name.contains('%');
            if is_list {
                return Err(ReadError::Unsupported {
                    what: format!("the list of data files {:?}", crate::error::shorten(name)),
                    expected: "a single data file",
                });
            }
            siblings.read_named("data file", name, |stream| data.read(stream, &mut warnings))?
        }
    };
    Loaded::new(grid, voxels, warnings, Format::Nrrd)
}

/// How the voxels are stored after the header or in the data file.
#[derive(Debug)]
struct Data {
    encoding: Encoding,
    layout: Layout,
    line_skip: u64,
    byte_skip: i64,
}

impl Data {
    fn read(&self, mut stream: Stream<'_>, warnings: &mut Vec<Warning>) -> Result<Voxels, ReadError> {
        stream.skip_lines(self.line_skip)?;
        if self.encoding == Encoding::Gzip {
            stream = stream.decompress(Compression::Gzip);
        }
        let bad_skip = |expected| ReadError::bad_field("byte skip", &self.byte_skip.to_string(), expected);
        match u64::try_from(self.byte_skip) {
            Ok(count) => stream.skip(count)?,
            Err(_) if self.byte_skip != -1 => {
                return Err(bad_skip("a whole number of bytes, 0 or more, or -1"));
            }
            Err(_) if self.encoding != Encoding::Raw || !stream.is_plain() => {
                return Err(bad_skip("0 or more bytes; -1 goes with encoding raw only"));
            }
            Err(_) => voxel_data::skip_to_last(&mut stream, self.layout)?,
        }
        match self.encoding {
            Encoding::Text => voxel_data::read_text(&mut stream, self.layout, warnings),
            Encoding::Raw | Encoding::Gzip => voxel_data::read_binary(&mut stream, self.layout, warnings),
        }
    }
}

fn scalar(name: &str) -> Result<Scalar, ReadError> {
    let words: Vec<&str> = name.split_whitespace().collect();
    Ok(match words.join(" ").as_str() {
        "signed char" | "int8" | "int8_t" => Scalar::Voxel(VoxelType::I8),
        "uchar" | "unsigned char" | "uint8" | "uint8_t" => Scalar::Voxel(VoxelType::U8),
        "short" | "short int" | "signed short" | "signed short int" | "int16" | "int16_t" => {
            Scalar::Voxel(VoxelType::I16)
        }
        "ushort" | "unsigned short" | "unsigned short int" | "uint16" | "uint16_t" => {
            Scalar::Voxel(VoxelType::U16)
        }
        "int" | "signed int" | "int32" | "int32_t" => Scalar::Voxel(VoxelType::I32),
        "uint" | "unsigned int" | "uint32" | "uint32_t" => Scalar::Voxel(VoxelType::U32),
        "longlong"
        | "long long"
        | "long long int"
        | "signed long long"
        | "signed long long int"
        | "int64"
        | "int64_t" => Scalar::I64,
        "ulonglong" | "unsigned long long" | "unsigned long long int" | "uint64" | "uint64_t" => Scalar::U64,
        "float" => Scalar::Voxel(VoxelType::F32),
        "double" => Scalar::Voxel(VoxelType::F64),
        _ => {
            return Err(ReadError::Unsupported {
                what: format!("voxel type {:?}", crate::error::shorten(name)),
                expected: "an NRRD type from int8 to uint64, float or double",
            });
        }
    })
}

fn encoding(name: &str) -> Result<Encoding, ReadError> {
    match name.trim().to_ascii_lowercase().as_str() {
        "raw" => Ok(Encoding::Raw),
        "gzip" | "gz" => Ok(Encoding::Gzip),
        "ascii" | "text" | "txt" => Ok(Encoding::Text),
        _ => Err(ReadError::Unsupported {
            what: format!("encoding {:?}", crate::error::shorten(name)),
            expected: "raw, gzip or ascii",
        }),
    }
}

fn big_endian(
    fields: &Fields,
    scalar: Scalar,
    encoding: Encoding,
    warnings: &mut Vec<Warning>,
) -> Result<bool, ReadError> {
    match fields.optional("endian").map(|text| text.trim().to_ascii_lowercase()).as_deref() {
        Some("little") => Ok(false),
        Some("big") => Ok(true),
        Some(other) => Err(ReadError::bad_field("endian", other, "little or big")),
        None => {
            if scalar.byte_size() > 1 && encoding != Encoding::Text {
                warnings.push(Warning::ByteOrderAssumed);
            }
            Ok(false)
        }
    }
}
