//! Warps: an old picture shown from a new pose, in passes that a frame loop encodes.
//!
//! The twins of `wheatstone_core::warp`, which says what they show. Each is a render pass over the part of the wanted picture that
//! the shown one can cover; nothing waits for the device. They write to textures of a format that is chosen once: what a display
//! takes, or half floats.

mod pass;
mod picture;
mod pipelines;
mod shown;
mod uniform;

pub use pass::Warps;
pub use picture::Picture;
pub use shown::Shown;
