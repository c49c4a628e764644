//! What all parts of a cast may read.

use super::aids::Leap;
use super::lanes::Lanes;
use super::skip::{Distances, SkipSampler};
use super::vector::Vec3;
use super::volume::Sampler;
use crate::cast::{CastParameters, Classifier, SHADING_STEP};
use crate::skip::BlockExtremes;
use glam::{Mat3, Vec3A};

/// Length of a step of a shading ray that is traced, voxel lengths, and more than rounding may make of it.
const LONGEST_SHADING_STEP: f32 = 1.001 * SHADING_STEP;

/// The volume and the settings, with what they amount to in voxel space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Context<'a> {
    pub(super) sampler: Sampler<'a>,
    /// The gradient magnitudes, if they are looked up.
    pub(super) gradient_map: Option<Sampler<'a>>,
    pub(super) parameters: &'a CastParameters,
    /// What is empty, if rays are to leap over it.
    pub(super) skip: Option<SkipSampler<Distances<'a>>>,
    /// The same for shading rays.
    pub(super) shading_skip: Option<SkipSampler<Distances<'a>>>,
    /// The best values of blocks, if rays are to leap over those that have no better one.
    pub(super) extremes: Option<&'a BlockExtremes>,
    /// Low corner of the visible box.
    box_lo: Vec3A,
    /// High corner of the visible box.
    box_hi: Vec3A,
    /// Normal of the visible half-space: `normal · p + parameters.plane.w ≥ 0`.
    plane_normal: Vec3A,
    /// Vectors in metric space to voxel space.
    pub(super) voxel_from_metric: Mat3,
    /// Gradients in voxel space to metric space.
    pub(super) metric_from_voxel_gradient: Mat3,
}

impl<'a> Context<'a> {
    pub(super) fn new(
        sampler: Sampler<'a>,
        gradient_map: Option<Sampler<'a>>,
        parameters: &'a CastParameters,
        leap: Leap<'a>,
    ) -> Self {
        let dims = sampler.dims();
        let skip_for = |step_voxels: f32| match leap {
            Leap::Nothing | Leap::IdleBlocks(_) => None,
            Leap::EmptyBlocks(map) => {
                Some(SkipSampler::over_empty_blocks(map, parameters.classifier, step_voxels))
            }
        };
        let skip = skip_for(parameters.sampling_factor.recip());
        let voxel_from_metric = Mat3::from_diagonal(dims.into()) * parameters.texture_from_metric;
        Self {
            sampler,
            gradient_map,
            parameters,
            skip,
            shading_skip: match parameters.classifier {
                Classifier::Isovalue => skip_for(LONGEST_SHADING_STEP),
                Classifier::Value | Classifier::ValueGradient | Classifier::PreIntegrated => skip,
            },
            extremes: match leap {
                Leap::IdleBlocks(extremes) => {
                    assert_eq!(extremes.mode(), parameters.mode, "the extremes are those of the mode");
                    Some(extremes)
                }
                Leap::Nothing | Leap::EmptyBlocks(_) => None,
            },
            box_lo: parameters.box_lo * dims,
            box_hi: parameters.box_hi * dims,
            plane_normal: Vec3A::from_vec4(parameters.plane) / dims,
            voxel_from_metric,
            metric_from_voxel_gradient: voxel_from_metric.transpose(),
        }
    }

    /// The normalised value at a position in voxel space.
    #[inline(always)]
    pub(super) fn value_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L {
        self.sampler.value_at(token, position)
    }

    /// The same as a function of its own, for places where it is rarely asked.
    #[inline(always)]
    pub(super) fn value_at_outlined<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L {
        L::outlined(
            token,
            #[inline(always)]
            || self.value_at(token, position),
        )
    }

    /// Whether a position is in the visible part of the volume.
    #[inline(always)]
    pub(super) fn is_inside<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L::Mask {
        let height = Vec3::splat(token, self.plane_normal).dot(position) + self.parameters.plane.w;
        Vec3::splat(token, self.box_lo).le(position)
            & position.le(Vec3::splat(token, self.box_hi))
            & L::splat(token, 0.0).le(height)
    }
}
