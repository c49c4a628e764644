//! Gradients of the normalised value, estimated from samples around a position.

use super::context::Context;
use super::lanes::Lanes;
use super::vector::Vec3;
use crate::scene::GradientMethod;

/// Gradient in metric space: change of the normalised value per voxel length, along the world's axes.
#[inline(always)]
pub(super) fn gradient_at<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> Vec3<L> {
    L::outlined(
        token,
        #[inline(always)]
        || {
            let per_voxel = match context.parameters.gradient {
                GradientMethod::CentralDifferences => {
                    context.sampler.differences_at(token, position) * L::splat(token, 0.5)
                }
                GradientMethod::Tetrahedron => tetrahedron(context.sampler.tetrahedron_at(token, position)),
            };
            per_voxel.transformed(&context.metric_from_voxel_gradient)
        },
    )
}

/// DM Algorithm 1, with the missing corner of its listing: (+,−,−), (−,−,+), (−,+,−), (+,+,+).
#[inline(always)]
fn tetrahedron<L: Lanes>([a, b, c, d]: [L; 4]) -> Vec3<L> {
    Vec3 { x: (a - b - c + d) * 0.25, y: (c - a - b + d) * 0.25, z: (b - a - c + d) * 0.25 }
}
