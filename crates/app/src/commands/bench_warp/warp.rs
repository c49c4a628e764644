//! The warps that are compared.

use super::source::Source;
use crate::failure::Failure;
use clap::ValueEnum;
use wheatstone_core::image::Image;
use wheatstone_core::view::View;
use wheatstone_core::warp::{self, GridSettings, VolumetricSettings};

/// How an old picture is shown from a new pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum WarpName {
    /// As it is.
    None,
    /// On the plane at infinity: turns are made up for.
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

    /// A picture as another view wants it.
    pub(super) fn warp(self, source: &Source, wanted: &View) -> Result<Image, Failure> {
        let Source { view, image, layers, .. } = source;
        let warped = match (self, layers) {
            (Self::Quad, _) => warp::quad(view, image, wanted),
            (Self::Grid, _) => warp::grid(view, image, wanted, GridSettings::default()),
            (Self::Volumetric, Some(layers)) => {
                warp::volumetric(layers, view, wanted, &VolumetricSettings::default())
            }
            (Self::None | Self::Volumetric, _) => Ok(image.clone()),
        };
        warped.map_err(Failure::input)
    }
}
