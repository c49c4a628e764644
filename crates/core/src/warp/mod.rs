//! Warps: an old picture shown from a new pose, so that the display follows the head however long a cast takes.
//!
//! After Buchacher's thesis (VR §5.3). [`quad`] moves the picture as if all of it were on a plane: exact for a turn, with the
//! parallax of one depth. [`grid`] moves each pixel by the depth of its first hit, without rubber sheets across edges of depth.
//! [`volumetric`] casts novel rays through the layers of emission and absorption that a cast leaves ([`EmissionAbsorption`]):
//! what is translucent keeps its depths. Pictures keep premultiplied colours throughout; what was never seen stays transparent.
//!
//! This is the truth that warps on the GPU are tested against: f64, the rows of the wanted picture in parallel, each made
//! in the same order by any number of threads. All geometry is in a [`PixelMap`], a matrix and a vector that a shader takes as
//! uniforms.

mod column;
mod depth_tiles;
mod emission_absorption;
mod error;
mod grid;
mod medium;
mod overlap;
mod pixel_map;
mod quad;
mod reach;
mod volumetric;

pub use emission_absorption::{
    DIVIDED_PX, EmissionAbsorption, Layer, LayerError, LayerThresholds, MOST_LAYERS,
};
pub use error::WarpError;
pub use grid::{GridSettings, MOST_GRID_STEPS, grid};
pub use medium::Medium;
pub use overlap::Overlap;
pub use pixel_map::{Landing, PixelMap};
pub use quad::quad;
pub use reach::Reach;
pub use volumetric::{VolumetricSettings, volumetric};
