//! Which derived columns a sample contributes to.

use crate::stereo::{Epipolar, Slabs};

/// Which derived columns a sample contributes to. What several share is its extinction, so that an opaque sample stays
/// opaque; the colour of a ray's samples in a slab is the same for all, so that what these hide from the ray stays hidden.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Splat {
    /// The one nearest to its middle (SP).
    #[default]
    Nearest,
    /// The two around its middle, each by how near it is.
    Linear,
    /// Each by the part of the sample's step that is nearest to it: what a derived pixel gathers is as long as its way
    /// through the volume, and steps longer than a slab leave no pixel out.
    Step,
}

/// A part of a sample that contributes to the same columns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) slab: i32,
    /// The share of each column, from the one that the slab gives on.
    pub(super) shares: [f64; MOST_COLUMNS],
}

/// Most columns that a part of a sample contributes to.
pub(super) const MOST_COLUMNS: usize = 2;

impl Splat {
    /// Slabs whose samples contribute to the same columns.
    pub(super) fn slabs(self, epipolar: &Epipolar) -> Slabs {
        match self {
            Self::Nearest | Self::Step => epipolar.slabs(),
            Self::Linear => epipolar.slabs_between_columns(),
        }
    }

    /// Columns that a part of a sample contributes to, from the one that its slab gives on.
    pub(super) fn column_count(self) -> usize {
        match self {
            Self::Nearest | Self::Step => 1,
            Self::Linear => 2,
        }
    }

    /// The parts of a sample front to back, by the depths of its middle and of its step in metres.
    pub(super) fn parts(self, slabs: Slabs, depth_m: f64, step_depth_m: f64) -> impl Iterator<Item = Part> {
        let (start_m, end_m) = match self {
            Self::Nearest | Self::Linear => (depth_m, depth_m),
            Self::Step => (depth_m - 0.5 * step_depth_m, depth_m + 0.5 * step_depth_m),
        };
        let range = slabs.between(start_m, end_m);
        (range.furthest..=range.nearest).rev().map(move |slab| {
            let shares = match self {
                Self::Nearest => [1.0, 0.0],
                Self::Linear => {
                    let fraction = slabs.fraction(slab, depth_m);
                    [1.0 - fraction, fraction]
                }
                Self::Step => {
                    let within_m = slabs.depths_m(slab);
                    let length_m = end_m.min(within_m.end) - start_m.max(within_m.start);
                    [length_m / (end_m - start_m), 0.0]
                }
            };
            Part { slab, shares }
        })
    }
}
