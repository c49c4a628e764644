//! What is made of a volume to cast it faster.

use super::gradient_map::HeldGradientMap;
use crate::skip::{BlockExtremes, SkipMap};

/// What a cast reads besides the voxels. By default nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Aids<'a> {
    /// The gradient magnitudes that two-dimensional transfer functions look up; without it they are estimated around each
    /// sample.
    pub gradient_map: Option<&'a HeldGradientMap>,
    /// What rays leap over: it changes no picture.
    pub leap: Leap<'a>,
}

/// What the rays of a cast leap over.
#[derive(Debug, Clone, Copy, Default)]
pub enum Leap<'a> {
    /// Nothing: every sample is taken.
    #[default]
    Nothing,
    /// Blocks that are empty by a map made for the same settings.
    EmptyBlocks(&'a SkipMap),
    /// Blocks whose values cannot better the extreme so far, for maximum and minimum intensity projections.
    IdleBlocks(&'a BlockExtremes),
}

impl<'a> From<Leap<'a>> for Aids<'a> {
    fn from(leap: Leap<'a>) -> Self {
        Self { leap, ..Self::default() }
    }
}
