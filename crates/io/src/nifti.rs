//! NIfTI-1 and NIfTI-2 (<https://nifti.nimh.nih.gov/nifti-1>, <https://nifti.nimh.nih.gov/nifti-2>).
//!
//! The header is parsed here because the crate `nifti` 0.18 knows no NIfTI-2 and panics on some invalid headers
//! (such as spacings that are not positive).

use crate::{
    Format, Loaded, ReadError, Warning, geometry,
    siblings::Siblings,
    stream::Stream,
    voxel_data::{self, Layout, Scalar},
    warning::RAS_AXES,
};
use glam::{DAffine3, DMat3, DQuat, DVec3};
use wheatstone_core::volume::VoxelType;

const HEADER_1_BYTES: usize = 348;
const HEADER_2_BYTES: usize = 540;
const MAGIC_1_AT: usize = 344;
const MAGIC_2_AT: usize = 4;
const EXPECTED_MAGIC: &str = "the header of NIfTI-1 (348 bytes, `n+1` or `ni1` at byte 344) or of NIfTI-2 (540 bytes, \
                              `n+2` or `ni2` at byte 4)";
const EXPECTED_TYPE: &str = "8- to 64-bit integers, float32, float64, complex64, complex128, RGB24 or RGBA32";

/// Whether a file starts as NIfTI files do.
pub(crate) fn is_magic(start: &[u8]) -> bool {
    Version::detect(start).is_some()
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Version {
    is_2: bool,
    big_endian: bool,
    detached: bool,
}

impl Version {
    fn detect(start: &[u8]) -> Option<Self> {
        let size: [u8; 4] = start.get(..4)?.try_into().ok()?;
        let known = [HEADER_1_BYTES as u32, HEADER_2_BYTES as u32];
        let big_endian = known.contains(&u32::from_be_bytes(size));
        let size = if big_endian { u32::from_be_bytes(size) } else { u32::from_le_bytes(size) };
        let is_2 = match size as usize {
            HEADER_1_BYTES => false,
            HEADER_2_BYTES => true,
            _ => return None,
        };
        let (magic_at, one_file, two_files): (_, &[u8], &[u8]) = if is_2 {
            (MAGIC_2_AT, b"n+2\0\r\n\x1a\n", b"ni2\0\r\n\x1a\n")
        } else {
            (MAGIC_1_AT, b"n+1\0", b"ni1\0")
        };
        let magic = start.get(magic_at..magic_at + one_file.len())?;
        let detached = magic == two_files;
        (detached || magic == one_file).then_some(Self { is_2, big_endian, detached })
    }
}

/// The fields that Wheatstone needs, widened to NIfTI-2's types.
#[derive(Debug)]
struct Header {
    version: Version,
    rank: i64,
    sizes: [i64; 7],
    datatype: i16,
    pixdim: [f64; 8],
    data_offset_bytes: f64,
    slope: f64,
    intercept: f64,
    q_form_code: i32,
    s_form_code: i32,
    quaternion: [f64; 3],
    q_offset: DVec3,
    s_form_rows: [[f64; 4]; 3],
    units: i32,
}

/// Fields at fixed places; callers stay within the header's length.
struct Fields<'a> {
    bytes: &'a [u8],
    big_endian: bool,
}

impl Fields<'_> {
    fn array<const N: usize>(&self, at: usize) -> [u8; N] {
        let mut field = [0; N];
        field.copy_from_slice(&self.bytes[at..at + N]);
        if self.big_endian {
            field.reverse();
        }
        field
    }

    fn i16(&self, at: usize) -> i16 {
        i16::from_le_bytes(self.array(at))
    }

    fn i32(&self, at: usize) -> i32 {
        i32::from_le_bytes(self.array(at))
    }

    fn i64(&self, at: usize) -> i64 {
        i64::from_le_bytes(self.array(at))
    }

    fn f32(&self, at: usize) -> f64 {
        f64::from(f32::from_le_bytes(self.array(at)))
    }

    fn f64(&self, at: usize) -> f64 {
        f64::from_le_bytes(self.array(at))
    }
}

impl Header {
    fn parse(bytes: &[u8], version: Version) -> Self {
        let fields = Fields { bytes, big_endian: version.big_endian };
        if version.is_2 { Self::parse_2(&fields, version) } else { Self::parse_1(&fields, version) }
    }

    fn parse_1(f: &Fields<'_>, version: Version) -> Self {
        let floats = |at: usize| std::array::from_fn(|i| f.f32(at + 4 * i));
        Self {
            version,
            rank: i64::from(f.i16(40)),
            sizes: std::array::from_fn(|i| i64::from(f.i16(42 + 2 * i))),
            datatype: f.i16(70),
            pixdim: std::array::from_fn(|i| f.f32(76 + 4 * i)),
            data_offset_bytes: f.f32(108),
            slope: f.f32(112),
            intercept: f.f32(116),
            units: i32::from(f.bytes[123]),
            q_form_code: i32::from(f.i16(252)),
            s_form_code: i32::from(f.i16(254)),
            quaternion: std::array::from_fn(|i| f.f32(256 + 4 * i)),
            q_offset: DVec3::new(f.f32(268), f.f32(272), f.f32(276)),
            s_form_rows: [floats(280), floats(296), floats(312)],
        }
    }

    fn parse_2(f: &Fields<'_>, version: Version) -> Self {
        let floats = |at: usize| std::array::from_fn(|i| f.f64(at + 8 * i));
        Self {
            version,
            datatype: f.i16(12),
            rank: f.i64(16),
            sizes: std::array::from_fn(|i| f.i64(24 + 8 * i)),
            pixdim: std::array::from_fn(|i| f.f64(104 + 8 * i)),
            data_offset_bytes: f.i64(168) as f64,
            slope: f.f64(176),
            intercept: f.f64(184),
            q_form_code: f.i32(344),
            s_form_code: f.i32(348),
            quaternion: std::array::from_fn(|i| f.f64(352 + 8 * i)),
            q_offset: DVec3::new(f.f64(376), f.f64(384), f.f64(392)),
            s_form_rows: [floats(400), floats(432), floats(464)],
            units: f.i32(500),
        }
    }

    /// Dimensions of a frame, and the number of frames.
    fn dims_and_frames(&self) -> Result<([u64; 3], u64), ReadError> {
        let rank =
            usize::try_from(self.rank).ok().filter(|rank| (1..=7).contains(rank)).ok_or_else(|| {
                ReadError::bad_field("dim[0]", &self.rank.to_string(), "a number of dimensions from 1 to 7")
            })?;
        let mut sizes = [1_u64; 7];
        for (axis, size) in sizes.iter_mut().enumerate().take(rank) {
            let value = self.sizes[axis];
            *size = u64::try_from(value).ok().filter(|&size| size > 0).ok_or(ReadError::BadDimension {
                field: "dim",
                axis: axis + 1,
                value,
            })?;
        }
        let frames = sizes[3..].iter().fold(1_u64, |product, &size| product.saturating_mul(size));
        Ok(([sizes[0], sizes[1], sizes[2]], frames))
    }

    /// Scalar type and number of components.
    fn scalar(&self) -> Result<(Scalar, usize), ReadError> {
        let voxel = |voxel_type| Ok((Scalar::Voxel(voxel_type), 1));
        match self.datatype {
            2 => voxel(VoxelType::U8),
            4 => voxel(VoxelType::I16),
            8 => voxel(VoxelType::I32),
            16 => voxel(VoxelType::F32),
            32 => Ok((Scalar::Voxel(VoxelType::F32), 2)),
            64 => voxel(VoxelType::F64),
            128 => Ok((Scalar::Voxel(VoxelType::U8), 3)),
            256 => voxel(VoxelType::I8),
            512 => voxel(VoxelType::U16),
            768 => voxel(VoxelType::U32),
            1024 => Ok((Scalar::I64, 1)),
            1280 => Ok((Scalar::U64, 1)),
            1792 => Ok((Scalar::Voxel(VoxelType::F64), 2)),
            2304 => Ok((Scalar::Voxel(VoxelType::U8), 4)),
            code => {
                let name = match code {
                    1 => "1-bit".to_owned(),
                    1536 => "128-bit float".to_owned(),
                    2048 => "256-bit complex".to_owned(),
                    other => format!("unknown ({other})"),
                };
                Err(ReadError::Unsupported { what: format!("voxel type {name}"), expected: EXPECTED_TYPE })
            }
        }
    }

    /// The matrix in RAS+ mm and the field that it comes from.
    fn patient_from_index(&self, warnings: &mut Vec<Warning>) -> (DAffine3, &'static str) {
        let mm_per_unit = match self.units & 0x07 {
            1 => 1e3,
            3 => 1e-3,
            _ => 1.0,
        };
        let to_mm = DAffine3::from_scale(DVec3::splat(mm_per_unit));
        if self.s_form_code > 0 {
            let rows = self.s_form_rows.map(|r| DVec3::new(r[0], r[1], r[2]));
            let linear = DMat3::from_cols(rows[0], rows[1], rows[2]).transpose();
            let translation = DVec3::from(self.s_form_rows.map(|r| r[3]));
            return (to_mm * DAffine3::from_mat3_translation(linear, translation), "srow_x, srow_y, srow_z");
        }
        let spacing = DVec3::from(self.spacing(warnings));
        if self.q_form_code > 0 {
            let handedness = if self.pixdim[0] < 0.0 { -1.0 } else { 1.0 };
            let scale = DMat3::from_diagonal(spacing * DVec3::new(1.0, 1.0, handedness));
            let linear = rotation(self.quaternion) * scale;
            return (
                to_mm * DAffine3::from_mat3_translation(linear, self.q_offset),
                "quatern_b, quatern_c, quatern_d",
            );
        }
        warnings.push(Warning::OrientationUnknown { axes: RAS_AXES });
        (to_mm * geometry::diagonal(spacing), "pixdim")
    }

    fn spacing(&self, warnings: &mut Vec<Warning>) -> [f64; 3] {
        std::array::from_fn(|i| {
            let spacing = self.pixdim[i + 1].abs();
            if spacing != 0.0 {
                return spacing;
            }
            if (i as i64) < self.rank {
                warnings.push(Warning::SpacingAssumed { axis: i + 1 });
            }
            1.0
        })
    }

    /// Where the voxels start, counted from the end of the header.
    fn data_start(&self) -> Result<u64, ReadError> {
        let header_bytes = if self.version.is_2 { HEADER_2_BYTES } else { HEADER_1_BYTES } as u64;
        let offset = self.data_offset_bytes;
        let is_whole =
            offset.is_finite() && offset >= 0.0 && offset < 2_f64.powi(63) && offset.fract() == 0.0;
        let bad = || {
            ReadError::bad_field("vox_offset", &offset.to_string(), "a whole number of bytes, 352 or more")
        };
        if !is_whole {
            return Err(bad());
        }
        match offset as u64 {
            offset if self.version.detached => Ok(offset),
            0 => Ok(4),
            offset => offset.checked_sub(header_bytes).ok_or_else(bad),
        }
    }
}

/// The rotation of a unit quaternion from its imaginary parts, as the NIfTI-1 standard completes it.
fn rotation([b, c, d]: [f64; 3]) -> DMat3 {
    let a_squared = 1.0 - (b * b + c * c + d * d);
    if a_squared < 1e-7 {
        let imaginary = DVec3::new(b, c, d);
        let unit = imaginary / imaginary.length();
        return DMat3::from_quat(DQuat::from_xyzw(unit.x, unit.y, unit.z, 0.0));
    }
    DMat3::from_quat(DQuat::from_xyzw(b, c, d, a_squared.sqrt()))
}

pub(crate) fn read(mut stream: Stream<'_>, siblings: Siblings<'_>) -> Result<Loaded, ReadError> {
    let start = stream.peek(HEADER_1_BYTES)?;
    let version = Version::detect(&start).ok_or_else(|| wrong_magic(&start))?;
    let header_bytes = if version.is_2 { HEADER_2_BYTES } else { HEADER_1_BYTES };
    let header = Header::parse(&stream.take_exact(header_bytes, "header")?, version);

    let mut warnings = Vec::new();
    let (dims, frames) = header.dims_and_frames()?;
    let (scalar, components) = header.scalar()?;
    let is_colour = matches!(header.datatype, 128 | 2304);
    let is_scaled = header.slope != 0.0 && (header.slope, header.intercept) != (1.0, 0.0) && !is_colour;
    let bytes_per_voxel = scalar.byte_size().max(if is_scaled { size_of::<f32>() } else { 1 });
    let (dims, voxel_count) = voxel_data::checked_voxel_count(dims, bytes_per_voxel)?;
    let (matrix, field) = header.patient_from_index(&mut warnings);
    let grid = geometry::grid(dims, matrix, field)?;
    if frames > 1 {
        warnings.push(Warning::FirstFrameOnly { frames });
    }
    if components > 1 {
        warnings.push(Warning::FirstComponentOnly { components: components as u64 });
    }

    let mut layout = Layout::dense(scalar, version.big_endian, voxel_count).with_components(components);
    layout.ends_stream = frames == 1;
    let start = header.data_start()?;
    let mut read_voxels = |mut stream: Stream<'_>| {
        stream.skip(start)?;
        voxel_data::read_binary(&mut stream, layout, &mut warnings)
    };
    let voxels =
        if version.detached { siblings.read_nifti_image(read_voxels)? } else { read_voxels(stream)? };

    let voxels = if !is_scaled {
        voxels
    } else if header.slope.is_finite() && header.intercept.is_finite() {
        voxel_data::rescale(voxels, header.slope, header.intercept)
    } else {
        let (slope, intercept) = (header.slope, header.intercept);
        warnings.push(Warning::ScalingIgnored { slope, intercept });
        voxels
    };
    Loaded::new(grid, voxels, warnings, Format::Nifti)
}

fn wrong_magic(start: &[u8]) -> ReadError {
    if start.len() < HEADER_1_BYTES {
        return ReadError::Truncated {
            what: "header",
            expected_bytes: HEADER_1_BYTES as u64,
            found_bytes: start.len() as u64,
        };
    }
    ReadError::WrongMagic { found: start[..8].escape_ascii().to_string(), expected: EXPECTED_MAGIC }
}
