//! Which blocks can contribute to a picture.

use super::{BlockGrid, BlockRanges, SecondAxis, Visibility};
use glam::Vec3;
use rayon::prelude::*;

/// Blocks that a thread takes at once.
const BLOCKS_PER_TASK: usize = 1 << 14;

/// Block ranges and the map from their stored numbers to normalised ones.
#[derive(Debug, Clone, Copy)]
pub struct NormalisedRanges<'a> {
    pub(super) ranges: &'a BlockRanges,
    pub(super) normalised_from_stored: (f64, f64),
}

/// Which blocks are occupied. In the others no trilinear sample can contribute: not just no voxel, but nothing in the
/// interval between the smallest and the largest voxel that samples in the block read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Occupancy {
    grid: BlockGrid,
    occupied: Vec<bool>,
}

impl Occupancy {
    /// Asks for each block whether its intervals can contribute. Without gradient ranges any gradient may occur.
    ///
    /// # Panics
    /// If values and gradients are cut into different blocks.
    pub fn new(
        values: NormalisedRanges<'_>,
        gradients: Option<NormalisedRanges<'_>>,
        visibility: &Visibility,
    ) -> Self {
        let grid = *values.ranges.grid();
        let (codes, map) = (values.ranges.codes(), values.normalised_from_stored);
        let intervals = values.ranges.intervals().par_iter().with_min_len(BLOCKS_PER_TASK);
        let occupied = match (visibility.second_axis(), gradients) {
            (SecondAxis::Gradient, Some(gradients)) => {
                assert_eq!(
                    grid,
                    *gradients.ranges.grid(),
                    "values and gradients are cut into the same blocks"
                );
                let columns = visibility.value_entries(codes, map);
                let rows =
                    visibility.gradient_entries(gradients.ranges.codes(), gradients.normalised_from_stored);
                intervals
                    .zip(gradients.ranges.intervals())
                    .map(|(&value, &gradient)| {
                        visibility.is_any_visible(spanned(&columns, value), spanned(&rows, gradient))
                    })
                    .collect()
            }
            _ => {
                let occupied_from = visibility.occupied_from(codes, map);
                intervals.map(|&[lo, hi]| u32::from(hi) >= occupied_from[usize::from(lo)]).collect()
            }
        };
        Self { grid, occupied }
    }

    /// Low and high corner of the box about all occupied blocks, texture space.
    pub fn bounds(&self) -> [Vec3; 2] {
        self.grid.bounds((0..self.occupied.len()).filter(|&block| self.occupied[block]))
    }

    /// An occupancy that is known.
    ///
    /// # Panics
    /// If there is not one flag per block.
    pub fn from_flags(grid: BlockGrid, occupied: Vec<bool>) -> Self {
        assert_eq!(occupied.len(), grid.block_count(), "one flag per block");
        Self { grid, occupied }
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// Whether each block is occupied, in the order of [`BlockGrid::index`].
    pub fn occupied(&self) -> &[bool] {
        &self.occupied
    }

    /// The occupied part of all blocks.
    pub fn fraction(&self) -> f64 {
        let count = self.occupied.iter().filter(|&&is_occupied| is_occupied).count();
        count as f64 / self.occupied.len() as f64
    }
}

/// The entries that an interval of codes falls on.
fn spanned(entries: &[[u16; 2]], [lo, hi]: [u16; 2]) -> [u16; 2] {
    [entries[usize::from(lo)][0], entries[usize::from(hi)][1]]
}
