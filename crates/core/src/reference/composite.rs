//! Front-to-back emission and absorption.

use super::accumulate::{Accumulate, Pixels};
use super::classify::Classify;
use super::context::Context;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::shade::shade;
use super::vector::Vec3;
use crate::cast::FIRST_HIT_ALPHA;
use glam::Vec3A;
use std::marker::PhantomData;

/// Composites what a classifier makes of the samples.
pub(super) struct Composite<C>(PhantomData<C>);

impl<C: Classify> Accumulate for Composite<C> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>) -> Pixels<L> {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let infinity = L::splat(token, f32::INFINITY);
        let hit_transmittance = L::splat(token, 1.0 - FIRST_HIT_ALPHA);
        let least_transmittance = L::splat(token, 1.0 - context.parameters.termination_alpha);

        let mut rgb = Vec3::splat(token, Vec3A::ZERO);
        let (mut transmittance, mut depth_m, mut samples) = (one, infinity, zero);
        let mut previous = context.value_at(token, ray.at(L::splat(token, -0.5)));
        let mut index = zero;
        let mut is_active = index.lt(ray.sample_count);
        while is_active.any() {
            let value = context.value_at(token, ray.at(index + C::VALUE_OFFSET));
            samples += L::select(is_active, one, zero);
            let is_visible = is_active & C::may_be_visible(context, token, value, previous);
            if is_visible.any() {
                let position = ray.at(index);
                let classified = C::classify(context, token, position, value, previous);
                let log2 = L::select(is_visible, classified.entry.log2, zero);
                let step_transmittance = (log2 * ray.step_length).exp2();
                let lit = shade::<C, L>(context, token, ray, position, &classified);
                rgb = lit.mul_add((one - step_transmittance) * transmittance, rgb);
                transmittance *= step_transmittance;
                let is_hit = infinity.le(depth_m) & transmittance.le(hit_transmittance);
                depth_m = L::select(is_hit, ray.depth_m(index), depth_m);
                is_active = is_active & !transmittance.le(least_transmittance);
            }
            previous = value;
            index = index + 1.0;
            is_active = is_active & index.lt(ray.sample_count);
        }
        Pixels { rgb, alpha: one - transmittance, depth_m, samples }
    }
}
