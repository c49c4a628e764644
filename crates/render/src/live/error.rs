//! What can go wrong with a live picture.

use crate::gpu::GpuError;
use thiserror::Error;
use wheatstone_core::budget::BudgetError;

/// Why a picture cannot be cast live.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LiveError {
    /// The device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// Sizes that cannot be scheduled.
    #[error(transparent)]
    Budget(#[from] BudgetError),
    /// A rig has one view or more, all of the same size.
    #[error("views of sizes {0:?}: at least one, and all of the same size")]
    Views(Vec<[u32; 2]>),
}
