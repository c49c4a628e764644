//! Rays through texture space: where they meet the visible part of the volume, and where they are sampled.

use super::lanes::Lanes;
use super::skip::{BlockMap, Blocks, SkipSampler};
use super::vector::Vec3;
use crate::cast::CastParameters;
use crate::view::{PixelRect, RayField, View};
use glam::DVec3;
use std::ops::Range;

/// Direction components nearer to zero than this count as this far from it, so that no division overflows.
const PARALLEL: f64 = 1e-12;

/// The part of a ray that crosses the visible part of the volume, cut into equal steps.
///
/// Sample i is at the middle of step i: `first + i · step`. With n = ⌈L · f⌉ steps over a length of L voxel
/// lengths (DM Eq. 2 measured in the smallest spacing) a homogeneous volume is integrated exactly.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PixelRay {
    /// Texture position of sample 0.
    first: DVec3,
    /// From one sample to the next, texture space.
    step: DVec3,
    /// Length of a step, voxel lengths.
    step_length: f64,
    /// Number of samples; 0 if the ray misses.
    pub(super) sample_count: u32,
    /// The first sample that is taken.
    first_sample: u32,
    /// Depth of sample 0, metres.
    first_depth_m: f64,
    /// Depth of a step, metres.
    step_depth_m: f64,
    /// From sample 0 to the viewpoint, metric space; a vector that points there if it is infinitely far away.
    to_viewpoint: DVec3,
    /// Change of that from one sample to the next.
    to_viewpoint_step: DVec3,
    /// Upwards in the picture, metric space, of any length.
    up: DVec3,
}

impl PixelRay {
    /// The ray through a picture position, in pixels from the top left; pixel (x, y) has its centre at (x + ½, y + ½).
    #[inline(always)]
    pub(super) fn new(rays: &RayField, parameters: &CastParameters, x: f64, y: f64) -> Self {
        let (origin, direction) = rays.at(x, y);
        let (near, far) = visible_interval(origin, direction, rays.depth_range_m, parameters);
        if near >= far {
            return Self::default();
        }
        let metric_from_texture = parameters.metric_from_texture.as_dmat3();
        let metric_direction = metric_from_texture * direction;
        let sample_count = samples_between(near, far, metric_direction, parameters);
        let step_depth_m = if sample_count > 0 { (far - near) / f64::from(sample_count) } else { 0.0 };
        let first_depth_m = near + 0.5 * step_depth_m;
        let (viewpoint, w) = (rays.viewpoint.truncate() + x * rays.viewpoint_dx, rays.viewpoint.w);
        Self {
            first: origin + direction * first_depth_m,
            step: direction * step_depth_m,
            step_length: step_depth_m * metric_direction.length(),
            sample_count,
            first_sample: 0,
            first_depth_m,
            step_depth_m,
            to_viewpoint: metric_from_texture * (viewpoint - w * origin)
                - metric_direction * (w * first_depth_m),
            to_viewpoint_step: metric_direction * (-w * step_depth_m),
            up: metric_from_texture * -(rays.origin_dy + rays.direction_dy),
        }
    }

    /// Without the samples before a depth, metres; a miss if those are all.
    pub(super) fn from(self, depth_m: f64) -> Self {
        let before = ((depth_m - self.first_depth_m) / self.step_depth_m).ceil() as u32;
        if before < self.sample_count { Self { first_sample: before, ..self } } else { Self::default() }
    }

    /// Without the samples behind a depth, metres.
    pub(super) fn until(self, depth_m: f64) -> Self {
        let within = ((depth_m - self.first_depth_m) / self.step_depth_m).ceil() + 1.0;
        Self { sample_count: self.sample_count.min(within as u32), ..self }
    }
}

/// The rays of a packet, in voxel space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray<L> {
    /// Position of sample 0.
    first: Vec3<L>,
    /// From one sample to the next.
    step: Vec3<L>,
    /// Length of a step, voxel lengths.
    pub(super) step_length: L,
    /// Number of samples; 0 if the ray misses.
    pub(super) sample_count: L,
    /// The first sample that is taken.
    pub(super) first_sample: L,
    /// Depth of sample 0, metres.
    first_depth_m: L,
    /// Depth of a step, metres.
    pub(super) step_depth_m: L,
    /// From sample 0 to the viewpoint, metric space; a vector that points there if it is infinitely far away.
    to_viewpoint: Vec3<L>,
    /// Change of that from one sample to the next.
    to_viewpoint_step: Vec3<L>,
    /// Upwards in the picture, metric space, of any length.
    pub(super) up: Vec3<L>,
}

impl<L: Lanes> Ray<L> {
    #[inline(always)]
    pub(super) fn new(token: L::Token, dims: DVec3, rays: &[PixelRay]) -> Self {
        let number = |of: fn(&PixelRay) -> f64| L::from_fn(token, |lane| of(&rays[lane]));
        let vector = |of: fn(&PixelRay) -> DVec3, scale: DVec3| Vec3 {
            x: L::from_fn(token, |lane| of(&rays[lane]).x * scale.x),
            y: L::from_fn(token, |lane| of(&rays[lane]).y * scale.y),
            z: L::from_fn(token, |lane| of(&rays[lane]).z * scale.z),
        };
        Self {
            first: vector(|ray| ray.first, dims),
            step: vector(|ray| ray.step, dims),
            step_length: number(|ray| ray.step_length),
            sample_count: number(|ray| f64::from(ray.sample_count)),
            first_sample: number(|ray| f64::from(ray.first_sample)),
            first_depth_m: number(|ray| ray.first_depth_m),
            step_depth_m: number(|ray| ray.step_depth_m),
            to_viewpoint: vector(|ray| ray.to_viewpoint, DVec3::ONE),
            to_viewpoint_step: vector(|ray| ray.to_viewpoint_step, DVec3::ONE),
            up: vector(|ray| ray.up, DVec3::ONE),
        }
    }

    /// Position of a sample; fractional indices lie between samples.
    #[inline(always)]
    pub(super) fn at(&self, index: L) -> Vec3<L> {
        self.step.mul_add(index, self.first)
    }

    /// Unit vector to the viewpoint from where the ray passes a position, metric space.
    #[inline(always)]
    pub(super) fn viewpoint_direction(&self, token: L::Token, position: Vec3<L>) -> Vec3<L> {
        let least = L::splat(token, f32::MIN_POSITIVE);
        let index = (position - self.first).dot(self.step) / self.step.length_squared().max(least);
        let to_viewpoint = self.to_viewpoint_step.mul_add(index, self.to_viewpoint);
        to_viewpoint * (L::splat(token, 1.0) / to_viewpoint.length_squared().max(least).sqrt())
    }

    /// Its way through the blocks of a map.
    #[inline(always)]
    pub(super) fn blocks<M: BlockMap>(&self, token: L::Token, skip: SkipSampler<M>) -> Blocks<M, L> {
        skip.along(token, self.first, self.step)
    }

    /// Depth of a sample, metres.
    #[inline(always)]
    pub(super) fn depth_m(&self, index: L) -> L {
        self.step_depth_m.mul_add(index, self.first_depth_m)
    }
}

/// Samples of the ray through a picture position, in pixels from the top left; 0 if it misses.
pub fn sample_count(rays: &RayField, parameters: &CastParameters, x: f64, y: f64) -> u32 {
    let (origin, direction) = rays.at(x, y);
    let (near, far) = visible_interval(origin, direction, rays.depth_range_m, parameters);
    samples_between(near, far, parameters.metric_from_texture.as_dmat3() * direction, parameters)
}

/// Columns and rows of the pixels whose rays may cross the visible box.
pub(super) fn pixels_of_box(view: &View, parameters: &CastParameters) -> [Range<usize>; 2] {
    let PixelRect { columns, rows } = PixelRect::around(view, parameters.visible_corners_world());
    [columns, rows].map(|range| range.start as usize..range.end as usize)
}

#[inline(always)]
fn samples_between(near: f64, far: f64, metric_direction: DVec3, parameters: &CastParameters) -> u32 {
    let length = (far - near).max(0.0) * metric_direction.length();
    (length * f64::from(parameters.sampling_factor)).ceil() as u32
}

/// Depths at which a ray enters and leaves the visible box and half-space; empty if the first is not smaller.
#[inline(always)]
fn visible_interval(
    origin: DVec3,
    direction: DVec3,
    depth_range_m: (f64, f64),
    parameters: &CastParameters,
) -> (f64, f64) {
    let away_from_zero = |d: f64| if d.abs() < PARALLEL { PARALLEL.copysign(d) } else { d };
    let inverse = DVec3::from(direction.to_array().map(away_from_zero)).recip();
    let at_lo = (parameters.box_lo.as_dvec3() - origin) * inverse;
    let at_hi = (parameters.box_hi.as_dvec3() - origin) * inverse;
    let mut near = at_lo.min(at_hi).max_element().max(depth_range_m.0);
    let mut far = at_lo.max(at_hi).min_element().min(depth_range_m.1);

    let plane = parameters.plane.as_dvec4();
    let height = plane.truncate().dot(origin) + plane.w;
    let climb = away_from_zero(plane.truncate().dot(direction));
    let crossing = -height / climb;
    if climb > 0.0 {
        near = near.max(crossing);
    } else {
        far = far.min(crossing);
    }
    (near, far)
}
