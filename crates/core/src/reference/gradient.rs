//! Gradients of the normalised value, estimated from samples around a position.

use super::context::Context;
use super::lanes::Lanes;
use super::vector::Vec3;
use crate::scene::GradientMethod;
use glam::Vec3A;

/// Gradient in metric space: change of the normalised value per voxel length, along the world's axes.
#[inline(always)]
pub(super) fn gradient_at<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> Vec3<L> {
    L::outlined(
        token,
        #[inline(always)]
        || {
            let per_voxel = match context.parameters.gradient {
                GradientMethod::CentralDifferences => central_differences(context, token, position),
                GradientMethod::Tetrahedron => tetrahedron(context, token, position),
            };
            per_voxel.transformed(&context.metric_from_voxel_gradient)
        },
    )
}

#[inline(always)]
fn central_differences<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> Vec3<L> {
    Vec3 {
        x: central_difference(context, token, position, Vec3A::X),
        y: central_difference(context, token, position, Vec3A::Y),
        z: central_difference(context, token, position, Vec3A::Z),
    }
}

#[inline(always)]
fn central_difference<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>, axis: Vec3A) -> L {
    let offset = Vec3::splat(token, axis);
    (context.value_at(token, position + offset) - context.value_at(token, position - offset)) * 0.5
}

/// DM Algorithm 1, with the missing corner of its listing: (+,−,−), (−,−,+), (−,+,−), (+,+,+).
#[inline(always)]
fn tetrahedron<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>) -> Vec3<L> {
    let a = corner(context, token, position, Vec3A::new(1.0, -1.0, -1.0));
    let b = corner(context, token, position, Vec3A::new(-1.0, -1.0, 1.0));
    let c = corner(context, token, position, Vec3A::new(-1.0, 1.0, -1.0));
    let d = corner(context, token, position, Vec3A::ONE);
    Vec3 { x: (a - b - c + d) * 0.25, y: (c - a - b + d) * 0.25, z: (b - a - c + d) * 0.25 }
}

#[inline(always)]
fn corner<L: Lanes>(context: &Context<'_>, token: L::Token, position: Vec3<L>, offset: Vec3A) -> L {
    context.value_at(token, position + Vec3::splat(token, offset))
}
