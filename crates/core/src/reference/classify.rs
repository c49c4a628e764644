//! Classifiers: from samples to colour and opacity.

use super::gradient::gradient_at;
use super::volume::{Sampler, Stored};
use crate::cast::CastParameters;
use crate::transfer::{LutEntry, OPAQUE_LOG2};
use glam::Vec3A;

/// What all parts of a cast may read.
#[derive(Debug, Clone, Copy)]
pub(super) struct Context<'a, T> {
    pub(super) sampler: Sampler<'a, T>,
    pub(super) parameters: &'a CastParameters,
}

impl<T: Stored> Context<'_, T> {
    /// Gradient in metric space.
    pub(super) fn gradient_at(&self, position: Vec3A) -> Vec3A {
        gradient_at(&self.sampler, self.parameters.gradient, &self.parameters.texture_from_metric, position)
    }
}

/// A classified sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Classified {
    /// Colour and log2 transmittance of one voxel length.
    pub(super) entry: LutEntry,
    /// The gradient, if classifying needed it.
    pub(super) gradient: Option<Vec3A>,
}

/// A way from samples to colour and opacity.
pub(super) trait Classify: Copy + Send + Sync {
    /// Where on the ray, counted in steps from a sample's middle, the value that classifies it is taken.
    const VALUE_OFFSET: f32 = 0.0;

    /// Whether a sample may be visible, from its value and the one before it on the ray.
    fn may_be_visible<T: Stored>(context: &Context<'_, T>, value: f32, previous: f32) -> bool {
        let _ = previous;
        let (lo, hi) = context.parameters.lut.visible();
        value >= lo && value <= hi
    }

    /// Colour and opacity of a sample.
    fn classify<T: Stored>(
        context: &Context<'_, T>,
        position: Vec3A,
        value: f32,
        previous: f32,
    ) -> Classified;

    /// Log2 transmittance of one voxel length at a position, for shading rays.
    fn log2_transmittance_at<T: Stored>(context: &Context<'_, T>, position: Vec3A) -> f32 {
        let value = context.sampler.value_at(position);
        if Self::may_be_visible(context, value, value) {
            Self::classify(context, position, value, value).entry[3]
        } else {
            0.0
        }
    }
}

/// One-dimensional transfer function.
#[derive(Clone, Copy)]
pub(super) struct Value;

impl Classify for Value {
    fn classify<T: Stored>(context: &Context<'_, T>, _: Vec3A, value: f32, _: f32) -> Classified {
        Classified { entry: context.parameters.lut.at(value), gradient: None }
    }
}

/// Two-dimensional transfer function of value and gradient magnitude.
#[derive(Clone, Copy)]
pub(super) struct ValueGradient;

impl Classify for ValueGradient {
    fn classify<T: Stored>(context: &Context<'_, T>, position: Vec3A, value: f32, _: f32) -> Classified {
        let gradient = context.gradient_at(position);
        let entry = context.parameters.lut.at_2d(value, gradient.length().min(1.0));
        Classified { entry, gradient: Some(gradient) }
    }
}

/// One-dimensional transfer function integrated between the values at both ends of a step.
#[derive(Clone, Copy)]
pub(super) struct PreIntegrated;

impl Classify for PreIntegrated {
    const VALUE_OFFSET: f32 = 0.5;

    fn may_be_visible<T: Stored>(context: &Context<'_, T>, value: f32, previous: f32) -> bool {
        let (lo, hi) = context.parameters.lut.visible();
        value.max(previous) >= lo && value.min(previous) <= hi
    }

    fn classify<T: Stored>(context: &Context<'_, T>, _: Vec3A, value: f32, previous: f32) -> Classified {
        Classified { entry: context.parameters.lut.at_2d(previous, value), gradient: None }
    }
}

/// Opaque from the isovalue upwards.
#[derive(Clone, Copy)]
pub(super) struct Isovalue;

impl Classify for Isovalue {
    fn may_be_visible<T: Stored>(context: &Context<'_, T>, value: f32, _: f32) -> bool {
        value >= context.parameters.isovalue
    }

    fn classify<T: Stored>(context: &Context<'_, T>, position: Vec3A, _: f32, _: f32) -> Classified {
        let [r, g, b] = context.parameters.surface_rgb.to_array();
        Classified { entry: [r, g, b, OPAQUE_LOG2], gradient: Some(context.gradient_at(position)) }
    }

    fn log2_transmittance_at<T: Stored>(context: &Context<'_, T>, position: Vec3A) -> f32 {
        let value = context.sampler.value_at(position);
        if Self::may_be_visible(context, value, value) { OPAQUE_LOG2 } else { 0.0 }
    }
}
