//! Maximum and minimum intensity projection; the first of equal extremes gives the depth.

use super::accumulate::{Accumulate, Pixels, Taken};
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::{Lanes, Mask};
use super::lut::lut_at;
use super::ray::Ray;
use super::skip::{BlockMap, Extremes, SkipSampler, Walk};
use std::marker::PhantomData;

/// Keeps the best value.
pub(super) struct ExtremeValue<B>(PhantomData<B>);

/// Which of two values is kept.
pub(super) trait Better: Copy {
    /// No value is worse; what the first sample and every skipped one have at least.
    const WORST: f32;

    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask;
}

/// The larger value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Maximum;

impl Better for Maximum {
    const WORST: f32 = 0.0;

    #[inline(always)]
    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask {
        best.lt(value)
    }
}

/// The smaller value.
#[derive(Debug, Clone, Copy)]
pub(super) struct Minimum;

impl Better for Minimum {
    const WORST: f32 = 1.0;

    #[inline(always)]
    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask {
        value.lt(best)
    }
}

impl<B: Better> Accumulate for ExtremeValue<B> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, _: Gathered<L>) -> Pixels<L> {
        match context.extremes {
            None => Self::project(context, token, ray, Walk::along(token, ray, context.skip)),
            Some(extremes) => {
                let skip = SkipSampler::<Extremes<'_, B>>::over_idle_blocks(extremes);
                Self::project(context, token, ray, Walk::along(token, ray, Some(skip)))
            }
        }
    }
}

impl<B: Better> ExtremeValue<B> {
    #[inline(always)]
    fn project<L: Lanes, M: BlockMap>(
        context: &Context<'_>,
        token: L::Token,
        ray: &Ray<L>,
        mut walk: Walk<M, L>,
    ) -> Pixels<L> {
        let one = L::splat(token, 1.0);
        let zero = L::splat(token, 0.0);
        let (mut best, mut best_index, mut samples) = (L::splat(token, B::WORST), zero, zero);
        while walk.is_active.any() {
            walk.leap(token, walk.is_active, best);
            let value = context.value_at(token, ray.at(walk.index));
            samples += L::select(walk.is_active, one, zero);
            let is_better = walk.is_active & B::is_better(value, best);
            best = L::select(is_better, value, best);
            best_index = L::select(is_better, walk.index, best_index);
            walk.advance();
        }
        Pixels {
            rgb: lut_at(&context.parameters.lut, token, best).rgb,
            alpha: one,
            depth_m: ray.depth_m(best_index),
            visible_from_m: L::splat(token, f32::INFINITY),
            taken: Taken { samples, map_reads: walk.map_reads },
        }
    }
}
