//! First crossing of the isovalue, in either direction.

use super::accumulate::{Accumulate, Pixels, Taken};
use super::classify::{Classify, Isovalue};
use super::context::Context;
use super::gathered::Gathered;
use super::lanes::{Lanes, Mask};
use super::ray::Ray;
use super::shade::shade;
use super::skip::Walk;
use super::vector::Vec3;
use crate::cast::{BISECTIONS, SURFACE_LIFT};
use glam::Vec3A;

/// Stops at the surface.
pub(super) struct FirstHit;

impl Accumulate for FirstHit {
    #[inline(always)]
    fn cast<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, _: Gathered<L>) -> Pixels<L> {
        let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
        let isovalue = L::splat(token, context.parameters.isovalue);
        let before = L::select(zero.lt(ray.first_sample), ray.first_sample - 1.0, L::splat(token, -0.5));
        let mut was_in = isovalue.le(context.value_at_outlined(token, ray.at(before)));
        let mut samples = zero;
        let mut walk = Walk::along(token, ray, context.skip);
        let mut is_found = !walk.is_active & walk.is_active;
        while walk.is_active.any() {
            // What is leapt over is on the side that the ray was on.
            walk.leap(token, walk.is_active, zero);
            let is_in = isovalue.le(context.value_at(token, ray.at(walk.index)));
            samples += L::select(walk.is_active, one, zero);
            let has_crossed = walk.is_active & ((is_in & !was_in) | (was_in & !is_in));
            is_found = is_found | has_crossed;
            walk.is_active = walk.is_active & !has_crossed;
            // A ray that has found its surface keeps its index, and what it was before.
            was_in = (was_in & !walk.is_active) | (is_in & walk.is_active);
            walk.advance();
        }
        let miss = Pixels {
            rgb: Vec3::splat(token, Vec3A::ZERO),
            alpha: zero,
            depth_m: L::splat(token, f32::INFINITY),
            visible_from_m: L::splat(token, f32::INFINITY),
            taken: Taken { samples, map_reads: walk.map_reads },
        };
        if !is_found.any() {
            return miss;
        }
        let index = crossing(context, token, ray, walk.index, was_in);
        let position = ray.at(index);
        let classified = Isovalue::classify(context, token, position, isovalue, isovalue);
        let lifted = position + lift(context, token, classified.gradient);
        let isovalue = L::splat(token, context.parameters.isovalue);
        let rgb = shade::<Isovalue, L>(context, token, ray, lifted, isovalue, &classified).rgb;
        let depth_m = L::select(is_found, ray.depth_m(index), miss.depth_m);
        Pixels {
            rgb: Vec3::select(is_found, rgb, miss.rgb),
            alpha: L::select(is_found, one, zero),
            depth_m,
            visible_from_m: depth_m,
            ..miss
        }
    }
}

/// From a surface to where its shading rays start: a little towards lower values, so that rounding does not put half
/// of the surface into its own shadow. Voxel space.
#[inline(always)]
fn lift<L: Lanes>(context: &Context<'_>, token: L::Token, gradient: Option<Vec3<L>>) -> Vec3<L> {
    let Some(gradient) = gradient else { return Vec3::splat(token, Vec3A::ZERO) };
    let length = gradient.length_squared().max(L::splat(token, f32::MIN_POSITIVE)).sqrt();
    (gradient * (L::splat(token, -SURFACE_LIFT) / length)).transformed(&context.voxel_from_metric)
}

/// Where between sample `index` and the one before it, which was (or was not) in, the isovalue is crossed.
#[inline(always)]
fn crossing<L: Lanes>(context: &Context<'_>, token: L::Token, ray: &Ray<L>, index: L, was_in: L::Mask) -> L {
    let isovalue = L::splat(token, context.parameters.isovalue);
    let mut hi = index;
    let mut lo = (index - 1.0).max(L::splat(token, -0.5));
    for _ in 0..BISECTIONS {
        let middle = (lo + hi) * 0.5;
        let is_in = isovalue.le(context.value_at_outlined(token, ray.at(middle)));
        let is_before = (is_in & was_in) | (!is_in & !was_in);
        lo = L::select(is_before, middle, lo);
        hi = L::select(is_before, hi, middle);
    }
    (lo + hi) * 0.5
}
