//! Shading of visible samples.

use super::classify::{Classified, Classify, Context};
use super::ray::{Ray, is_inside};
use super::volume::Stored;
use crate::cast::{
    AMBIENT_RADIUS, AMBIENT_SAMPLES, DIRECTIONAL_STEPS, FLAT_SQUARED, PHONG, SHADING_STEP, SHADOW_SAMPLES,
};
use crate::scene::Shading;
use glam::Vec3A;

/// The display-referred colour of a lit sample.
pub(super) fn shade<C: Classify, T: Stored>(
    context: &Context<'_, T>,
    ray: &Ray,
    position: Vec3A,
    classified: &Classified,
) -> Vec3A {
    let [r, g, b, _] = classified.entry;
    let rgb = Vec3A::new(r, g, b);
    match context.parameters.shading {
        Shading::None => rgb,
        Shading::Phong => phong(context, ray, position, rgb, classified.gradient),
        Shading::Shadow => rgb * shadow::<C, T>(context, position),
        Shading::Ambient => rgb * ambient::<C, T>(context, position),
        Shading::Directional { .. } => rgb * directional::<C, T>(context, position),
    }
}

/// Two-sided Phong. Where the value does not change there is no surface, and the light falls as if head-on.
fn phong<T: Stored>(
    context: &Context<'_, T>,
    ray: &Ray,
    position: Vec3A,
    rgb: Vec3A,
    gradient: Option<Vec3A>,
) -> Vec3A {
    let [ambient, diffuse, specular, exponent] = PHONG;
    let gradient = gradient.unwrap_or_else(|| context.gradient_at(position));
    if gradient.length_squared() < FLAT_SQUARED {
        return rgb * (ambient + diffuse);
    }
    let normal = gradient.normalize_or_zero();
    let to_light = context.parameters.to_light;
    let to_light = if to_light == Vec3A::ZERO { ray.to_eye } else { to_light };
    let half_way = (to_light + ray.to_eye).normalize_or_zero();
    let highlight = specular * normal.dot(half_way).abs().powf(exponent);
    rgb * (ambient + diffuse * normal.dot(to_light).abs()) + highlight
}

/// Log2 transmittance of one voxel length, 0 outside the visible part of the volume.
fn log2_transmittance_inside<C: Classify, T: Stored>(context: &Context<'_, T>, position: Vec3A) -> f32 {
    if is_inside(context.parameters, position) { C::log2_transmittance_at(context, position) } else { 0.0 }
}

/// Transmittance towards the light (SP §4.1: 24 samples).
fn shadow<C: Classify, T: Stored>(context: &Context<'_, T>, position: Vec3A) -> f32 {
    let step = context.parameters.shadow_step;
    let log2: f32 = (1..=SHADOW_SAMPLES)
        .map(|i| log2_transmittance_inside::<C, T>(context, position + step * i as f32))
        .sum();
    (log2 * SHADING_STEP).exp2()
}

/// Mean transmittance to 14 points around the sample (SP §4.1): the axes and the corners of a cube.
fn ambient<C: Classify, T: Stored>(context: &Context<'_, T>, position: Vec3A) -> f32 {
    let corner = 1.0 / 3.0_f32.sqrt();
    let axes = [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let corners = (0..8).map(|i| {
        let side = |bit: u32| if i & (1 << bit) == 0 { -corner } else { corner };
        Vec3A::new(side(0), side(1), side(2))
    });
    let transmittance = |direction: Vec3A| {
        let offset = context.parameters.texture_from_metric * (direction * AMBIENT_RADIUS);
        (log2_transmittance_inside::<C, T>(context, position + offset) * AMBIENT_RADIUS).exp2()
    };
    axes.chain(corners).map(transmittance).sum::<f32>() / AMBIENT_SAMPLES as f32
}

/// Coloured light from each direction, traced for 4 steps (SP Fig. 9), so weighted that no occlusion is white.
fn directional<C: Classify, T: Stored>(context: &Context<'_, T>, position: Vec3A) -> Vec3A {
    let directions = &context.parameters.directions;
    if directions.is_empty() {
        return Vec3A::ONE;
    }
    let (mut lit, mut unoccluded) = (Vec3A::ZERO, Vec3A::ZERO);
    for &direction in directions {
        let step = context.parameters.texture_from_metric * (direction * SHADING_STEP);
        let log2: f32 = (1..=DIRECTIONAL_STEPS)
            .map(|i| log2_transmittance_inside::<C, T>(context, position + step * i as f32))
            .sum();
        lit += direction.abs() * (log2 * SHADING_STEP).exp2();
        unoccluded += direction.abs();
    }
    lit / unoccluded.max(Vec3A::splat(1e-6))
}
