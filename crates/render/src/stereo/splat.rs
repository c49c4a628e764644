//! Which derived columns a segment contributes to.

use super::Quality;
use wheatstone_core::scene::Mode;
use wheatstone_core::stereo::{Epipolar, SlabRange, Slabs};

/// Which derived columns a segment contributes to, as `Splat` of the reference caster.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Splat {
    /// The nearest (SP).
    Nearest,
    /// The two around where its samples land in the mean.
    Linear,
}

impl Splat {
    /// That of the kernels of a quality.
    pub(crate) fn of(quality: Quality) -> Self {
        match quality {
            Quality::Nearest => Self::Nearest,
            Quality::Fast | Quality::Repaired => Self::Linear,
        }
    }

    /// That of pictures of a mode: values that are added up go to the nearest column.
    pub(crate) fn in_mode(self, mode: Mode) -> Self {
        if mode == Mode::XRay { Self::Nearest } else { self }
    }

    /// The slot of kernels and its file.
    pub(crate) fn file(self) -> (&'static str, &'static str) {
        let file = match self {
            Self::Nearest => "lib/splat_nearest",
            Self::Linear => "lib/splat_linear",
        };
        ("lib/splat", file)
    }

    /// Slabs whose segments contribute to the same columns.
    pub(crate) fn slabs(self, epipolar: &Epipolar) -> Slabs {
        match self {
            Self::Nearest => epipolar.slabs(),
            Self::Linear => epipolar.slabs_between_columns(),
        }
    }

    /// The slabs that segments of some are put into: a part of each is in the next one.
    pub(crate) fn reached(self, slabs: SlabRange) -> SlabRange {
        match self {
            Self::Nearest => slabs,
            Self::Linear => SlabRange { furthest: slabs.furthest.saturating_sub(1), ..slabs },
        }
    }
}
