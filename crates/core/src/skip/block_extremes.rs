//! The best value of each block, for projections of the best value along a ray.

use super::occupancy::NormalisedRanges;
use super::{BlockGrid, RangeCodes};
use crate::scene::Mode;
use rayon::prelude::*;

/// For each block the largest normalised value that a trilinear sample in it can have, for maximum intensity projections,
/// or the smallest, for minimum intensity projections: a ray that holds as good a value gains nothing in the block. Made once
/// per change of the window.
#[derive(Debug, Clone, PartialEq)]
pub struct BlockExtremes {
    grid: BlockGrid,
    mode: Mode,
    values: Vec<f32>,
}

impl BlockExtremes {
    /// The extremes for a mode; nothing if it projects no extreme.
    pub fn new(values: NormalisedRanges<'_>, mode: Mode) -> Option<Self> {
        let NormalisedRanges { ranges, normalised_from_stored: (scale, offset) } = values;
        let best: fn(&RangeCodes, [u16; 2]) -> f32 = match mode {
            Mode::Mip => |codes, [_, hi]| codes.highest(hi),
            Mode::MinIp => |codes, [lo, _]| codes.lowest(lo),
            Mode::Composite | Mode::Mean | Mode::XRay | Mode::Isosurface { .. } => return None,
        };
        // As the casters normalise: each step rounded to f32.
        let normalised = |stored: f32| (stored * scale as f32 + offset as f32).clamp(0.0, 1.0);
        let of_block = |&interval: &[u16; 2]| normalised(best(ranges.codes(), interval));
        Some(Self {
            grid: *ranges.grid(),
            mode,
            values: ranges.intervals().par_iter().with_min_len(1 << 14).map(of_block).collect(),
        })
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// The mode that they are for.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The extreme of each block, in the order of [`BlockGrid::index`].
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Bytes that the extremes take.
    pub fn byte_size(&self) -> usize {
        size_of_val(&self.values[..])
    }
}
