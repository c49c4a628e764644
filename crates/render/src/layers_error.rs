//! Why a cast keeps no layers.

use crate::gpu::GpuError;
use crate::target::LAYERS;
use thiserror::Error;
use wheatstone_core::warp::LayerError;

/// Why a cast on a GPU keeps no layers of emission and absorption.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LayersError {
    /// What casts have layers.
    #[error(transparent)]
    Layers(#[from] LayerError),
    /// More layers than shaders hold.
    #[error("{0} layers per pixel: a GPU keeps {LAYERS} at most")]
    Count(usize),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}
