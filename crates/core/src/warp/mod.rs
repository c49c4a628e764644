//! Warps: an old picture shown from a new pose, so that the display follows the head however long a cast takes.
//!
//! After Buchacher's thesis (VR §5.3). [`quad`] moves the picture as if all of it were infinitely far away: exact for a turn,
//! without parallax. Pictures keep premultiplied colours throughout; what was never seen stays transparent.
//!
//! This is the truth that warps on the GPU are tested against: f64, one loop over the rows of the wanted picture, no state
//! shared between rows. All geometry is in a [`PixelMap`], a matrix and a vector that a shader takes as uniforms.

mod error;
mod pixel_map;
mod quad;

pub use error::WarpError;
pub use pixel_map::{Landing, PixelMap};
pub use quad::quad;
