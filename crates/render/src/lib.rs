//! GPU volume ray casting: `wgpu` compute passes over WGSL kernels put together from small parts.
//!
//! [`Gpu`] is the device, [`GpuVolume`] an uploaded volume, [`Renderer`] the one loop over views. Every kernel
//! has its CPU twin in `wheatstone_core::reference`.

mod anchors;
mod buffers;
mod cast_pass;
mod first_hits;
pub mod gpu;
mod gradient_map;
mod groups;
mod kernel;
mod layers;
mod layers_error;
mod leap;
mod lit_spheres;
pub mod live;
#[cfg(test)]
mod noop_device;
mod pace;
mod pacer;
mod piece;
mod pipeline;
mod readback;
mod renderer;
mod rows;
pub mod shader;
pub mod skip;
mod squares;
mod stamps;
mod stereo;
mod target;
mod tile_pass;
mod uniforms;
mod volume;
mod volume_upload;
pub mod warp;

pub use anchors::CastAnchors;
pub use gpu::{AdapterDescription, Gpu, GpuError};
pub use gradient_map::GpuGradientMap;
pub use layers_error::LayersError;
pub use leap::Leap;
pub use renderer::{Prepared, Renderer, Sources};
pub use stereo::{Form, LayerFormat, PairError, PairMethod, PairReport, Quality};
pub use target::{LAYERS, Target};
pub use volume::{GpuVolume, TexelFormat};
pub use volume_upload::{Slab, VolumeUpload};
