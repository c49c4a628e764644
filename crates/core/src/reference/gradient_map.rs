//! A gradient map as the caster reads it.

use super::volume::{PaddedVoxels, Sampler};
use crate::gradient_map::GradientMap;

/// A gradient map held for casting on the CPU.
#[derive(Debug)]
pub struct HeldGradientMap {
    codes: PaddedVoxels,
    /// Gradient magnitude of the stored numbers for each code.
    magnitude_per_code: f64,
}

impl HeldGradientMap {
    /// Holds the codes of a map.
    pub fn new(map: &GradientMap) -> Self {
        let (magnitude_per_code, _) = map.normalised_from_code(1.0);
        Self { codes: PaddedVoxels::new(map.dims(), map.codes()), magnitude_per_code }
    }

    /// The magnitudes of the normalised value's gradient per voxel length, limited to 1, of values that are the stored
    /// numbers times `value_scale`.
    pub(super) fn sampler(&self, value_scale: f64) -> Sampler<'_> {
        Sampler::new(&self.codes, (self.magnitude_per_code * value_scale.abs(), 0.0))
    }
}
