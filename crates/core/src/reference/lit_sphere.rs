//! Shading by lit spheres, and what gradients do to the density of samples.

use super::context::Context;
use super::lanes::Lanes;
use super::ray::Ray;
use super::vector::Vec3;
use crate::cast::FLAT_SQUARED;
use crate::lit_sphere::{LIT_SPHERE_CHANNELS, LIT_SPHERE_SIDE, LitSphere};
use crate::scene::BoundaryEnhancement;

/// A sample as it is seen: its colour, and what its density is multiplied by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shaded<L> {
    pub(super) rgb: Vec3<L>,
    pub(super) density: L,
}

/// The look of a sample: between those of the styles for low and for high values.
#[inline(always)]
pub(super) fn lit_sphere<L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    ray: &Ray<L>,
    position: Vec3<L>,
    value: L,
    rgb: Vec3<L>,
    gradient: Vec3<L>,
) -> Shaded<L> {
    let one = L::splat(token, 1.0);
    let [right, up] = facing(token, ray, position, gradient);
    let last = (LIT_SPHERE_SIDE - 1) as f32;
    let along = |n: L| ((n * 0.5 + 0.5) * last).max(L::splat(token, 0.0)).min(L::splat(token, last));
    let (x, y) = (along(right), along(up));
    let below = |at: L| at.floor().min(L::splat(token, last - 1.0));
    let (column, row) = (below(x), below(y));
    let first = row * LIT_SPHERE_SIDE as f32 + column;
    let look = |map: &LitSphere| -> [L; LIT_SPHERE_CHANNELS] {
        std::array::from_fn(|channel| {
            let at =
                |offset: usize| L::numbers(token, map.plane(channel), (first + offset as f32).to_index());
            let of_row = at(0).mix(at(1), x - column);
            of_row.mix(at(LIT_SPHERE_SIDE).mix(at(LIT_SPHERE_SIDE + 1), x - column), y - row)
        })
    };
    let maps = &context.parameters.lit_spheres;
    let (low, high) = (look(&maps[0]), look(&maps[1]));
    let [r, g, b, gloss, density] = std::array::from_fn(|channel| low[channel].mix(high[channel], value));
    let rgb = Vec3 {
        x: rgb.x.mul_add(r, gloss).min(one),
        y: rgb.y.mul_add(g, gloss).min(one),
        z: rgb.z.mul_add(b, gloss).min(one),
    };
    Shaded { rgb, density }
}

/// The normal in eye space, to the right and upwards, of the side that faces the eye; zero where the value does not change.
#[inline(always)]
fn facing<L: Lanes>(token: L::Token, ray: &Ray<L>, position: Vec3<L>, gradient: Vec3<L>) -> [L; 2] {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let squared = gradient.length_squared();
    let flat_squared = L::splat(token, FLAT_SQUARED);
    let normal = gradient * (one / squared.max(flat_squared).sqrt());
    let to_eye = ray.viewpoint_direction(token, position);
    let upwards = ray.up - to_eye * to_eye.dot(ray.up);
    let up = upwards * (one / upwards.length_squared().max(L::splat(token, f32::MIN_POSITIVE)).sqrt());
    let right = up.cross(to_eye);
    let is_flat = squared.lt(flat_squared);
    let sign = L::select(normal.dot(to_eye).lt(zero), -one, one);
    let seen = |axis: Vec3<L>| L::select(is_flat, zero, normal.dot(axis) * sign);
    [seen(right), seen(up)]
}

/// What boundary enhancement makes of a density where the value changes by a gradient.
#[inline(always)]
pub(super) fn at_boundary<L: Lanes>(
    token: L::Token,
    BoundaryEnhancement { inside, gain, exponent }: BoundaryEnhancement,
    gradient: Vec3<L>,
) -> L {
    let magnitude = gradient.length_squared().sqrt().min(L::splat(token, 1.0));
    magnitude.powi(exponent.max(1)) * gain + inside
}
