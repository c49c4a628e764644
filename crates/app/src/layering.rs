//! How volumetric warps are made.

use crate::failure::Failure;
use clap::Args;
use serde_json::{Value, json};
use wheatstone_core::warp::{LayerThresholds, VolumetricSettings};

/// Flags of volumetric warps.
#[derive(Debug, Args)]
pub(crate) struct LayeringArgs {
    /// Opacities at which the layers of a pixel end, ascending within 0 to 1: as many as layers, 4 at most on a GPU, 8 on the CPU.
    #[arg(
        long,
        value_name = "OPACITIES",
        value_delimiter = ',',
        default_value = "0.001,0.05,0.5,1",
        allow_negative_numbers = true
    )]
    warp_thresholds: Vec<f32>,

    /// Most steps of a ray through the layers.
    #[arg(long, value_name = "N", default_value_t = 32, allow_negative_numbers = true)]
    warp_steps: u32,
}

/// What layers are kept, and how rays step through them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layering {
    /// Where layers end.
    pub(crate) thresholds: LayerThresholds,
    /// How rays step.
    pub(crate) settings: VolumetricSettings,
}

impl LayeringArgs {
    pub(crate) fn resolve(&self) -> Result<Layering, Failure> {
        let thresholds = LayerThresholds::new(&self.warp_thresholds)
            .map_err(|error| Failure::input(format!("--warp-thresholds: {error}")))?;
        let settings = VolumetricSettings { most_steps: self.warp_steps, ..VolumetricSettings::default() };
        settings.check().map_err(|error| Failure::input(format!("--warp-steps: {error}")))?;
        Ok(Layering { thresholds, settings })
    }
}

impl Layering {
    pub(crate) fn to_json(&self) -> Value {
        json!({ "thresholds": self.thresholds.opacities(), "steps": self.settings.most_steps })
    }
}
