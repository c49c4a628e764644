//! The reference ray caster: multi-threaded, on the CPU, the truth that the GPU is tested against and the
//! renderer where no GPU is.
//!
//! Each file here is the twin of the WGSL files of the same name in `wheatstone-render`'s `shaders/lib`.

mod accumulate;
mod classify;
mod gradient;
mod ray;
mod renderer;
mod shade;
mod volume;

pub use ray::sample_count;
pub use renderer::{Cast, Caster};
