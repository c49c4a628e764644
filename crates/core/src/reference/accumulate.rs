//! Accumulators: from the samples of a packet of rays to pixels.

use super::context::Context;
use super::gathered::Gathered;
use super::lanes::Lanes;
use super::ray::Ray;
use super::vector::Vec3;

/// Finished rays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixels<L> {
    /// Premultiplied colour.
    pub(super) rgb: Vec3<L>,
    pub(super) alpha: L,
    /// Depth of the first hit, metres; infinite without one.
    pub(super) depth_m: L,
    /// Depth of the first sample that is visible at all, metres; infinite without one, and of modes without first hits.
    pub(super) visible_from_m: L,
    pub(super) taken: Taken<L>,
}

/// What rays have read, for shading not counted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Taken<L> {
    /// Samples taken along the ray.
    pub(super) samples: L,
    /// Reads of the skip map along the ray.
    pub(super) map_reads: L,
}

/// A way from samples to pixels.
pub(super) trait Accumulate {
    /// Casts the rays of a packet; composites, behind what is in front of them. What becomes of rays without samples does not
    /// matter.
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, front: Gathered<L>) -> Pixels<L>;
}
