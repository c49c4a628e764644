//! How volumetric warps are made.

use crate::failure::Failure;
use clap::Args;
use serde_json::{Value, json};
use wheatstone_core::warp::{LayerThresholds, VolumetricSettings};

/// Flags of volumetric warps.
#[derive(Debug, Args)]
pub(crate) struct LayeringArgs {
    /// Opacities at which the layers of a pixel end, ascending within 0 to 1: as many as layers, 4 at most on a GPU, 8 on the CPU
    /// [default: 0.001,0.05,0.5,1].
    #[arg(long, value_name = "OPACITIES", value_delimiter = ',', allow_negative_numbers = true)]
    warp_thresholds: Vec<f32>,

    /// Most steps of a ray through the layers [default: 32].
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    warp_steps: Option<u32>,
}

/// What layers are kept, and how rays step through them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Layering {
    /// Where layers end.
    pub(crate) thresholds: LayerThresholds,
    /// How rays step.
    pub(crate) settings: VolumetricSettings,
}

impl LayeringArgs {
    /// Layers as they are by default unless flags say otherwise, which are refused if they make no sense.
    pub(crate) fn resolve(&self) -> Result<Layering, Failure> {
        let Layering { mut thresholds, mut settings } = Layering::default();
        if !self.warp_thresholds.is_empty() {
            thresholds = LayerThresholds::new(&self.warp_thresholds)
                .map_err(|error| Failure::input(format!("--warp-thresholds: {error}")))?;
        }
        if let Some(steps) = self.warp_steps {
            settings.most_steps = steps;
            settings.check().map_err(|error| Failure::input(format!("--warp-steps: {error}")))?;
        }
        Ok(Layering { thresholds, settings })
    }

    /// Whether there is any flag.
    pub(crate) fn is_given(&self) -> bool {
        !self.warp_thresholds.is_empty() || self.warp_steps.is_some()
    }
}

impl Layering {
    pub(crate) fn to_json(&self) -> Value {
        json!({ "thresholds": self.thresholds.opacities(), "steps": self.settings.most_steps })
    }
}
