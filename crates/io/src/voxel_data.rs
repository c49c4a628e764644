//! From a stream of scalars to typed voxels: types, byte order, components, frames, and size limits.

use crate::{ReadError, Warning, cancel::is_cancelled, stream::Stream};
use std::str::FromStr;
use wheatstone_core::volume::{VoxelType, Voxels};

/// Most bytes that the voxels of a volume may take in memory: 16 GiB.
///
/// Files that declare more are refused before anything is allocated.
pub const MAX_VOXEL_BYTES: u64 = 1 << 34;

/// Bytes decoded at a time; a multiple of every scalar's size.
const CHUNK_BYTES: usize = 1 << 18;

/// Scalar types that files can have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    Voxel(VoxelType),
    I64,
    U64,
}

impl Scalar {
    pub(crate) fn byte_size(self) -> usize {
        match self {
            Self::Voxel(voxel_type) => voxel_type.byte_size(),
            Self::I64 | Self::U64 => 8,
        }
    }

    fn conversion(self) -> Option<Warning> {
        match self {
            Self::Voxel(_) => None,
            Self::I64 => Some(Warning::ConvertedToFloat64 { from: "int64" }),
            Self::U64 => Some(Warning::ConvertedToFloat64 { from: "uint64" }),
        }
    }
}

/// How the scalars of a stream make up voxels: of every `period` scalars the first `run` are voxels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Layout {
    pub(crate) scalar: Scalar,
    pub(crate) big_endian: bool,
    /// Voxels of the first frame.
    pub(crate) voxel_count: usize,
    /// Voxels that lie side by side; divides `voxel_count`.
    pub(crate) run: usize,
    /// Scalars from the start of one run to the start of the next; at least `run`.
    pub(crate) period: usize,
    /// Whether nothing should follow the last voxel.
    pub(crate) ends_stream: bool,
}

impl Layout {
    /// Voxels of one component, one after another.
    pub(crate) fn dense(scalar: Scalar, big_endian: bool, voxel_count: usize) -> Self {
        Self { scalar, big_endian, voxel_count, run: voxel_count, period: voxel_count, ends_stream: true }
    }

    /// Voxels of which each has `components` scalars side by side.
    pub(crate) fn with_components(self, components: usize) -> Self {
        if components == 1 { self } else { Self { run: 1, period: components, ..self } }
    }

    /// Scalars from the first voxel to the last; `None` on overflow.
    fn scalar_count(self) -> Option<u64> {
        let runs = (self.voxel_count / self.run) as u64;
        (runs - 1).checked_mul(self.period as u64)?.checked_add(self.run as u64)
    }
}

/// Checks dimensions against [`MAX_VOXEL_BYTES`]; the number of voxels.
pub(crate) fn checked_voxel_count(
    dims: [u64; 3],
    bytes_per_voxel: usize,
) -> Result<([usize; 3], usize), ReadError> {
    let bytes_per_voxel = bytes_per_voxel as u64;
    let too_large = || ReadError::TooLarge { dims, bytes_per_voxel, limit_bytes: MAX_VOXEL_BYTES };
    let count = dims.iter().try_fold(1_u64, |product, &d| product.checked_mul(d));
    let bytes = count.and_then(|count| count.checked_mul(bytes_per_voxel));
    if bytes.is_none_or(|bytes| bytes > MAX_VOXEL_BYTES) {
        return Err(too_large());
    }
    let as_usize = |x: u64| usize::try_from(x).map_err(|_| too_large());
    let dims_usize = [as_usize(dims[0])?, as_usize(dims[1])?, as_usize(dims[2])?];
    Ok((dims_usize, as_usize(count.unwrap_or(0))?))
}

/// Passes over what precedes the voxels where they are the last bytes of a plain stream.
pub(crate) fn skip_to_last(stream: &mut Stream<'_>, layout: Layout) -> Result<(), ReadError> {
    let bytes = layout.scalar_count().and_then(|count| count.checked_mul(layout.scalar.byte_size() as u64));
    let expected_bytes = bytes.unwrap_or(u64::MAX);
    let found_bytes = stream.remaining();
    let before = found_bytes.checked_sub(expected_bytes);
    stream.skip(before.ok_or(ReadError::Truncated { what: "voxel data", expected_bytes, found_bytes })?)
}

macro_rules! decode {
    ($stream:expr, $layout:expr, $type:ty) => {
        if $layout.big_endian {
            binary($stream, $layout, <$type>::from_be_bytes)
        } else {
            binary($stream, $layout, <$type>::from_le_bytes)
        }
    };
    ($stream:expr, $layout:expr, $type:ty as f64) => {
        if $layout.big_endian {
            binary($stream, $layout, |bytes| <$type>::from_be_bytes(bytes) as f64)
        } else {
            binary($stream, $layout, |bytes| <$type>::from_le_bytes(bytes) as f64)
        }
    };
}

/// Reads binary voxels.
pub(crate) fn read_binary(
    stream: &mut Stream<'_>,
    layout: Layout,
    warnings: &mut Vec<Warning>,
) -> Result<Voxels, ReadError> {
    let voxels = match layout.scalar {
        Scalar::Voxel(VoxelType::U8) => Voxels::U8(decode!(stream, layout, u8)?),
        Scalar::Voxel(VoxelType::I8) => Voxels::I8(decode!(stream, layout, i8)?),
        Scalar::Voxel(VoxelType::U16) => Voxels::U16(decode!(stream, layout, u16)?),
        Scalar::Voxel(VoxelType::I16) => Voxels::I16(decode!(stream, layout, i16)?),
        Scalar::Voxel(VoxelType::U32) => Voxels::U32(decode!(stream, layout, u32)?),
        Scalar::Voxel(VoxelType::I32) => Voxels::I32(decode!(stream, layout, i32)?),
        Scalar::Voxel(VoxelType::F32) => Voxels::F32(decode!(stream, layout, f32)?),
        Scalar::Voxel(VoxelType::F64) => Voxels::F64(decode!(stream, layout, f64)?),
        Scalar::I64 => Voxels::F64(decode!(stream, layout, i64 as f64)?),
        Scalar::U64 => Voxels::F64(decode!(stream, layout, u64 as f64)?),
    };
    warnings.extend(layout.scalar.conversion());
    if layout.ends_stream && layout.run == layout.period {
        match stream.has_more() {
            Ok(false) => {}
            Ok(true) => warnings.push(Warning::ExtraData),
            Err(error) if is_cancelled(&error) => return Err(ReadError::Cancelled),
            Err(error) => warnings.push(Warning::Unverified { detail: error.to_string() }),
        }
    }
    Ok(voxels)
}

/// Reads voxels that are written as text.
pub(crate) fn read_text(
    stream: &mut Stream<'_>,
    layout: Layout,
    warnings: &mut Vec<Warning>,
) -> Result<Voxels, ReadError> {
    warnings.extend(layout.scalar.conversion());
    Ok(match layout.scalar {
        Scalar::Voxel(VoxelType::U8) => Voxels::U8(text(stream, layout)?),
        Scalar::Voxel(VoxelType::I8) => Voxels::I8(text(stream, layout)?),
        Scalar::Voxel(VoxelType::U16) => Voxels::U16(text(stream, layout)?),
        Scalar::Voxel(VoxelType::I16) => Voxels::I16(text(stream, layout)?),
        Scalar::Voxel(VoxelType::U32) => Voxels::U32(text(stream, layout)?),
        Scalar::Voxel(VoxelType::I32) => Voxels::I32(text(stream, layout)?),
        Scalar::Voxel(VoxelType::F32) => Voxels::F32(text(stream, layout)?),
        Scalar::Voxel(VoxelType::F64) | Scalar::I64 | Scalar::U64 => Voxels::F64(text(stream, layout)?),
    })
}

fn binary<T, const N: usize>(
    stream: &mut Stream<'_>,
    layout: Layout,
    decode: impl Fn([u8; N]) -> T,
) -> Result<Vec<T>, ReadError> {
    let bytes = layout.scalar_count().and_then(|scalars| scalars.checked_mul(N as u64));
    let expected_bytes = bytes.unwrap_or(u64::MAX);
    let truncated = |found_bytes| ReadError::Truncated { what: "voxel data", expected_bytes, found_bytes };
    if expected_bytes > stream.remaining() {
        return Err(truncated(stream.remaining()));
    }
    let mut voxels = Vec::new();
    if stream.is_plain() {
        reserve(&mut voxels, layout.voxel_count)?;
    }
    let mut buffer = vec![0; CHUNK_BYTES.min(usize::try_from(expected_bytes).unwrap_or(CHUNK_BYTES))];
    let mut done_bytes = 0;
    let mut scalar_index = 0;
    while done_bytes < expected_bytes {
        let wanted = (expected_bytes - done_bytes).min(buffer.len() as u64) as usize;
        let found = stream.fill(&mut buffer[..wanted])?;
        if found < wanted {
            return Err(truncated(done_bytes + found as u64));
        }
        done_bytes += found as u64;
        let (scalars, _) = buffer[..wanted].as_chunks::<N>();
        grow(&mut voxels, scalars.len(), layout.voxel_count)?;
        if layout.run == layout.period {
            voxels.extend(scalars.iter().map(|&s| decode(s)));
        } else {
            let first = scalar_index;
            let kept = scalars.iter().enumerate().filter(|(i, _)| (first + i) % layout.period < layout.run);
            voxels.extend(kept.map(|(_, &s)| decode(s)));
        }
        scalar_index += scalars.len();
    }
    Ok(voxels)
}

fn text<T: FromStr>(stream: &mut Stream<'_>, layout: Layout) -> Result<Vec<T>, ReadError> {
    let expected = layout.scalar_count().unwrap_or(u64::MAX);
    if expected > stream.remaining() / 2 + 1 {
        return Err(ReadError::TruncatedText { expected, found: stream.remaining() / 2 + 1 });
    }
    let mut voxels = Vec::new();
    for index in 0..expected {
        let word = stream.word()?.ok_or(ReadError::TruncatedText { expected, found: index })?;
        if index % (layout.period as u64) < layout.run as u64 {
            grow(&mut voxels, 1, layout.voxel_count)?;
            let value = word.parse().map_err(|_| {
                ReadError::bad_field("voxel data", &word, "a number of the voxel type that the header names")
            })?;
            voxels.push(value);
        }
    }
    Ok(voxels)
}

/// Makes room as data arrives, so that memory follows what a file holds and not what it declares.
fn grow<T>(voxels: &mut Vec<T>, more: usize, total: usize) -> Result<(), ReadError> {
    if voxels.capacity() - voxels.len() >= more {
        return Ok(());
    }
    let next = voxels.capacity().saturating_mul(2).max(voxels.len() + more).min(total);
    let additional = next.saturating_sub(voxels.len());
    reserve(voxels, additional)
}

fn reserve<T>(voxels: &mut Vec<T>, additional: usize) -> Result<(), ReadError> {
    voxels.try_reserve_exact(additional).map_err(|_| ReadError::OutOfMemory {
        bytes: (voxels.len() as u64).saturating_add(additional as u64).saturating_mul(size_of::<T>() as u64),
    })
}

/// Applies slope and intercept: whole-number shifts stay whole where a type holds them, the rest becomes f32 (f64 stays).
pub(crate) fn rescale(voxels: Voxels, slope: f64, intercept: f64) -> Voxels {
    if slope == 1.0 && intercept == 0.0 {
        return voxels;
    }
    let is_float = matches!(voxels, Voxels::F32(_) | Voxels::F64(_));
    if slope == 1.0
        && intercept.fract() == 0.0
        && !is_float
        && let Some((lo, hi)) = voxels.finite_range()
    {
        let (lo, hi) = (lo + intercept, hi + intercept);
        let fits = |lowest: f64, highest: f64| lowest <= lo && hi <= highest;
        let own = voxels.voxel_type();
        let holding = [own, VoxelType::I16, VoxelType::U16, VoxelType::I32, VoxelType::U32];
        let target = holding.into_iter().find(|target| match target {
            VoxelType::U8 => fits(0.0, 255.0),
            VoxelType::I8 => fits(-128.0, 127.0),
            VoxelType::U16 => fits(0.0, 65535.0),
            VoxelType::I16 => fits(-32768.0, 32767.0),
            VoxelType::U32 => fits(0.0, f64::from(u32::MAX)),
            VoxelType::I32 => fits(f64::from(i32::MIN), f64::from(i32::MAX)),
            VoxelType::F32 | VoxelType::F64 => false,
        });
        match target {
            Some(VoxelType::U8) => {
                return Voxels::U8(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as u8));
            }
            Some(VoxelType::I8) => {
                return Voxels::I8(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as i8));
            }
            Some(VoxelType::U16) => {
                return Voxels::U16(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as u16));
            }
            Some(VoxelType::I16) => {
                return Voxels::I16(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as i16));
            }
            Some(VoxelType::U32) => {
                return Voxels::U32(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as u32));
            }
            Some(VoxelType::I32) => {
                return Voxels::I32(voxels.map_to_vec(0..voxels.len(), |x| (x + intercept) as i32));
            }
            _ => {}
        }
    }
    match voxels {
        Voxels::F64(v) => Voxels::F64(v.into_iter().map(|x| x * slope + intercept).collect()),
        v => Voxels::F32(v.map_to_vec(0..v.len(), |x| (x * slope + intercept) as f32)),
    }
}
