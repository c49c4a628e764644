//! What trilinear samples in each block can read.

use super::extremes::Extremes;
use super::{BlockGrid, BlockSize, NormalisedRanges, RangeCodes};
use crate::gradient_map::GradientMap;
use crate::volume::{Encoding, StorageKind, StoredVoxels, Volume, Voxels};
use rayon::prelude::*;

/// For each block the interval of the stored numbers of its voxels and of the halo, one voxel around it: no trilinear
/// sample in the block lies outside. Made once per volume.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockRanges {
    grid: BlockGrid,
    codes: RangeCodes,
    intervals: Vec<[u16; 2]>,
}

impl BlockRanges {
    /// The intervals of a volume's stored numbers.
    pub fn of_values(volume: &Volume, kind: StorageKind, block_size: BlockSize) -> Self {
        let grid = BlockGrid::new(volume.grid().dims(), block_size);
        let codes = RangeCodes::of_values(volume, kind);
        let [lo, hi] = extremes_of_values(volume.voxels(), &grid);
        // Encoding keeps the order, so that the extremes can be encoded instead of all voxels.
        let encode = |extremes: &Voxels| Encoding::new(volume, kind).encode(extremes, 0..extremes.len());
        let intervals = intervals(encode(&lo), encode(&hi), &codes);
        Self { grid, codes, intervals }
    }

    /// The intervals of a map's gradient magnitudes; the stored numbers are the map's codes.
    pub fn of_gradients(map: &GradientMap, block_size: BlockSize) -> Self {
        let grid = BlockGrid::new(map.dims(), block_size);
        let codes = RangeCodes::of_gradients(map.depth());
        let [lo, hi] = extremes_of_stored(map.codes(), &grid);
        Self { grid, codes, intervals: intervals(lo, hi, &codes) }
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// How the ends of the intervals are written.
    pub fn codes(&self) -> &RangeCodes {
        &self.codes
    }

    /// Codes of the smallest and the largest number of each block, in the order of [`BlockGrid::index`].
    pub fn intervals(&self) -> &[[u16; 2]] {
        &self.intervals
    }

    /// Bytes that the intervals take.
    pub fn byte_size(&self) -> usize {
        size_of_val(&self.intervals[..])
    }

    /// The ranges seen through a window: `scale` and `offset` of
    /// [`Encoding::normalised_from_stored`](crate::volume::Encoding::normalised_from_stored).
    pub fn normalised(&self, normalised_from_stored: (f64, f64)) -> NormalisedRanges<'_> {
        NormalisedRanges { ranges: self, normalised_from_stored }
    }
}

/// Smallest and largest voxel that each block reads.
fn extremes_of_values(voxels: &Voxels, grid: &BlockGrid) -> [Voxels; 2] {
    macro_rules! of_each_type {
        ($($variant:ident)*) => {
            match voxels {
                $(Voxels::$variant(v) => {
                    let Extremes { lo, hi } = Extremes::new(grid, v);
                    [Voxels::$variant(lo), Voxels::$variant(hi)]
                })*
            }
        };
    }
    of_each_type!(U8 I8 U16 I16 U32 I32 F32 F64)
}

/// Smallest and largest stored number that each block reads.
fn extremes_of_stored(stored: &StoredVoxels, grid: &BlockGrid) -> [StoredVoxels; 2] {
    macro_rules! of_each_kind {
        ($($variant:ident)*) => {
            match stored {
                $(StoredVoxels::$variant(v) => {
                    let Extremes { lo, hi } = Extremes::new(grid, v);
                    [StoredVoxels::$variant(lo), StoredVoxels::$variant(hi)]
                })*
            }
        };
    }
    of_each_kind!(U8 U16 F32)
}

/// Codes of the smallest and the largest numbers, which are stored alike.
fn intervals(lo: StoredVoxels, hi: StoredVoxels, codes: &RangeCodes) -> Vec<[u16; 2]> {
    match (lo, hi) {
        (StoredVoxels::U8(lo), StoredVoxels::U8(hi)) => zipped(lo, hi, |interval| interval.map(u16::from)),
        (StoredVoxels::U16(lo), StoredVoxels::U16(hi)) => zipped(lo, hi, |interval| interval),
        (StoredVoxels::F32(lo), StoredVoxels::F32(hi)) => zipped(lo, hi, |interval| codes.outward(interval)),
        _ => unreachable!("the smallest and the largest numbers are stored alike"),
    }
}

fn zipped<T: Send>(
    lo: Vec<T>,
    hi: Vec<T>,
    to_codes: impl Fn([T; 2]) -> [u16; 2] + Sync + Send,
) -> Vec<[u16; 2]> {
    lo.into_par_iter().zip(hi).map(|(lo, hi)| to_codes([lo, hi])).collect()
}
