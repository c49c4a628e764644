//! Front-to-back emission and absorption.

use super::accumulate::{Accumulate, Pixels, Taken};
use super::classify::Classify;
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::shade::shade;
use super::skip::Walk;
use super::vector::Vec3;
use std::marker::PhantomData;

/// Composites what a classifier makes of the samples.
pub(super) struct Composite<C>(PhantomData<C>);

impl<C: Classify> Accumulate for Composite<C> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, front: Gathered<L>) -> Pixels<L> {
        let least_transmittance = L::splat(token, 1.0 - context.parameters.termination_alpha);
        let mut gathered = front;
        let has_ended = gathered.transmittance.le(least_transmittance);
        let mut ray = *ray;
        ray.sample_count = L::select(has_ended, L::splat(token, 0.0), ray.sample_count);
        let taken = each_visible::<C, L>(
            context,
            token,
            &ray,
            #[inline(always)]
            |sample| {
                gathered.add(token, sample.rgb, sample.transmittance);
                gathered.note_hit(token, gathered.transmittance, ray.depth_m(sample.index));
                gathered.transmittance.le(least_transmittance)
            },
        );
        gathered.pixels(token, taken)
    }
}

/// A sample of each ray of a packet, lit; clear where it is not visible.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample<L> {
    /// Its number on the ray.
    pub(super) index: L,
    /// Display-referred colour.
    pub(super) rgb: Vec3<L>,
    /// Log2 of the transmittance.
    pub(super) log2: L,
    /// What passes its step.
    pub(super) transmittance: L,
}

/// Visits the samples that may be visible front to back. The visitor says which rays end with one.
#[inline(always)]
pub(super) fn each_visible<C: Classify, L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    ray: &Ray<L>,
    mut visit: impl FnMut(Sample<L>) -> L::Mask,
) -> Taken<L> {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let mut samples = zero;
    let mut walk = Walk::along(token, ray, context.skip);
    let needs_previous = C::VALUE_OFFSET != 0.0;
    let mut previous = zero;
    if needs_previous {
        previous = context.value_at_outlined(token, ray.at(ray.first_sample + (C::VALUE_OFFSET - 1.0)));
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
            let shaded = shade::<C, L>(context, token, ray, position, value, &classified);
            let log2 =
                L::select(may_be_visible, classified.entry.log2, zero) * shaded.density * ray.step_length;
            let transmittance = log2.exp2();
            is_transparent = one.le(transmittance);
            let has_ended = visit(Sample { index: walk.index, rgb: shaded.rgb, log2, transmittance });
            walk.is_active = walk.is_active & !has_ended;
        }
        previous = value;
        walk.advance();
    }
    Taken { samples, map_reads: walk.map_reads }
}
