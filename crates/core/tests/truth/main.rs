//! The reference ray caster against what can be known without it: closed formulas, symmetries, and pictures whose
//! content is known. Everything that later stages are compared with rests on these tests.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod analytic;
mod clipping;
mod detail;
mod first_hits;
mod gradients;
mod lanes;
mod oracle;
mod orientation;
mod properties;
mod reprojection;
mod resolution;
mod scene;
mod shading;
mod skipping;
mod stereo;
mod storage;
mod styles;
mod tolerance;
