//! How voxels are held for sampling: 8-bit, 16-bit or f32, with the map back to values.
//!
//! Both casters sample a [`StoredVolume`], so they interpolate the same numbers.

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

/// Voxels as stored.
#[derive(Debug, Clone)]
#[allow(missing_docs, reason = "each variant is the array of the storage kind that it names")]
pub enum StoredVoxels {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// A volume ready for sampling: `value = stored · value_per_stored + value_at_zero`.
#[derive(Debug, Clone)]
pub struct StoredVolume {
    /// Voxels along each axis.
    pub dims: [usize; 3],
    /// First axis fastest.
    pub voxels: StoredVoxels,
    /// Value of one stored unit.
    pub value_per_stored: f64,
    /// Value of a stored zero.
    pub value_at_zero: f64,
}

impl StoredVolume {
    /// Stores a volume at the given precision. Integers that fit keep their steps; the rest is scaled from the
    /// volume's range to the whole range of the kind ([0, 1] for f32).
    pub fn new(volume: &Volume, kind: StorageKind) -> Self {
        let (lo, hi) = volume.range();
        let exact = StorageKind::lossless_for(volume) <= kind && kind != StorageKind::F32;
        let full_scale = match kind {
            StorageKind::U8 => 255.0,
            StorageKind::U16 => 65535.0,
            StorageKind::F32 => 1.0,
        };
        let value_per_stored = if exact || hi <= lo { 1.0 } else { hi / full_scale - lo / full_scale };
        let dims = volume.grid().dims();
        let to_stored = |x: f64| (x - lo) / value_per_stored;
        let voxels = match (kind, volume.voxels()) {
            (StorageKind::U8, Voxels::U8(v)) => {
                return Self { dims, voxels: StoredVoxels::U8(v.clone()), value_per_stored: 1.0, value_at_zero: 0.0 };
            }
            (StorageKind::U16, Voxels::U16(v)) => {
                return Self { dims, voxels: StoredVoxels::U16(v.clone()), value_per_stored: 1.0, value_at_zero: 0.0 };
            }
            (StorageKind::U8, v) => StoredVoxels::U8(v.map_to_vec(|x| to_stored(x).round() as u8)),
            (StorageKind::U16, v) => StoredVoxels::U16(v.map_to_vec(|x| to_stored(x).round() as u16)),
            (StorageKind::F32, v) => StoredVoxels::F32(v.map_to_vec(|x| to_stored(x) as f32)),
        };
        Self { dims, voxels, value_per_stored, value_at_zero: lo }
    }

    /// Scale and offset from a stored number to the normalised value: `v = clamp(stored · scale + offset, 0, 1)`.
    pub fn normalised_from_stored(&self, window: Window) -> (f64, f64) {
        let width = window.hi() - window.lo();
        (self.value_per_stored / width, (self.value_at_zero - window.lo()) / width)
    }
}
