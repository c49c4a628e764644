//! Front-to-back emission and absorption.

use super::accumulate::{Accumulate, Pixels};
use super::classify::Classify;
use super::context::Context;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::shade::shade;
use super::skip::Walk;
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
        let mut walk = Walk::along(token, ray, context.skip);
        let needs_previous = C::VALUE_OFFSET != 0.0;
        let mut previous = zero;
        if needs_previous {
            previous = context.value_at_outlined(token, ray.at(L::splat(token, C::VALUE_OFFSET - 1.0)));
        }
        let mut is_transparent = walk.is_active;
        while walk.is_active.any() {
            walk.leap(token, is_transparent, zero);
            if needs_previous && walk.has_leapt.any() {
                let skipped = context.value_at_outlined(token, ray.at(walk.index + (C::VALUE_OFFSET - 1.0)));
                samples += L::select(walk.has_leapt, one, zero);
                previous = L::select(walk.has_leapt, skipped, previous);
            }
            let value = context.value_at(token, ray.at(walk.index + C::VALUE_OFFSET));
            samples += L::select(walk.is_active, one, zero);
            let may_be_visible = walk.is_active & C::may_be_visible(context, token, value, previous);
            is_transparent = walk.is_active;
            if may_be_visible.any() {
                let position = ray.at(walk.index);
                let classified = C::classify(context, token, position, value, previous);
                let log2 = L::select(may_be_visible, classified.entry.log2, zero);
                let step_transmittance = (log2 * ray.step_length).exp2();
                is_transparent = one.le(step_transmittance);
                let lit = shade::<C, L>(context, token, ray, position, &classified);
                rgb = lit.mul_add((one - step_transmittance) * transmittance, rgb);
                transmittance *= step_transmittance;
                let is_hit = infinity.le(depth_m) & transmittance.le(hit_transmittance);
                depth_m = L::select(is_hit, ray.depth_m(walk.index), depth_m);
                walk.is_active = walk.is_active & !transmittance.le(least_transmittance);
            }
            previous = value;
            walk.advance();
        }
        Pixels { rgb, alpha: one - transmittance, depth_m, samples, map_reads: walk.map_reads }
    }
}
