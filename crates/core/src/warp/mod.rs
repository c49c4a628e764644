//! Warps: an old picture shown from a new pose, so that the display follows the head however long a cast takes.
//!
//! After Buchacher's thesis (VR §5.3). [`quad`] moves the picture as if all of it were infinitely far away: exact for a turn,
//! without parallax. [`grid`] moves each pixel by the depth of its first hit, without rubber sheets across edges of depth.
//! Pictures keep premultiplied colours throughout; what was never seen stays transparent.
//!
//! This is the truth that warps on the GPU are tested against: f64, the rows of the wanted picture in parallel, each made
//! in the same order by any number of threads. All geometry is in a [`PixelMap`], a matrix and a vector that a shader takes as
//! uniforms.

mod cells;
mod error;
mod grid;
mod pixel_map;
mod quad;
mod sheet;

pub use error::WarpError;
pub use grid::{GridSettings, grid};
pub use pixel_map::{Landing, PixelMap};
pub use quad::quad;
