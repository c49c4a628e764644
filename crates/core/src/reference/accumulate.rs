//! Accumulators: from the samples of a ray to a pixel.

use super::classify::{Classified, Classify, Context, Isovalue};
use super::ray::Ray;
use super::shade::shade;
use super::volume::Stored;
use crate::cast::FIRST_HIT_ALPHA;
use glam::Vec3A;

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

impl Pixel {
    pub(super) const EMPTY: Self = Self { color: [0.0; 4], depth_m: f32::INFINITY, samples: 0 };

    fn opaque(rgb: [f32; 3], depth_m: f32, samples: u32) -> Self {
        Self { color: [rgb[0], rgb[1], rgb[2], 1.0], depth_m, samples }
    }
}

/// Front-to-back emission and absorption.
pub(super) fn composite<C: Classify, T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    let mut color = Vec3A::ZERO;
    let mut transmittance = 1.0_f32;
    let mut depth_m = f32::INFINITY;
    let mut previous = context.sampler.value_at(ray.at(-0.5));
    let smallest_transmittance = 1.0 - context.parameters.termination_alpha;
    let mut samples = ray.sample_count;
    for i in 0..ray.sample_count {
        let position = ray.at(i as f32);
        let value = context.sampler.value_at(position);
        if C::may_be_visible(context, value, previous) {
            let classified = C::classify(context, position, value, previous);
            let step_transmittance = (classified.entry[3] * ray.step_length).exp2();
            if step_transmittance < 1.0 {
                let rgb = shade::<C, T>(context, ray, position, &classified);
                color += rgb * ((1.0 - step_transmittance) * transmittance);
                transmittance *= step_transmittance;
                if depth_m == f32::INFINITY && transmittance <= 1.0 - FIRST_HIT_ALPHA {
                    depth_m = ray.depth_m(i as f32);
                }
                if transmittance <= smallest_transmittance {
                    samples = i + 1;
                    break;
                }
            }
        }
        previous = value;
    }
    Pixel { color: [color.x, color.y, color.z, 1.0 - transmittance], depth_m, samples }
}

/// Maximum intensity projection; the first of equal maxima gives the depth.
pub(super) fn mip<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    extreme(context, ray, -1.0, |value, best| value > best)
}

/// Minimum intensity projection; the first of equal minima gives the depth.
pub(super) fn minip<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    extreme(context, ray, 2.0, |value, best| value < best)
}

fn extreme<T: Stored>(
    context: &Context<'_, T>,
    ray: &Ray,
    start: f32,
    is_better: impl Fn(f32, f32) -> bool,
) -> Pixel {
    let (mut best, mut best_index) = (start, 0);
    for i in 0..ray.sample_count {
        let value = context.sampler.value_at(ray.at(i as f32));
        if is_better(value, best) {
            (best, best_index) = (value, i);
        }
    }
    Pixel::opaque(projected_rgb(context, best), ray.depth_m(best_index as f32), ray.sample_count)
}

/// Mean of the values.
pub(super) fn mean<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    let mean = sum(context, ray) / ray.sample_count as f32;
    Pixel::opaque(projected_rgb(context, mean), ray.depth_m(0.0), ray.sample_count)
}

/// Integral of the values over the volume's longest side.
pub(super) fn xray<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    let integral = sum(context, ray) * ray.step_length * context.parameters.xray_scale;
    Pixel::opaque(projected_rgb(context, integral.min(1.0)), ray.depth_m(0.0), ray.sample_count)
}

fn sum<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> f32 {
    (0..ray.sample_count).map(|i| context.sampler.value_at(ray.at(i as f32))).sum()
}

/// The transfer function's colour of a projected value, at no gradient.
fn projected_rgb<T: Stored>(context: &Context<'_, T>, value: f32) -> [f32; 3] {
    let [r, g, b, _] = context.parameters.lut.at(value);
    [r, g, b]
}

/// Halvings of the step in which an isosurface is found: to a thousandth of a voxel length.
const BISECTIONS: u32 = 10;

/// First crossing of the isovalue, in either direction.
pub(super) fn first_hit<T: Stored>(context: &Context<'_, T>, ray: &Ray) -> Pixel {
    let isovalue = context.parameters.isovalue;
    let mut previous_is_in = context.sampler.value_at(ray.at(-0.5)) >= isovalue;
    let mut before = -0.5;
    for i in 0..ray.sample_count {
        let is_in = context.sampler.value_at(ray.at(i as f32)) >= isovalue;
        if is_in != previous_is_in {
            let (mut lo, mut hi) = (before, i as f32);
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (lo + hi);
                if (context.sampler.value_at(ray.at(middle)) >= isovalue) == is_in {
                    hi = middle;
                } else {
                    lo = middle;
                }
            }
            let index = 0.5 * (lo + hi);
            let position = ray.at(index);
            let classified: Classified = Isovalue::classify(context, position, isovalue, isovalue);
            let rgb = shade::<Isovalue, T>(context, ray, position, &classified);
            return Pixel::opaque(rgb.to_array(), ray.depth_m(index), i + 1);
        }
        previous_is_in = is_in;
        before = i as f32;
    }
    Pixel { samples: ray.sample_count, ..Pixel::EMPTY }
}
