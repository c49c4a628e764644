//! How a derived picture is made.

use super::{RayEnd, Splat};

/// How a derived picture is made of a reference eye's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Reprojection {
    /// Which columns a sample contributes to.
    pub splat: Splat,
    /// How far reference rays go.
    pub ray_end: RayEnd,
}
