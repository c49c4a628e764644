//! What a ray would read that knew what lies before it: the bound that structures are measured against.

use super::accumulate::{Accumulate, Pixels, Taken};
use super::classify::Classify;
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::skip::Walk;
use super::vector::Vec3;
use glam::Vec3A;
use std::marker::PhantomData;

/// Counts visible samples, and runs of invisible ones as reads of the map.
pub(super) struct Oracle<C>(PhantomData<C>);

impl<C: Classify> Accumulate for Oracle<C> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, _: Gathered<L>) -> Pixels<L> {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let mut walk = Walk::along(token, ray, context.skip);
        let least_transmittance = L::splat(token, 1.0 - context.parameters.termination_alpha);
        let (mut samples, mut runs, mut transmittance) = (zero, zero, one);
        let mut previous = context.value_at(token, ray.at(L::splat(token, C::VALUE_OFFSET - 1.0)));
        let mut was_visible = walk.is_active;
        while walk.is_active.any() {
            let value = context.value_at(token, ray.at(walk.index + C::VALUE_OFFSET));
            let log2 = C::classify(context, token, ray.at(walk.index), value, previous).entry.log2;
            let is_visible = log2.lt(zero);
            samples += L::select(walk.is_active & is_visible, one, zero);
            runs += L::select(walk.is_active & was_visible & !is_visible, one, zero);
            (previous, was_visible) = (value, is_visible);
            transmittance *= (log2 * ray.step_length).exp2();
            walk.is_active = walk.is_active & !transmittance.le(least_transmittance);
            walk.advance();
        }
        Pixels {
            rgb: Vec3::splat(token, Vec3A::ZERO),
            alpha: zero,
            depth_m: L::splat(token, f32::INFINITY),
            visible_from_m: L::splat(token, f32::INFINITY),
            taken: Taken { samples, map_reads: runs },
        }
    }
}
