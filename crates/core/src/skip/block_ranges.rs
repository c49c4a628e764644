//! What trilinear samples in each block can read.

use super::extremes::extremes;
use super::{BlockGrid, BlockSize, NormalisedRanges, RangeCodes};
use crate::volume::{Encoding, StorageKind, StoredVoxels, Volume};
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
        let encoding = Encoding::new(volume, kind);
        let slice = grid.volume_dims()[0] * grid.volume_dims()[1];
        let stored = |slices: std::ops::Range<usize>| {
            encoding.encode(volume.voxels(), slices.start * slice..slices.end * slice)
        };
        let intervals = match kind {
            StorageKind::U8 => extremes(&grid, |slices| match stored(slices) {
                StoredVoxels::U8(v) => v,
                _ => Vec::new(),
            })
            .into_par_iter()
            .map(|interval: [u8; 2]| interval.map(u16::from))
            .collect(),
            StorageKind::U16 => extremes(&grid, |slices| match stored(slices) {
                StoredVoxels::U16(v) => v,
                _ => Vec::new(),
            }),
            StorageKind::F32 => extremes(&grid, |slices| match stored(slices) {
                StoredVoxels::F32(v) => v,
                _ => Vec::new(),
            })
            .into_par_iter()
            .map(|interval| codes.outward(interval))
            .collect(),
        };
        Self { grid, codes, intervals }
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
