//! Warps: an old picture shown from a new pose, in passes that a frame loop encodes.
//!
//! The twins of `wheatstone_core::warp`, which says what they show. Each is a render pass over the part of the wanted picture that
//! the shown one can cover; nothing waits for the device. They write to textures of a format that is chosen once: what a display
//! takes, or half floats.

mod canvas;
mod depths;
mod flat;
mod flat_bindings;
mod flat_uniform;
mod grid_depths;
mod layers;
mod pass;
mod picture;
mod shown;
mod volumetric;
mod volumetric_uniform;

pub use canvas::Canvas;
#[cfg(test)]
pub(crate) use depths::kernel_files;
pub use depths::{DepthPass, LayerDepths};
pub use flat::Warps;
pub use grid_depths::GridDepths;
pub use picture::Picture;
pub use shown::Shown;
pub use volumetric::VolumetricWarps;
