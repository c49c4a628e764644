//! How time is spent.

use super::within;
use crate::layering::Layering;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::time::Duration;
use wheatstone_core::warp::{LayerThresholds, VolumetricSettings};
use wheatstone_render::{LAYERS, LayersError};

/// What a refresh has time for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Pace {
    /// Time from one refresh to the next while something is being cast, ms; none is the display's.
    pub(crate) refresh_ms: Option<f64>,
    /// How the newest whole picture is shown from where the eye is now.
    pub(crate) warp: WarpName,
    /// What volumetric warps keep, and how rays step through it.
    #[serde(default)]
    pub(crate) layers: Layers,
}

/// Layers of emission and absorption.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Layers {
    /// Opacities at which they end, ascending: as many as layers.
    pub(crate) thresholds: Vec<f32>,
    /// Most steps of a ray.
    pub(crate) steps: u32,
}

impl Default for Layers {
    fn default() -> Self {
        Self::from(&Layering::default())
    }
}

impl From<&Layering> for Layers {
    fn from(Layering { thresholds, settings }: &Layering) -> Self {
        Self { thresholds: thresholds.opacities().to_vec(), steps: settings.most_steps }
    }
}

impl Layers {
    /// What the casts and the warps take.
    pub(crate) fn layering(&self) -> Result<Layering, String> {
        let thresholds = LayerThresholds::new(&self.thresholds).map_err(|error| error.to_string())?;
        if self.thresholds.len() > LAYERS as usize {
            return Err(LayersError::Count(self.thresholds.len()).to_string());
        }
        let settings = VolumetricSettings { most_steps: self.steps };
        settings.check().map_err(|error| error.to_string())?;
        Ok(Layering { thresholds, settings })
    }
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
        Self { refresh_ms: None, warp: WarpName::Grid, layers: Layers::default() }
    }
}

impl Pace {
    /// From one refresh to the next, on a display of which that is the time.
    pub(crate) fn refresh_time(&self, of_display: Duration) -> Duration {
        self.refresh_ms.map_or(of_display, |ms| Duration::from_secs_f64(ms / 1e3))
    }

    pub(super) fn check(&self) -> Result<(), String> {
        self.refresh_ms.map_or(Ok(()), |ms| within("refresh_ms", ms, 1.0, 1000.0))?;
        self.layers.layering().map(drop)
    }
}
