//! Classifiers: from samples to colour and opacity.

use super::context::Context;
use super::gradient::gradient_at;
use super::lanes::{Lanes, Mask};
use super::lut::{Entry, lut_at, lut_at_2d};
use super::magnitude::{Steepness, steepness_at};
use super::vector::Vec3;
use crate::transfer::OPAQUE_LOG2;

/// A classified sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Classified<L> {
    /// Colour and log2 transmittance of one voxel length.
    pub(super) entry: Entry<L>,
    /// The gradient, if classifying needed it.
    pub(super) gradient: Option<Vec3<L>>,
}

/// A way from samples to colour and opacity.
pub(super) trait Classify {
    /// Where on the ray, counted in steps from a sample's middle, the value that classifies it is taken.
    const VALUE_OFFSET: f32 = 0.0;

    /// Whether an empty block lets all light through. Else it lets all or none through.
    const EMPTY_IS_CLEAR: bool = true;

    /// Whether a sample may be visible, from its value and the one before it on the ray.
    #[inline(always)]
    fn may_be_visible<L: Lanes>(context: &Context<'_>, token: L::Token, value: L, previous: L) -> L::Mask {
        let _ = previous;
        let (lo, hi) = context.parameters.lut.visible();
        L::splat(token, lo).le(value) & value.le(L::splat(token, hi))
    }

    /// Colour and opacity of a sample.
    fn classify<L: Lanes>(
        context: &Context<'_>,
        token: L::Token,
        position: Vec3<L>,
        value: L,
        previous: L,
    ) -> Classified<L>;

    /// Log2 transmittance of one voxel length at a position, for shading rays.
    #[inline(always)]
    fn log2_transmittance_at<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> L {
        let value = context.value_at(token, position);
        let zero = L::splat(token, 0.0);
        let is_visible = Self::may_be_visible(context, token, value, value);
        if !is_visible.any() {
            return zero;
        }
        L::select(is_visible, Self::classify(context, token, position, value, value).entry.log2, zero)
    }
}

/// One-dimensional transfer function.
pub(super) struct Value;

impl Classify for Value {
    #[inline(always)]
    fn classify<L: Lanes>(
        context: &Context<'_>,
        token: L::Token,
        _: Vec3<L>,
        value: L,
        _: L,
    ) -> Classified<L> {
        Classified { entry: lut_at(&context.parameters.lut, token, value), gradient: None }
    }
}

/// Two-dimensional transfer function of value and gradient magnitude.
pub(super) struct ValueGradient;

impl Classify for ValueGradient {
    #[inline(always)]
    fn classify<L: Lanes>(
        context: &Context<'_>,
        token: L::Token,
        position: Vec3<L>,
        value: L,
        _: L,
    ) -> Classified<L> {
        let Steepness { magnitude, gradient } = steepness_at(context, token, position);
        let entry = lut_at_2d(&context.parameters.lut, token, value, magnitude);
        Classified { entry, gradient }
    }
}

/// One-dimensional transfer function integrated between the values at both ends of a step.
pub(super) struct PreIntegrated;

impl Classify for PreIntegrated {
    const VALUE_OFFSET: f32 = 0.5;

    #[inline(always)]
    fn may_be_visible<L: Lanes>(context: &Context<'_>, token: L::Token, value: L, previous: L) -> L::Mask {
        let (lo, hi) = context.parameters.lut.visible();
        L::splat(token, lo).le(value.max(previous)) & value.min(previous).le(L::splat(token, hi))
    }

    #[inline(always)]
    fn classify<L: Lanes>(
        context: &Context<'_>,
        token: L::Token,
        _: Vec3<L>,
        value: L,
        previous: L,
    ) -> Classified<L> {
        Classified { entry: lut_at_2d(&context.parameters.lut, token, previous, value), gradient: None }
    }
}

/// Opaque from the isovalue upwards.
pub(super) struct Isovalue;

impl Classify for Isovalue {
    const EMPTY_IS_CLEAR: bool = false;

    #[inline(always)]
    fn may_be_visible<L: Lanes>(context: &Context<'_>, token: L::Token, value: L, _: L) -> L::Mask {
        L::splat(token, context.parameters.isovalue).le(value)
    }

    #[inline(always)]
    fn classify<L: Lanes>(
        context: &Context<'_>,
        token: L::Token,
        position: Vec3<L>,
        _: L,
        _: L,
    ) -> Classified<L> {
        let rgb = Vec3::splat(token, context.parameters.surface_rgb);
        Classified {
            entry: Entry { rgb, log2: L::splat(token, OPAQUE_LOG2) },
            gradient: Some(gradient_at(context, token, position)),
        }
    }

    #[inline(always)]
    fn log2_transmittance_at<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> L {
        let value = context.value_at(token, position);
        let is_in = Self::may_be_visible(context, token, value, value);
        L::select(is_in, L::splat(token, OPAQUE_LOG2), L::splat(token, 0.0))
    }
}
