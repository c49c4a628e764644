//! Rays through texture space: where they meet the visible part of the volume, and where they are sampled.

use crate::cast::CastParameters;
use crate::view::RayField;
use glam::{DVec3, Vec3A};

/// Direction components nearer to zero than this count as this far from it, so that no division overflows.
const PARALLEL: f64 = 1e-12;

/// The part of a ray that crosses the visible part of the volume, cut into equal steps.
///
/// Sample i is at the middle of step i: `first + i · step`. With n = ⌈L · f⌉ steps over a length of L voxel
/// lengths (DM Eq. 2 measured in the smallest spacing) a homogeneous volume is integrated exactly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    /// Texture position of sample 0.
    pub(super) first: Vec3A,
    /// From one sample to the next, texture space.
    pub(super) step: Vec3A,
    /// Length of a step, voxel lengths.
    pub(super) step_length: f32,
    /// Number of samples; 0 if the ray misses.
    pub(super) sample_count: u32,
    /// Depth of sample 0, metres.
    pub(super) first_depth_m: f32,
    /// Depth of a step, metres.
    pub(super) step_depth_m: f32,
    /// Unit vector back to the eye, metric space.
    pub(super) to_eye: Vec3A,
}

impl Ray {
    /// The ray of a pixel; its centre is at (x + ½, y + ½).
    pub(super) fn of_pixel(rays: &RayField, parameters: &CastParameters, x: u32, y: u32) -> Self {
        let (origin, direction) = rays.at(f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (near, far) = visible_interval(origin, direction, rays.depth_range_m, parameters);
        let metric_direction = parameters.metric_from_texture.as_dmat3() * direction;
        let sample_count = samples_between(near, far, metric_direction, parameters);
        let step_depth = if sample_count > 0 { (far - near) / f64::from(sample_count) } else { 0.0 };
        let first_depth = near + 0.5 * step_depth;
        Self {
            first: (origin + direction * first_depth).as_vec3a(),
            step: (direction * step_depth).as_vec3a(),
            step_length: (step_depth * metric_direction.length()) as f32,
            sample_count,
            first_depth_m: first_depth as f32,
            step_depth_m: step_depth as f32,
            to_eye: -metric_direction.normalize_or_zero().as_vec3a(),
        }
    }

    /// Texture position of a sample; fractional indices lie between samples.
    pub(super) fn at(&self, index: f32) -> Vec3A {
        self.first + self.step * index
    }

    /// Depth of a sample, metres.
    pub(super) fn depth_m(&self, index: f32) -> f32 {
        self.first_depth_m + self.step_depth_m * index
    }
}

/// Samples of the ray through a picture position, in pixels from the top left; 0 if it misses.
pub fn sample_count(rays: &RayField, parameters: &CastParameters, x: f64, y: f64) -> u32 {
    let (origin, direction) = rays.at(x, y);
    let (near, far) = visible_interval(origin, direction, rays.depth_range_m, parameters);
    samples_between(near, far, parameters.metric_from_texture.as_dmat3() * direction, parameters)
}

fn samples_between(near: f64, far: f64, metric_direction: DVec3, parameters: &CastParameters) -> u32 {
    let length = (far - near).max(0.0) * metric_direction.length();
    (length * f64::from(parameters.sampling_factor)).ceil() as u32
}

/// Depths at which a ray enters and leaves the visible box and half-space; empty if the first is not smaller.
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

/// Whether a texture position is in the visible part of the volume.
pub(super) fn is_inside(parameters: &CastParameters, position: Vec3A) -> bool {
    position.cmpge(parameters.box_lo).all()
        && position.cmple(parameters.box_hi).all()
        && Vec3A::from_vec4(parameters.plane).dot(position) + parameters.plane.w >= 0.0
}
