//! The reference ray caster: multi-threaded, on the CPU, the truth that the GPU is tested against and the
//! renderer where no GPU is.
//!
//! Written once over a lane type: one f64 lane is the truth, sixteen f32 lanes are fast. Each file of a part of the cast
//! is the twin of the WGSL files of the same name in `wheatstone-render`'s `shaders/lib`.

mod accumulate;
mod aids;
mod classify;
mod composite;
mod context;
mod extreme_value;
mod first_hit;
mod gathered;
mod gradient;
mod gradient_map;
mod lanes;
mod lanes_exact;
mod lanes_wide;
mod layers;
mod lit_sphere;
mod lut;
mod magnitude;
mod oracle;
mod ray;
mod recorded;
mod renderer;
mod shade;
mod skip;
mod slabs;
mod stereo;
mod value_sum;
mod vector;
mod volume;

pub use aids::{Aids, Leap};
pub use gradient_map::HeldGradientMap;
pub use ray::sample_count;
pub use renderer::{Cast, Caster, Reads};
pub use stereo::{RayEnd, Reprojection, Splat};
