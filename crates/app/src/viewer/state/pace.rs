//! How time is spent.

use super::within;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};

/// What a refresh has time for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pace {
    /// Time from one refresh to the next while something is being cast, ms.
    pub(crate) refresh_ms: f64,
    /// How the newest whole picture is shown from where the eye is now.
    pub(crate) warp: WarpName,
}

/// How an old picture is shown from a new pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum WarpName {
    /// As it is.
    None,
    /// As if it were on a plane through the middle of the volume.
    Quad,
    /// By the depth of its first hits.
    Grid,
    /// Through layers of emission and absorption, which are cast with it; other modes than composites by the grid.
    Volumetric,
}

impl WarpName {
    pub(crate) const ALL: [Self; 4] = [Self::None, Self::Quad, Self::Grid, Self::Volumetric];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Quad => "quad",
            Self::Grid => "grid",
            Self::Volumetric => "volumetric",
        }
    }
}

impl Default for Pace {
    fn default() -> Self {
        Self { refresh_ms: 40.0, warp: WarpName::Grid }
    }
}

impl Pace {
    pub(super) fn check(&self) -> Result<(), String> {
        within("refresh_ms", self.refresh_ms, 1.0, 1000.0)
    }
}
