//! The warps that are compared.

use clap::ValueEnum;

/// How an old picture is shown from a new pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum WarpName {
    /// As it is.
    None,
    /// On a plane through the middle of the volume: turns are made up for, and the parallax of that depth.
    Quad,
    /// Each pixel at the depth of its first hit.
    Grid,
    /// Cast anew through layers of emission and absorption.
    Volumetric,
}

impl WarpName {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Quad => "quad",
            Self::Grid => "grid",
            Self::Volumetric => "volumetric",
        }
    }
}
