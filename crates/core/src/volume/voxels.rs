//! Typed voxel arrays.

use rayon::prelude::*;
use std::fmt;
use std::ops::Range;

/// A scalar type that voxels can have.
pub trait Voxel: Copy + Send + Sync + bytemuck::Pod {
    /// The value as f64, exact for every supported type.
    fn to_f64(self) -> f64;

    /// The value of the type that is nearest to a number.
    fn nearest(value: f64) -> Self;
}

macro_rules! voxel_types {
    ($($variant:ident, $type:ty, $name:literal, $round:expr;)*) => {
        $(impl Voxel for $type {
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            fn nearest(value: f64) -> Self {
                let round: fn(f64) -> f64 = $round;
                round(value) as Self
            }
        })*

        /// Voxels in the type that the file gave them.
        #[derive(Debug, Clone, PartialEq)]
        #[allow(missing_docs, reason = "each variant is the array of the scalar type that it names")]
        pub enum Voxels {
            $($variant(Vec<$type>),)*
        }

        /// The scalar type of a voxel.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[allow(missing_docs, reason = "each variant is the scalar type that it names")]
        pub enum VoxelType {
            $($variant,)*
        }

        impl VoxelType {
            /// Every type, smallest first.
            pub const ALL: &[Self] = &[$(Self::$variant,)*];

            /// Name as used in file names and listings: `uint8`, `float32`, ….
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name,)*
                }
            }

            /// Bytes per voxel.
            pub fn byte_size(self) -> usize {
                match self {
                    $(Self::$variant => size_of::<$type>(),)*
                }
            }
        }

        impl Voxels {
            /// The scalar type.
            pub fn voxel_type(&self) -> VoxelType {
                match self {
                    $(Self::$variant(_) => VoxelType::$variant,)*
                }
            }

            /// Number of voxels.
            pub fn len(&self) -> usize {
                match self {
                    $(Self::$variant(v) => v.len(),)*
                }
            }

            /// The voxel at a linear index, as f64.
            pub fn value(&self, index: usize) -> f64 {
                match self {
                    $(Self::$variant(v) => v[index].to_f64(),)*
                }
            }

            /// Decodes little-endian bytes. Trailing bytes that do not fill a voxel are left out.
            pub fn from_le_bytes(voxel_type: VoxelType, bytes: &[u8]) -> Self {
                match voxel_type {
                    $(VoxelType::$variant => Self::$variant(
                        bytes.as_chunks().0.iter().map(|&b| <$type>::from_le_bytes(b)).collect(),
                    ),)*
                }
            }

            /// Decodes big-endian bytes. Trailing bytes that do not fill a voxel are left out.
            pub fn from_be_bytes(voxel_type: VoxelType, bytes: &[u8]) -> Self {
                match voxel_type {
                    $(VoxelType::$variant => Self::$variant(
                        bytes.as_chunks().0.iter().map(|&b| <$type>::from_be_bytes(b)).collect(),
                    ),)*
                }
            }

            /// The voxels as bytes in the machine's own byte order.
            pub fn as_bytes(&self) -> &[u8] {
                match self {
                    $(Self::$variant(v) => bytemuck::cast_slice(v),)*
                }
            }

            /// Maps a range of voxels, as f64, in parallel.
            ///
            /// # Panics
            /// If the range is not within the voxels.
            pub fn map_to_vec<T: Send>(
                &self,
                range: Range<usize>,
                f: impl Fn(f64) -> T + Sync + Send,
            ) -> Vec<T> {
                match self {
                    $(Self::$variant(v) => v[range].par_iter().map(|x| f(x.to_f64())).collect(),)*
                }
            }

            /// So many voxels of the same type, each nearest to what a function makes of its index, in parallel.
            pub(super) fn of_same_type(&self, count: usize, f: impl Fn(usize) -> f64 + Sync + Send) -> Self {
                let indices = (0..count).into_par_iter();
                match self {
                    $(Self::$variant(_) => Self::$variant(indices.map(|i| <$type>::nearest(f(i))).collect()),)*
                }
            }

            /// Smallest and largest finite value; `None` if no value is finite. Beyond ±1e300 counts as infinite.
            pub fn finite_range(&self) -> Option<(f64, f64)> {
                match self {
                    $(Self::$variant(v) => finite_range(v),)*
                }
            }
        }
    };
}

voxel_types! {
    U8, u8, "uint8", f64::round;
    I8, i8, "int8", f64::round;
    U16, u16, "uint16", f64::round;
    I16, i16, "int16", f64::round;
    U32, u32, "uint32", f64::round;
    I32, i32, "int32", f64::round;
    F32, f32, "float32", |x| x;
    F64, f64, "float64", |x| x;
}

impl Voxels {
    /// Whether there are no voxels.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Which voxels are NaN or infinite, one bit each; empty if none is.
    pub(super) fn non_finite_mask(&self) -> Vec<u64> {
        fn mask<T: Voxel>(voxels: &[T]) -> Vec<u64> {
            let bits = |chunk: &[T]| {
                let bit = |(i, x): (usize, &T)| u64::from(!is_usable(x.to_f64())) << i;
                chunk.iter().enumerate().map(bit).sum()
            };
            voxels.par_chunks(MASK_BITS).map(bits).collect()
        }
        let mask = match self {
            Self::F32(v) => mask(v),
            Self::F64(v) => mask(v),
            _ => Vec::new(),
        };
        if mask.iter().all(|&bits| bits == 0) { Vec::new() } else { mask }
    }

    /// Sets the float voxels of a mask to a value.
    pub(super) fn fill(&mut self, mask: &[u64], value: f64) {
        fn fill<T: Copy>(voxels: &mut [T], mask: &[u64], value: T) {
            for (chunk, bits) in voxels.chunks_mut(MASK_BITS).zip(mask).filter(|(_, bits)| **bits != 0) {
                for (i, voxel) in chunk.iter_mut().enumerate() {
                    if bits >> i & 1 == 1 {
                        *voxel = value;
                    }
                }
            }
        }
        match self {
            Self::F32(v) => fill(v, mask, value as f32),
            Self::F64(v) => fill(v, mask, value),
            _ => {}
        }
    }
}

/// Voxels that a word of a mask stands for.
const MASK_BITS: usize = 64;

/// Whether a value can be windowed: finite, and small enough that a difference of two is finite too.
fn is_usable(value: f64) -> bool {
    value.abs() <= 1e300
}

fn finite_range<T: Voxel>(voxels: &[T]) -> Option<(f64, f64)> {
    const NOTHING: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
    let (lo, hi) = voxels
        .par_chunks(1 << 16)
        .map(|chunk| {
            chunk
                .iter()
                .map(|x| x.to_f64())
                .filter(|&x| is_usable(x))
                .fold(NOTHING, |(lo, hi), x| (if x < lo { x } else { lo }, if x > hi { x } else { hi }))
        })
        .reduce(|| NOTHING, |a, b| (a.0.min(b.0), a.1.max(b.1)));
    (lo <= hi).then_some((lo, hi))
}

impl fmt::Display for VoxelType {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
