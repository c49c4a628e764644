//! Shading of visible samples.

use super::classify::{Classified, Classify};
use super::context::Context;
use super::gradient::gradient_at;
use super::lanes::{Lanes, Mask};
use super::lit_sphere::{Shaded, at_boundary, lit_sphere};
use super::ray::Ray;
use super::skip::Walk;
use super::vector::Vec3;
use crate::cast::{
    AMBIENT_RADIUS, AMBIENT_SAMPLES, DIRECTIONAL_STEPS, FLAT_SQUARED, PHONG, SHADING_STEP, SHADOW_SAMPLES,
};
use crate::scene::Shading;
use glam::Vec3A;

/// A lit sample: its display-referred colour and what its density is multiplied by.
#[inline(always)]
pub(super) fn shade<C: Classify, L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    ray: &Ray<L>,
    position: Vec3<L>,
    value: L,
    classified: &Classified<L>,
) -> Shaded<L> {
    let rgb = classified.entry.rgb;
    let gradient = || classified.gradient.unwrap_or_else(|| gradient_at(context, token, position));
    let as_dense = |rgb: Vec3<L>| Shaded { rgb, density: L::splat(token, 1.0) };
    let shaded = match context.parameters.shading {
        Shading::None => as_dense(rgb),
        Shading::Phong => {
            as_dense(phong(context, token, ray.viewpoint_direction(token, position), rgb, gradient()))
        }
        Shading::Shadow => as_dense(rgb * shadow::<C, L>(context, token, position)),
        Shading::Ambient => as_dense(rgb * ambient::<C, L>(context, token, position)),
        Shading::Directional { .. } => {
            let light = directional::<C, L>(context, token, position);
            as_dense(Vec3 { x: rgb.x * light.x, y: rgb.y * light.y, z: rgb.z * light.z })
        }
        Shading::LitSphere { .. } => {
            let gradient = gradient();
            L::outlined(
                token,
                #[inline(always)]
                || lit_sphere(context, token, ray, position, value, rgb, gradient),
            )
        }
    };
    match context.parameters.boundaries {
        None => shaded,
        Some(boundaries) => {
            let density = shaded.density * at_boundary(token, boundaries, gradient());
            Shaded { density, ..shaded }
        }
    }
}

/// Two-sided Phong. Where the value does not change there is no surface, and the light falls as if head-on.
#[inline(always)]
fn phong<L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    to_viewpoint: Vec3<L>,
    rgb: Vec3<L>,
    gradient: Vec3<L>,
) -> Vec3<L> {
    let [ambient, diffuse, specular, exponent] = PHONG;
    let one = L::splat(token, 1.0);
    let squared = gradient.length_squared();
    let flat_squared = L::splat(token, FLAT_SQUARED);
    let is_flat = squared.lt(flat_squared);
    let normal = gradient * (one / squared.max(flat_squared).sqrt());
    let to_light = context.parameters.to_light;
    let (to_light, half_way) = if to_light == Vec3A::ZERO {
        (to_viewpoint, to_viewpoint)
    } else {
        let to_light = Vec3::splat(token, to_light);
        let between = to_light + to_viewpoint;
        (to_light, between * (one / between.length_squared().max(L::splat(token, 1e-12)).sqrt()))
    };
    let facing = L::select(is_flat, one, normal.dot(to_light).abs());
    let glancing = L::select(is_flat, L::splat(token, 0.0), normal.dot(half_way).abs());
    let highlight = glancing.powi(exponent as u32) * specular;
    let matte = facing * diffuse + ambient;
    rgb.mul_add(matte, Vec3 { x: highlight, y: highlight, z: highlight })
}

/// Log2 transmittance of one voxel length, 0 outside the visible part of the volume; and whether it would be 0 without
/// that limit, too.
#[inline(always)]
fn log2_transmittance_inside<C: Classify, L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    position: Vec3<L>,
) -> (L, L::Mask) {
    L::outlined(
        token,
        #[inline(always)]
        || {
            let zero = L::splat(token, 0.0);
            let log2 = C::log2_transmittance_at(context, token, position);
            (L::select(context.is_inside(token, position), log2, zero), zero.le(log2))
        },
    )
}

/// Transmittance towards the light (SP §4.1: 24 samples).
#[inline(always)]
fn shadow<C: Classify, L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> L {
    let step = Vec3::splat(token, context.parameters.shadow_step * context.sampler.dims());
    (transmittance_along::<C, L>(context, token, position, step, SHADOW_SAMPLES) * SHADING_STEP).exp2()
}

/// Sum of the log2 transmittances of one voxel length at equal steps from a position.
///
/// Blocks without a surface are clear or opaque as the sample before them is: [`Walk`] takes the first sample in them, and
/// only from a clear one rays leap on.
#[inline(always)]
fn transmittance_along<C: Classify, L: Lanes>(
    context: &Context<'_>,
    token: L::Token,
    position: Vec3<L>,
    step: Vec3<L>,
    count: u32,
) -> L {
    let (zero, one) = (L::splat(token, 0.0), L::splat(token, 1.0));
    let blocks = context.shading_skip.filter(|_| C::EMPTY_IS_CLEAR || count > 1).map(
        #[inline(always)]
        |skip| skip.along(token, position, step),
    );
    let mut log2 = zero;
    let mut walk = Walk::new(token, one, L::splat(token, (count + 1) as f32), blocks);
    let mut may_leap = walk.is_active;
    while walk.is_active.any() {
        walk.leap(token, may_leap, zero);
        let along = step.mul_add(walk.index, position);
        let (of_sample, is_clear) = log2_transmittance_inside::<C, L>(context, token, along);
        log2 += L::select(walk.is_active, of_sample, zero);
        if !C::EMPTY_IS_CLEAR {
            may_leap = is_clear;
        }
        walk.advance();
    }
    log2
}

/// Directions from a sample to the points of a sphere that ambient occlusion looks at: the axes and the corners of a
/// cube.
const AMBIENT_DIRECTIONS: [Vec3A; AMBIENT_SAMPLES as usize] = {
    const C: f32 = 0.577_350_3;
    [
        Vec3A::X,
        Vec3A::NEG_X,
        Vec3A::Y,
        Vec3A::NEG_Y,
        Vec3A::Z,
        Vec3A::NEG_Z,
        Vec3A::new(-C, -C, -C),
        Vec3A::new(C, -C, -C),
        Vec3A::new(-C, C, -C),
        Vec3A::new(C, C, -C),
        Vec3A::new(-C, -C, C),
        Vec3A::new(C, -C, C),
        Vec3A::new(-C, C, C),
        Vec3A::new(C, C, C),
    ]
};

/// Mean transmittance to 14 points around the sample (SP §4.1).
#[inline(always)]
fn ambient<C: Classify, L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> L {
    let mut sum = L::splat(token, 0.0);
    for direction in AMBIENT_DIRECTIONS {
        let offset = Vec3::splat(token, context.voxel_from_metric * (direction * AMBIENT_RADIUS));
        let log2 = transmittance_along::<C, L>(context, token, position, offset, 1);
        sum += (log2 * AMBIENT_RADIUS).exp2();
    }
    sum * (1.0 / AMBIENT_SAMPLES as f32)
}

/// Coloured light from each direction, traced for 4 steps (SP Fig. 9), so weighted that no occlusion is white.
#[inline(always)]
fn directional<C: Classify, L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> Vec3<L> {
    let directions = &context.parameters.directions;
    if directions.is_empty() {
        return Vec3::splat(token, Vec3A::ONE);
    }
    let mut lit = Vec3::splat(token, Vec3A::ZERO);
    let mut unoccluded = Vec3A::ZERO;
    for &direction in directions {
        let step = Vec3::splat(token, context.voxel_from_metric * (direction * SHADING_STEP));
        let log2 = transmittance_along::<C, L>(context, token, position, step, DIRECTIONAL_STEPS);
        let light = Vec3::splat(token, direction.abs());
        lit = light.mul_add((log2 * SHADING_STEP).exp2(), lit);
        unoccluded += direction.abs();
    }
    let share = unoccluded.max(Vec3A::splat(1e-6)).recip();
    Vec3 { x: lit.x * share.x, y: lit.y * share.y, z: lit.z * share.z }
}
