//! Mirrors of the WGSL structs. Nothing else defines data shared with shaders; a test compares every field with
//! naga's layout.

use crate::leap::LeapUniform;
use crate::pacer::BAND_ROWS;
use crate::squares::Squares;
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat3, Vec3};
use std::ops::Range;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{BoundaryEnhancement, MAX_DIRECTIONS};
use wheatstone_core::stereo::{Epipolar, SlabRange, Slabs};
use wheatstone_core::view::{RayField, View};

/// A WGSL `mat3x3f`: columns padded to 16 bytes.
pub(crate) type Columns = [[f32; 4]; 3];

/// Mirror of `lib/cast_parameters.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct CastUniform {
    pub(crate) dims: [f32; 3],
    pub(crate) sampling_factor: f32,
    pub(crate) box_lo: [f32; 3],
    pub(crate) value_scale: f32,
    pub(crate) box_hi: [f32; 3],
    pub(crate) value_offset: f32,
    pub(crate) plane: [f32; 4],
    pub(crate) metric_from_texture: Columns,
    pub(crate) texture_from_metric: Columns,
    pub(crate) to_light: [f32; 3],
    pub(crate) termination_alpha: f32,
    pub(crate) shadow_step: [f32; 3],
    pub(crate) xray_scale: f32,
    pub(crate) surface_rgb: [f32; 3],
    pub(crate) isovalue: f32,
    pub(crate) visible: [f32; 2],
    pub(crate) lut_size: [u32; 2],
    pub(crate) blocks_per_texture: [f32; 3],
    pub(crate) skip_margin: f32,
    pub(crate) last_block: [f32; 3],
    pub(crate) octant_slices: i32,
    pub(crate) code_scale: f32,
    pub(crate) code_offset: f32,
    pub(crate) shortest_run: f32,
    pub(crate) magnitude_scale: f32,
    pub(crate) direction_count: u32,
    pub(crate) layer_count: u32,
    pub(crate) boundary_inside: f32,
    pub(crate) boundary_gain: f32,
    pub(crate) boundary_exponent: f32,
    pub(crate) padding: [u32; 3],
    pub(crate) layer_thresholds: [f32; 4],
    pub(crate) directions: [[f32; 4]; MAX_DIRECTIONS as usize],
}

/// Mirror of `lib/view.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct ViewUniform {
    pub(crate) origin: [f32; 3],
    pub(crate) near_m: f32,
    pub(crate) origin_dx: [f32; 3],
    pub(crate) far_m: f32,
    pub(crate) origin_dy: [f32; 3],
    pub(crate) width: u32,
    pub(crate) direction: [f32; 3],
    pub(crate) height: u32,
    pub(crate) direction_dx: [f32; 3],
    pub(crate) first_row: u32,
    pub(crate) direction_dy: [f32; 3],
    pub(crate) row_count: u32,
    pub(crate) first_sample: u32,
    pub(crate) sample_limit: u32,
    pub(crate) band_stride: u32,
    pub(crate) first_column: u32,
    pub(crate) viewpoint: [f32; 4],
    pub(crate) viewpoint_dx: [f32; 4],
    pub(crate) pair: PairUniform,
    pub(crate) padding: [u32; 3],
}

/// Mirror of `lib/pair.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(crate) struct PairUniform {
    pub(crate) k: f32,
    pub(crate) offset: f32,
    pub(crate) furthest: i32,
    pub(crate) nearest: i32,
    pub(crate) first_column: i32,
    pub(crate) column_count: u32,
    pub(crate) width: u32,
    pub(crate) count: u32,
    pub(crate) iteration_limit: u32,
    pub(crate) iterations_of_shading: u32,
    pub(crate) lockstep_rays: u32,
    pub(crate) is_resuming: u32,
    pub(crate) is_mirrored: u32,
}

impl PairUniform {
    /// Strips of so many columns over some sweep columns, and slabs between some planes.
    pub(crate) fn new(
        epipolar: &Epipolar,
        planes: &Slabs,
        slabs: SlabRange,
        columns: &Range<i32>,
        width: u32,
    ) -> Self {
        let column_count = columns.len() as u32;
        Self {
            k: epipolar.k() as f32,
            offset: planes.offset() as f32,
            furthest: slabs.furthest,
            nearest: slabs.nearest,
            first_column: columns.start,
            column_count,
            width,
            count: column_count.div_ceil(width),
            iteration_limit: u32::MAX,
            iterations_of_shading: 0,
            lockstep_rays: 0,
            is_resuming: 0,
            is_mirrored: u32::from(epipolar.is_mirrored()),
        }
    }
}

/// An opacity that no ray reaches.
const NEVER_PASSED: f32 = 2.0;

/// Boundaries as they are.
const AS_DENSE: BoundaryEnhancement = BoundaryEnhancement { inside: 1.0, gain: 0.0, exponent: 1 };

impl CastUniform {
    /// The same for a cast that keeps layers between thresholds.
    pub(crate) fn with_layers(self, thresholds: &[f32]) -> Self {
        let mut layer_thresholds = [NEVER_PASSED; 4];
        for (slot, &threshold) in layer_thresholds.iter_mut().zip(thresholds) {
            *slot = threshold;
        }
        Self { layer_count: thresholds.len() as u32, layer_thresholds, ..self }
    }

    /// The parameters of a cast over a volume whose texels map to normalised values by `scale` and `offset`.
    pub(crate) fn new(
        parameters: &CastParameters,
        dims: [usize; 3],
        (scale, offset): (f64, f64),
        leap: &LeapUniform,
        magnitude_scale: f32,
    ) -> Self {
        let mut directions = [[0.0; 4]; MAX_DIRECTIONS as usize];
        for (slot, direction) in directions.iter_mut().zip(&parameters.directions) {
            *slot = direction.extend(0.0).to_array();
        }
        let boundaries = parameters.boundaries.unwrap_or(AS_DENSE);
        let (visible_lo, visible_hi) = parameters.lut.visible();
        Self {
            dims: dims.map(|side| side as f32),
            sampling_factor: parameters.sampling_factor,
            box_lo: parameters.box_lo.to_array(),
            value_scale: scale as f32,
            box_hi: parameters.box_hi.to_array(),
            value_offset: offset as f32,
            plane: parameters.plane.to_array(),
            metric_from_texture: columns(parameters.metric_from_texture),
            texture_from_metric: columns(parameters.texture_from_metric),
            to_light: parameters.to_light.to_array(),
            termination_alpha: parameters.termination_alpha,
            shadow_step: parameters.shadow_step.to_array(),
            xray_scale: parameters.xray_scale,
            surface_rgb: parameters.surface_rgb.to_array(),
            isovalue: parameters.isovalue,
            visible: [visible_lo, visible_hi],
            lut_size: [parameters.lut.width() as u32, parameters.lut.height() as u32],
            blocks_per_texture: leap.blocks_per_texture,
            skip_margin: leap.skip_margin,
            last_block: leap.last_block,
            octant_slices: leap.octant_slices,
            code_scale: leap.code_scale,
            code_offset: leap.code_offset,
            shortest_run: leap.shortest_run,
            magnitude_scale,
            direction_count: parameters.directions.len() as u32,
            layer_count: 0,
            boundary_inside: boundaries.inside,
            boundary_gain: boundaries.gain,
            boundary_exponent: boundaries.exponent.max(1) as f32,
            padding: [0; 3],
            layer_thresholds: [NEVER_PASSED; 4],
            directions,
        }
    }
}

impl ViewUniform {
    /// The rays of a view, some squares of the picture as one piece.
    pub(crate) fn of_squares(parameters: &CastParameters, view: &View, squares: &Squares) -> Self {
        Self {
            first_row: squares.bands.start * BAND_ROWS,
            row_count: squares.rows(view.size[1]),
            first_column: squares.columns.start * BAND_ROWS,
            ..Self::new(parameters, view)
        }
    }

    /// The rays of a view, the whole picture as one piece.
    pub(crate) fn new(parameters: &CastParameters, view: &View) -> Self {
        let rays = RayField::new(view, parameters.texture_from_world);
        let [width, height] = view.size;
        Self {
            origin: vector(rays.origin),
            near_m: finite(rays.depth_range_m.0),
            origin_dx: vector(rays.origin_dx),
            far_m: finite(rays.depth_range_m.1),
            origin_dy: vector(rays.origin_dy),
            width,
            direction: vector(rays.direction),
            height,
            direction_dx: vector(rays.direction_dx),
            first_row: 0,
            direction_dy: vector(rays.direction_dy),
            row_count: height,
            first_sample: 0,
            sample_limit: u32::MAX,
            band_stride: 1,
            first_column: 0,
            viewpoint: rays.viewpoint.as_vec4().to_array(),
            viewpoint_dx: rays.viewpoint_dx.as_vec3().extend(0.0).to_array(),
            pair: PairUniform::zeroed(),
            padding: [0; 3],
        }
    }
}

pub(crate) fn vector(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// WGSL has no infinity.
pub(crate) fn finite(depth_m: f64) -> f32 {
    depth_m.clamp(-1e30, 1e30) as f32
}

pub(crate) fn columns(m: Mat3) -> Columns {
    let padded = |column: Vec3| column.extend(0.0).to_array();
    [padded(m.x_axis), padded(m.y_axis), padded(m.z_axis)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::assert_layout;

    #[test]
    fn cast_uniform_matches_wgsl() {
        assert_layout!(
            "lib/cast_parameters",
            "CastParameters",
            CastUniform,
            [
                dims,
                sampling_factor,
                box_lo,
                value_scale,
                box_hi,
                value_offset,
                plane,
                metric_from_texture,
                texture_from_metric,
                to_light,
                termination_alpha,
                shadow_step,
                xray_scale,
                surface_rgb,
                isovalue,
                visible,
                lut_size,
                blocks_per_texture,
                skip_margin,
                last_block,
                octant_slices,
                code_scale,
                code_offset,
                shortest_run,
                magnitude_scale,
                direction_count,
                layer_count,
                boundary_inside,
                boundary_gain,
                boundary_exponent,
                layer_thresholds,
                directions,
            ]
        );
    }

    #[test]
    fn view_uniform_matches_wgsl() {
        assert_layout!(
            "lib/view",
            "View",
            ViewUniform,
            [
                origin,
                near_m,
                origin_dx,
                far_m,
                origin_dy,
                width,
                direction,
                height,
                direction_dx,
                first_row,
                direction_dy,
                row_count,
                first_sample,
                sample_limit,
                band_stride,
                first_column,
                viewpoint,
                viewpoint_dx,
                pair,
            ]
        );
    }

    #[test]
    fn pair_uniform_matches_wgsl() {
        assert_layout!(
            "lib/pair",
            "Pair",
            PairUniform,
            [
                k,
                offset,
                furthest,
                nearest,
                first_column,
                column_count,
                width,
                count,
                iteration_limit,
                iterations_of_shading,
                lockstep_rays,
                is_resuming,
                is_mirrored,
            ]
        );
    }
}
