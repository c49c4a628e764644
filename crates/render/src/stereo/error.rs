//! Why a pair of pictures is not made in one cast.

use crate::gpu::GpuError;
use crate::layers_error::LayersError;
use thiserror::Error;
use wheatstone_core::stereo::StereoError;
use wheatstone_core::warp::WarpError;

/// Why the picture of one eye cannot be derived from the cast of the other. But for [`PairError::Gpu`], two casts can make
/// the pair.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PairError {
    /// The views do not correspond row by row.
    #[error(transparent)]
    Views(#[from] StereoError),
    /// Something other than composites and X-rays.
    #[error("only composites and X-rays are derived")]
    Mode,
    /// Something other than strips, repaired.
    #[error("only strips are repaired")]
    Unrepaired,
    /// Rays of which a driver does not take one in a dispatch.
    #[error("rays of up to {samples} samples are too long for one dispatch on this device")]
    LongRays {
        /// Most samples of a ray.
        samples: u32,
    },
    /// More layers than the device holds.
    #[error(
        "{layers} layers for a stereo pair take {bytes} bytes; this device holds {most_layers} layers in {most_bytes} bytes"
    )]
    Layers {
        /// Layers needed: slabs of depth that the volume is in.
        layers: u32,
        /// Bytes of all.
        bytes: u64,
        /// Most layers.
        most_layers: u32,
        /// Most bytes.
        most_bytes: u64,
    },
    /// A volumetric warp of another quality.
    #[error("a volumetric warp has one quality, fast")]
    Warped,
    /// A cast that keeps no layers of emission and absorption.
    #[error(transparent)]
    Unlayered(LayersError),
    /// A picture that is not warped.
    #[error(transparent)]
    Warp(#[from] WarpError),
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl From<LayersError> for PairError {
    fn from(error: LayersError) -> Self {
        match error {
            LayersError::Gpu(error) => Self::Gpu(error),
            other => Self::Unlayered(other),
        }
    }
}
