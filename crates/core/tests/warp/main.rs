//! Warps against true casts from the new pose, and against what can be known of them without one.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod grid;
mod input;
mod layers;
mod medium;
mod quad;
mod scene;
mod volumetric;
