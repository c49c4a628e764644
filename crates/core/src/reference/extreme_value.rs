//! Maximum and minimum intensity projection; the first of equal extremes gives the depth.

use super::accumulate::{Accumulate, Pixels};
use super::context::Context;
use super::lanes::{Lanes, Mask};
use super::lut::lut_at;
use super::ray::Ray;
use std::marker::PhantomData;

/// Keeps the best value.
pub(super) struct ExtremeValue<B>(PhantomData<B>);

/// Which of two values is kept.
pub(super) trait Better {
    /// Worse than every value.
    const WORST: f32;

    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask;
}

/// The larger value.
pub(super) struct Maximum;

impl Better for Maximum {
    const WORST: f32 = -1.0;

    #[inline(always)]
    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask {
        best.lt(value)
    }
}

/// The smaller value.
pub(super) struct Minimum;

impl Better for Minimum {
    const WORST: f32 = 2.0;

    #[inline(always)]
    fn is_better<L: Lanes>(value: L, best: L) -> L::Mask {
        value.lt(best)
    }
}

impl<B: Better> Accumulate for ExtremeValue<B> {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>) -> Pixels<L> {
        let mut best = L::splat(token, B::WORST);
        let mut index = L::splat(token, 0.0);
        let mut best_index = index;
        let mut is_active = index.lt(ray.sample_count);
        while is_active.any() {
            let value = context.value_at(token, ray.at(index));
            let is_better = is_active & B::is_better(value, best);
            best = L::select(is_better, value, best);
            best_index = L::select(is_better, index, best_index);
            index = index + 1.0;
            is_active = is_active & index.lt(ray.sample_count);
        }
        // A ray without samples has no best value, and the table has no entry for the worst.
        let value = best.max(L::splat(token, 0.0)).min(L::splat(token, 1.0));
        Pixels {
            rgb: lut_at(&context.parameters.lut, token, value).rgb,
            alpha: L::splat(token, 1.0),
            depth_m: ray.depth_m(best_index),
            samples: ray.sample_count,
        }
    }
}
