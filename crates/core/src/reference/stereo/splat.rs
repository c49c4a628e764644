//! Which derived columns a sample contributes to.

use crate::stereo::{Epipolar, Slabs};

/// Which derived columns the samples of a ray in a slab contribute to. Several take the same colour, so that what is hidden from
/// the ray stays hidden, and what neighbouring rays give to one is together as opaque as each, so that what is opaque stays so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Splat {
    /// The one nearest to its middle (SP).
    #[default]
    Nearest,
    /// The two around where they are in the mean, each by how near it is: samples count by what they add to the opacity.
    Linear,
    /// Each by the part of the sample's step that is nearest to it: what a derived pixel gathers is as long as its way
    /// through the volume, and steps longer than a slab leave no pixel out.
    Step,
}

/// A part of a sample that is in one slab.
#[derive(Debug, Clone, Copy)]
pub(super) struct Part {
    pub(super) slab: i32,
    /// Of the sample's step.
    pub(super) share: f64,
}

/// Most columns that the samples of a ray in a slab contribute to.
pub(super) const MOST_COLUMNS: usize = 2;

impl Splat {
    /// Slabs whose samples contribute to the same columns.
    pub(super) fn slabs(self, epipolar: &Epipolar) -> Slabs {
        match self {
            Self::Nearest | Self::Step => epipolar.slabs(),
            Self::Linear => epipolar.slabs_between_columns(),
        }
    }

    /// Columns that samples contribute to, from the one that their slab gives on.
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
            let share = match self {
                Self::Nearest | Self::Linear => 1.0,
                Self::Step => {
                    let within_m = slabs.depths_m(slab);
                    (end_m.min(within_m.end) - start_m.max(within_m.start)) / (end_m - start_m)
                }
            };
            Part { slab, share }
        })
    }

    /// What each column takes of samples that are at a depth in the mean, from the one that their slab gives on.
    pub(super) fn shares(self, slabs: Slabs, slab: i32, depth_m: f64) -> [f64; MOST_COLUMNS] {
        match self {
            Self::Nearest | Self::Step => [1.0, 0.0],
            Self::Linear => {
                let fraction = slabs.fraction(slab, depth_m);
                [1.0 - fraction, fraction]
            }
        }
    }
}
