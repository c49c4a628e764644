//! Space leaping from the last frame (Mensmann et al., "Accelerating volume raycasting using occlusion frustums", 2008; VR §3.2).
//!
//! A cast notes where the rays of each tile of its picture saw something first ([`FirstHits`]). What was in front of that is empty,
//! and what is behind it, or was not in the picture, may not be. The rays of the next picture start where they can first meet the latter
//! ([`RayStarts`]), at samples that they would have taken anyway: the picture is the same, bit for bit, if what was taken for empty
//! is. That is not certain. What is thinner than the distance between rays and samples of the last picture may have been between them,
//! and what is missed once is missed for as long as it stays in front of what was seen.
//!
//! Only casts that have first hits take part ([`CastParameters::has_first_hits`](crate::cast::CastParameters::has_first_hits)), and only
//! if nothing but the view has changed since the last one. What is visible at all counts as seen, not only what is as opaque as a
//! first hit of [`Image::depth_m`](crate::image::Image::depth_m): what fell short of that would be lost more with every frame.

mod passage;
mod starts;
mod tiles;

pub use passage::{MARGIN_PX, MOST_TILES, Passage, SLABS};
pub use starts::RayStarts;
pub use tiles::{FirstHits, TILE, margin_m, tiles_of};
