//! How voxels are held for sampling: 8-bit, 16-bit or f32, with the map back to values.
//!
//! Both casters sample the stored numbers, so they interpolate the same.

use std::ops::Range;

use super::{Volume, VoxelType, Voxels, Window};

/// The three precisions that a volume is sampled from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum StorageKind {
    /// 8-bit unsigned.
    U8,
    /// 16-bit unsigned.
    U16,
    /// 32-bit float.
    F32,
}

impl StorageKind {
    /// Bytes per voxel.
    pub fn byte_size(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::F32 => 4,
        }
    }

    /// The smallest kind that holds every value of the volume without loss (f64 and wide integers: to f32
    /// precision over their range).
    pub fn lossless_for(volume: &Volume) -> Self {
        let (lo, hi) = volume.range();
        match volume.voxels().voxel_type() {
            VoxelType::F32 | VoxelType::F64 => Self::F32,
            _ if hi - lo <= 255.0 => Self::U8,
            _ if hi - lo <= 65535.0 => Self::U16,
            _ => Self::F32,
        }
    }
}

/// How many times their range values may be away from zero and be held in f32 as they are.
const MOST_OFFSET: f64 = 1e3;

/// Wider ranges are scaled, so that the difference of two f32 values cannot overflow. A fill value of `f32::MIN` beside
/// ordinary data is not wider.
const LARGEST_F32_RANGE: f64 = f32::MAX as f64;

/// Times the offset, how far f32 rounding of `stored · scale + offset` may carry it from 0.
const ROUNDING_OF_NORMALISING: f64 = 2.5 * f32::EPSILON as f64;

/// Voxels as stored.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "each variant is the array of the storage kind that it names")]
pub enum StoredVoxels {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// How a volume's values become stored numbers: `value = stored · value_per_stored + value_at_zero`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encoding {
    kind: StorageKind,
    value_per_stored: f64,
    value_at_zero: f64,
}

impl Encoding {
    /// The encoding of a volume at a precision. Integers that fit keep their steps, and what f32 holds well stays as
    /// it is (a fill value far outside the data then costs no precision); the rest is scaled from the volume's range
    /// to the whole range of the kind ([0, 1] for f32).
    pub fn new(volume: &Volume, kind: StorageKind) -> Self {
        let (lo, hi) = volume.range();
        let fits = kind != StorageKind::F32 && StorageKind::lossless_for(volume) <= kind;
        let is_native = match kind {
            StorageKind::U8 => volume.voxels().voxel_type() == VoxelType::U8,
            StorageKind::U16 => volume.voxels().voxel_type() == VoxelType::U16,
            StorageKind::F32 => {
                lo.abs().max(hi.abs()) <= MOST_OFFSET * (hi - lo) && hi - lo <= LARGEST_F32_RANGE
            }
        };
        let is_exact = fits || (is_native && kind == StorageKind::F32);
        let value_per_stored = if is_exact || hi <= lo {
            1.0
        } else {
            (hi - lo)
                / match kind {
                    StorageKind::U8 => 255.0,
                    StorageKind::U16 => 65535.0,
                    StorageKind::F32 => 1.0,
                }
        };
        Self { kind, value_per_stored, value_at_zero: if is_native { 0.0 } else { lo } }
    }

    /// The number that stands for a value, before it is rounded to the kind.
    pub fn stored(&self, value: f64) -> f64 {
        (value - self.value_at_zero) / self.value_per_stored
    }

    /// The value that a stored number stands for.
    pub fn value(&self, stored: f64) -> f64 {
        stored * self.value_per_stored + self.value_at_zero
    }

    /// Stored numbers of a range of voxels.
    ///
    /// # Panics
    /// If the range is not within the voxels.
    pub fn encode(&self, voxels: &Voxels, range: Range<usize>) -> StoredVoxels {
        let to_stored = |x: f64| self.stored(x);
        match (self.kind, voxels) {
            (StorageKind::U8, Voxels::U8(v)) if self.value_at_zero == 0.0 => {
                StoredVoxels::U8(v[range].to_vec())
            }
            (StorageKind::U16, Voxels::U16(v)) if self.value_at_zero == 0.0 => {
                StoredVoxels::U16(v[range].to_vec())
            }
            (StorageKind::U8, v) => StoredVoxels::U8(v.map_to_vec(range, |x| (to_stored(x) + 0.5) as u8)),
            (StorageKind::U16, v) => StoredVoxels::U16(v.map_to_vec(range, |x| (to_stored(x) + 0.5) as u16)),
            (StorageKind::F32, v) => StoredVoxels::F32(v.map_to_vec(range, |x| to_stored(x) as f32)),
        }
    }

    /// Scale and offset from a stored number to the normalised value: `v = clamp(stored · scale + offset, 0, 1)`. The
    /// window's low end is exactly 0 in f32, so that air under a ramp from 0 is clear and not almost clear.
    pub fn normalised_from_stored(&self, window: Window) -> (f64, f64) {
        let width = window.hi() - window.lo();
        let offset = (self.value_at_zero - window.lo()) / width;
        (self.value_per_stored / width, offset - ROUNDING_OF_NORMALISING * offset.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Grid;

    fn decoded(encoding: Encoding, stored: StoredVoxels) -> Vec<f64> {
        let numbers: Vec<f64> = match stored {
            StoredVoxels::U8(v) => v.into_iter().map(f64::from).collect(),
            StoredVoxels::U16(v) => v.into_iter().map(f64::from).collect(),
            StoredVoxels::F32(v) => v.into_iter().map(f64::from).collect(),
        };
        numbers.iter().map(|&stored| encoding.value(stored)).collect()
    }

    #[test]
    fn every_type_survives_its_lossless_kind() {
        let cases = [
            (Voxels::U8(vec![0, 7, 255]), StorageKind::U8),
            (Voxels::I8(vec![-128, 7, 127]), StorageKind::U8),
            (Voxels::U16(vec![3, 700, 65535]), StorageKind::U16),
            (Voxels::I16(vec![-1024, 0, 3071]), StorageKind::U16),
            (Voxels::I16(vec![-100, 0, 100]), StorageKind::U8),
            (Voxels::I32(vec![100_000, 100_001, 100_255]), StorageKind::U8),
            (Voxels::U32(vec![0, 1 << 20, 1 << 24]), StorageKind::F32),
            (Voxels::F64(vec![-1.5, 0.0, 2.25]), StorageKind::F32),
        ];
        for (voxels, expected_kind) in cases {
            let values: Vec<f64> = (0..3).map(|i| voxels.value(i)).collect();
            let volume = Volume::new(Grid::centred([3, 1, 1], [1.0; 3]).unwrap(), voxels).unwrap();
            let kind = StorageKind::lossless_for(&volume);
            assert_eq!(kind, expected_kind, "{:?}", volume.voxels());
            let encoding = Encoding::new(&volume, kind);
            let back = decoded(encoding, encoding.encode(volume.voxels(), 0..3));
            let tolerance =
                if kind == StorageKind::F32 { (volume.range().1 - volume.range().0) * 1e-7 } else { 0.0 };
            for (value, back) in values.iter().zip(&back) {
                assert!((value - back).abs() <= tolerance, "{value} {back}");
            }
        }
    }

    #[test]
    fn native_integers_narrowed_keep_their_range() {
        let voxels = Voxels::U16(vec![1000, 2000, 60_000]);
        let volume = Volume::new(Grid::centred([3, 1, 1], [1.0; 3]).unwrap(), voxels).unwrap();
        let encoding = Encoding::new(&volume, StorageKind::U8);
        let back = decoded(encoding, encoding.encode(volume.voxels(), 0..3));
        assert!((back[0] - 1000.0).abs() < 1e-9 && (back[2] - 60_000.0).abs() < 1e-9, "{back:?}");
    }

    #[test]
    fn the_windows_low_end_is_clear_in_f32() {
        for (lo, hi) in [(0.1, 1.0), (-1000.0, 3071.3), (273.15, 373.0), (1e-7, 3e-6), (-0.37, 0.0)] {
            let voxels = Voxels::F32(vec![lo as f32, hi as f32]);
            let volume = Volume::new(Grid::centred([2, 1, 1], [1.0; 3]).unwrap(), voxels).unwrap();
            let encoding = Encoding::new(&volume, StorageKind::F32);
            let (scale, offset) = encoding.normalised_from_stored(volume.full_window());
            let normalised = |value: f64| encoding.stored(value) as f32 * scale as f32 + offset as f32;
            let (lo, hi) = volume.range();
            assert!(normalised(lo) <= 0.0, "{lo} is {}", normalised(lo));
            assert!((normalised(hi) - 1.0).abs() < 1e-5, "{hi} is {}", normalised(hi));
        }
    }
}
