//! GPU volume ray casting: `wgpu` compute passes over WGSL kernels put together from small parts.
//!
//! [`Gpu`] is the device, [`GpuVolume`] an uploaded volume, [`Renderer`] the one loop over views. Every kernel
//! has its CPU twin in `wheatstone_core::reference`.

pub mod gpu;
pub mod shader;
mod cast_pass;
mod pacer;
mod renderer;
mod target;
mod uniforms;
mod volume;

pub use gpu::{AdapterDescription, Gpu, GpuError};
pub use renderer::{Prepared, Renderer};
pub use target::Target;
pub use volume::{GpuVolume, TexelFormat};
