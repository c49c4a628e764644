//! Gradient magnitudes of samples: estimated around each, or looked up in a map of the voxels' (DM §3.2).

use super::context::Context;
use super::gradient::gradient_at;
use super::lanes::Lanes;
use super::vector::Vec3;

/// How steep the normalised value is at a sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steepness<L> {
    /// Gradient magnitude in metric space, at most 1.
    pub(super) magnitude: L,
    /// The gradient, if the magnitude is that of one.
    pub(super) gradient: Option<Vec3<L>>,
}

/// How steep the normalised value is at a position.
#[inline(always)]
pub(super) fn steepness_at<L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    position: Vec3<L>,
) -> Steepness<L> {
    match &context.gradient_map {
        Some(map) => Steepness { magnitude: map.value_at(token, position), gradient: None },
        None => {
            let gradient = gradient_at(context, token, position);
            let magnitude = gradient.length_squared().sqrt().min(L::splat(token, 1.0));
            Steepness { magnitude, gradient: Some(gradient) }
        }
    }
}
