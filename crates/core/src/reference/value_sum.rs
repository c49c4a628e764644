//! Projections by the sum of the values.

use super::accumulate::{Accumulate, Pixels, Taken};
use super::context::Context;
use super::gathered::Gathered;
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
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, _: Gathered<L>) -> Pixels<L> {
        let mut sum = L::splat(token, 0.0);
        let taken = each_value(
            context,
            token,
            ray,
            #[inline(always)]
            |_, value| sum += value,
        );
        let value = P::value(context, token, ray, sum);
        pixels(context, token, value, ray.depth_m(L::splat(token, 0.0)), taken)
    }
}

/// Visits samples by index and value; the value is 0 for rays that have ended.
#[inline(always)]
pub(super) fn each_value<L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    ray: &Ray<L>,
    mut visit: impl FnMut(L, L),
) -> Taken<L> {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let mut samples = zero;
    let mut walk = Walk::along(token, ray, context.skip);
    while walk.is_active.any() {
        walk.leap(token, walk.is_active, zero);
        let value = context.value_at(token, ray.at(walk.index));
        visit(walk.index, L::select(walk.is_active, value, zero));
        samples += L::select(walk.is_active, one, zero);
        walk.advance();
    }
    Taken { samples, map_reads: walk.map_reads }
}

/// Opaque pixels of projected values, seen at a depth.
#[inline(always)]
pub(super) fn pixels<L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    value: L,
    depth_m: L,
    taken: Taken<L>,
) -> Pixels<L> {
    let one = L::splat(token, 1.0);
    Pixels {
        rgb: lut_at(&context.parameters.lut, token, value.min(one)).rgb,
        alpha: one,
        depth_m,
        visible_from_m: L::splat(token, f32::INFINITY),
        taken,
    }
}
