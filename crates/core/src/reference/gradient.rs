//! Gradients of the normalised value, estimated from samples around a position.

use super::volume::{Sampler, Stored};
use crate::scene::GradientMethod;
use glam::{Mat3, Vec3A};

/// Gradient in metric space: change of the normalised value per voxel length, along the world's axes.
#[inline]
pub(super) fn gradient_at<T: Stored>(
    sampler: &Sampler<'_, T>,
    method: GradientMethod,
    texture_from_metric: &Mat3,
    position: Vec3A,
) -> Vec3A {
    let per_voxel = match method {
        GradientMethod::CentralDifferences => central_differences(sampler, position),
        GradientMethod::Tetrahedron => tetrahedron(sampler, position),
    };
    texture_from_metric.transpose() * (per_voxel / sampler.texel)
}

fn central_differences<T: Stored>(sampler: &Sampler<'_, T>, position: Vec3A) -> Vec3A {
    let along = |axis: Vec3A| {
        let offset = axis * sampler.texel;
        0.5 * (sampler.value_at(position + offset) - sampler.value_at(position - offset))
    };
    Vec3A::new(along(Vec3A::X), along(Vec3A::Y), along(Vec3A::Z))
}

/// DM Algorithm 1, with the missing corner of its listing: (+,−,−), (−,−,+), (−,+,−), (+,+,+).
fn tetrahedron<T: Stored>(sampler: &Sampler<'_, T>, position: Vec3A) -> Vec3A {
    const CORNERS: [Vec3A; 4] = [
        Vec3A::new(1.0, -1.0, -1.0),
        Vec3A::new(-1.0, -1.0, 1.0),
        Vec3A::new(-1.0, 1.0, -1.0),
        Vec3A::new(1.0, 1.0, 1.0),
    ];
    let weighted = |corner: Vec3A| corner * sampler.value_at(position + corner * sampler.texel);
    0.25 * CORNERS.into_iter().map(weighted).sum::<Vec3A>()
}
