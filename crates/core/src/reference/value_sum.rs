//! Projections by the sum of the values.

use super::accumulate::{Accumulate, Pixels};
use super::context::Context;
use super::lanes::{Lanes, Mask};
use super::lut::lut_at;
use super::ray::Ray;
use super::skip::Walk;
use std::marker::PhantomData;

/// Adds the values up.
pub(super) struct ValueSum<P>(PhantomData<P>);

/// From a sum to the value that is shown.
pub(super) trait Projection {
    fn value<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, sum: L) -> L;
}

/// Mean of the values.
pub(super) struct Mean;

impl Projection for Mean {
    #[inline(always)]
    fn value<L: Lanes>(_: &Context<'_>, token: L::Token, ray: &Ray<L>, sum: L) -> L {
        sum / ray.sample_count.max(L::splat(token, 1.0))
    }
}

/// Integral of the values over the volume's longest side.
pub(super) struct XRay;

impl Projection for XRay {
    #[inline(always)]
    fn value<L: Lanes>(context: &Context<'_>, _: L::Token, ray: &Ray<L>, sum: L) -> L {
        sum * ray.step_length * context.parameters.xray_scale
    }
}

impl<P: Projection> Accumulate for ValueSum<P> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>) -> Pixels<L> {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let (mut sum, mut samples) = (zero, zero);
        let mut walk = Walk::along(token, ray, context.skip);
        while walk.is_active.any() {
            walk.leap(token, walk.is_active, zero);
            sum += L::select(walk.is_active, context.value_at(token, ray.at(walk.index)), zero);
            samples += L::select(walk.is_active, one, zero);
            walk.advance();
        }
        let value = P::value(context, token, ray, sum).min(one);
        Pixels {
            rgb: lut_at(&context.parameters.lut, token, value).rgb,
            alpha: one,
            depth_m: ray.depth_m(zero),
            samples,
            map_reads: walk.map_reads,
        }
    }
}
