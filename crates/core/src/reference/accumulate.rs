//! Accumulators: from the samples of a ray to a pixel.
//!
//! A ray is cast by `start`, `accumulate` over all its samples, and `finish`.

use super::classify::{Classify, Context, Isovalue};
use super::ray::Ray;
use super::shade::shade;
use super::volume::Stored;
use crate::cast::{BISECTIONS, FIRST_HIT_ALPHA, SURFACE_LIFT};
use glam::Vec3A;
use std::marker::PhantomData;

/// What a ray has gathered so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct RayState {
    /// Premultiplied colour.
    color: Vec3A,
    /// What still passes through.
    transmittance: f32,
    /// Depth of the first hit, metres; infinite without one.
    depth_m: f32,
    /// The value before, the best value or the sum of values: each accumulator's own.
    scalar: f32,
    /// Samples taken.
    samples: u32,
}

/// A finished ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pixel {
    /// Premultiplied RGBA.
    pub(super) color: [f32; 4],
    /// Depth of the first hit, metres; infinite without one.
    pub(super) depth_m: f32,
    /// Samples taken along the ray, those of shading not counted.
    pub(super) samples: u32,
}

impl RayState {
    /// Nothing gathered, nothing hit.
    fn new(scalar: f32) -> Self {
        Self { color: Vec3A::ZERO, transmittance: 1.0, depth_m: f32::INFINITY, scalar, samples: 0 }
    }

    /// The transfer function's colour of a projected value, opaque.
    fn projected<T: Stored>(&self, context: &Context<'_, T>, value: f32) -> Pixel {
        let [r, g, b, _] = context.parameters.lut.at(value);
        Pixel { color: [r, g, b, 1.0], depth_m: self.depth_m, samples: self.samples }
    }

    /// The gathered colour and opacity.
    fn pixel(&self) -> Pixel {
        let [r, g, b] = self.color.to_array();
        Pixel { color: [r, g, b, 1.0 - self.transmittance], depth_m: self.depth_m, samples: self.samples }
    }
}

/// A way from samples to a pixel.
pub(super) trait Accumulate {
    /// The state before the first sample.
    fn start<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> RayState;

    /// Takes the samples.
    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState);

    /// The pixel of a ray whose samples are all taken.
    fn finish<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &RayState) -> Pixel;
}

/// The value half a step before the first sample.
fn value_at_entry<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> f32 {
    context.sampler.value_at(ray.at(-0.5))
}

/// Front-to-back emission and absorption.
pub(super) struct Composite<C>(PhantomData<C>);

impl<C: Classify> Accumulate for Composite<C> {
    fn start<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> RayState {
        RayState::new(value_at_entry(context, ray))
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        let smallest_transmittance = 1.0 - context.parameters.termination_alpha;
        for i in 0..ray.sample_count {
            let position = ray.at(i as f32);
            let value = context.sampler.value_at(ray.at(i as f32 + C::VALUE_OFFSET));
            state.samples += 1;
            if C::may_be_visible(context, value, state.scalar) {
                let classified = C::classify(context, position, value, state.scalar);
                let step_transmittance = (classified.entry[3] * ray.step_length).exp2();
                if step_transmittance < 1.0 {
                    let rgb = shade::<C, T>(context, ray, position, &classified);
                    state.color += rgb * ((1.0 - step_transmittance) * state.transmittance);
                    state.transmittance *= step_transmittance;
                    if state.depth_m == f32::INFINITY && state.transmittance <= 1.0 - FIRST_HIT_ALPHA {
                        state.depth_m = ray.depth_m(i as f32);
                    }
                    if state.transmittance <= smallest_transmittance {
                        return;
                    }
                }
            }
            state.scalar = value;
        }
    }

    fn finish<T: Stored>(_: &Context<'_, T>, _: &Ray, state: &RayState) -> Pixel {
        state.pixel()
    }
}

/// Maximum intensity projection; the first of equal maxima gives the depth.
pub(super) struct Mip;

impl Accumulate for Mip {
    fn start<T: Stored>(_: &Context<'_, T>, _: &Ray) -> RayState {
        RayState::new(-1.0)
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        keep_best(context, ray, state, |value, best| value > best);
    }

    fn finish<T: Stored>(context: &Context<'_, T>, _: &Ray, state: &RayState) -> Pixel {
        state.projected(context, state.scalar)
    }
}

/// Minimum intensity projection; the first of equal minima gives the depth.
pub(super) struct MinIp;

impl Accumulate for MinIp {
    fn start<T: Stored>(_: &Context<'_, T>, _: &Ray) -> RayState {
        RayState::new(2.0)
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        keep_best(context, ray, state, |value, best| value < best);
    }

    fn finish<T: Stored>(context: &Context<'_, T>, _: &Ray, state: &RayState) -> Pixel {
        state.projected(context, state.scalar)
    }
}

fn keep_best<T: Stored>(
    context: &Context<'_, T>,
    ray: &Ray,
    state: &mut RayState,
    is_better: impl Fn(f32, f32) -> bool,
) {
    state.samples = ray.sample_count;
    let mut best_index = None;
    for i in 0..ray.sample_count {
        let value = context.sampler.value_at(ray.at(i as f32));
        if is_better(value, state.scalar) {
            state.scalar = value;
            best_index = Some(i);
        }
    }
    if let Some(index) = best_index {
        state.depth_m = ray.depth_m(index as f32);
    }
}

/// Mean of the values.
pub(super) struct Mean;

impl Accumulate for Mean {
    fn start<T: Stored>(_: &Context<'_, T>, ray: &Ray) -> RayState {
        RayState { depth_m: ray.depth_m(0.0), ..RayState::new(0.0) }
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        add_values(context, ray, state);
    }

    fn finish<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &RayState) -> Pixel {
        state.projected(context, state.scalar / ray.sample_count as f32)
    }
}

/// Integral of the values over the volume's longest side.
pub(super) struct XRay;

impl Accumulate for XRay {
    fn start<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> RayState {
        Mean::start(context, ray)
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        add_values(context, ray, state);
    }

    fn finish<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &RayState) -> Pixel {
        let integral = state.scalar * ray.step_length * context.parameters.xray_scale;
        state.projected(context, integral.min(1.0))
    }
}

fn add_values<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
    state.samples = ray.sample_count;
    for i in 0..ray.sample_count {
        state.scalar += context.sampler.value_at(ray.at(i as f32));
    }
}

/// First crossing of the isovalue, in either direction.
pub(super) struct FirstHit;

impl Accumulate for FirstHit {
    fn start<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> RayState {
        RayState::new(value_at_entry(context, ray))
    }

    fn accumulate<T: Stored>(context: &Context<'_, T>, ray: &Ray, state: &mut RayState) {
        let isovalue = context.parameters.isovalue;
        for i in 0..ray.sample_count {
            let value = context.sampler.value_at(ray.at(i as f32));
            state.samples += 1;
            if (value >= isovalue) != (state.scalar >= isovalue) {
                let index = crossing(context, ray, i, value >= isovalue);
                let position = ray.at(index);
                let classified = Isovalue::classify(context, position, isovalue, isovalue);
                let lifted = position + lift(context, classified.gradient);
                state.color = shade::<Isovalue, T>(context, ray, lifted, &classified);
                state.transmittance = 0.0;
                state.depth_m = ray.depth_m(index);
                return;
            }
            state.scalar = value;
        }
    }

    fn finish<T: Stored>(_: &Context<'_, T>, _: &Ray, state: &RayState) -> Pixel {
        state.pixel()
    }
}

/// From a surface to where its shading rays start: a little towards lower values, so that rounding does not put half
/// of the surface into its own shadow. Texture space.
fn lift<T: Stored>(context: &Context<'_, T>, gradient: Option<Vec3A>) -> Vec3A {
    let outward = -gradient.unwrap_or(Vec3A::ZERO).normalize_or_zero();
    context.parameters.texture_from_metric * (outward * SURFACE_LIFT)
}

/// Where between sample i, which is (or is not) in, and the one before it the isovalue is crossed.
fn crossing<T: Stored>(context: &Context<'_, T>, ray: &Ray, i: u32, is_in: bool) -> f32 {
    let mut hi = i as f32;
    let mut lo = if i == 0 { -0.5 } else { hi - 1.0 };
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (lo + hi);
        if (context.sampler.value_at(ray.at(middle)) >= context.parameters.isovalue) == is_in {
            hi = middle;
        } else {
            lo = middle;
        }
    }
    0.5 * (lo + hi)
}
