//! Mirror of the WGSL struct of volumetric warps.

use crate::uniforms::{Columns, columns, finite, vector};
use bytemuck::{Pod, Zeroable};
use glam::DAffine3;
use wheatstone_core::view::{RayField, View};
use wheatstone_core::warp::{PixelMap, VolumetricSettings};

/// Mirror of `lib/layered_warp.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct LayeredWarpUniform {
    matrix: Columns,
    epipole: [f32; 3],
    pixel_tangent: f32,
    wanted_m: [f32; 2],
    size: [f32; 2],
    wanted_direction: [f32; 3],
    most_steps: f32,
    wanted_dx: [f32; 3],
    padding_0: u32,
    wanted_dy: [f32; 3],
    padding_1: u32,
    shown_direction: [f32; 3],
    padding_2: u32,
    shown_dx: [f32; 3],
    padding_3: u32,
    shown_dy: [f32; 3],
    padding_4: u32,
}

impl LayeredWarpUniform {
    /// From the map of wanted pixels to shown ones.
    pub(super) fn new(map: &PixelMap, shown: &View, wanted: &View, settings: &VolumetricSettings) -> Self {
        let [wanted_rays, shown_rays] = [wanted, shown].map(|view| RayField::new(view, DAffine3::IDENTITY));
        let (near_m, far_m) = wanted_rays.depth_range_m;
        Self {
            matrix: columns(map.matrix.as_mat3()),
            epipole: vector(map.epipole),
            pixel_tangent: shown_rays.direction_dx.length() as f32,
            wanted_m: [near_m, far_m].map(finite),
            size: shown.size.map(|side| side as f32),
            wanted_direction: vector(wanted_rays.direction),
            most_steps: settings.most_steps as f32,
            wanted_dx: vector(wanted_rays.direction_dx),
            wanted_dy: vector(wanted_rays.direction_dy),
            shown_direction: vector(shown_rays.direction),
            shown_dx: vector(shown_rays.direction_dx),
            shown_dy: vector(shown_rays.direction_dy),
            ..Self::zeroed()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::assert_layout;

    #[test]
    fn it_matches_wgsl() {
        assert_layout!(
            "lib/layered_warp",
            "LayeredWarp",
            LayeredWarpUniform,
            [
                matrix,
                epipole,
                pixel_tangent,
                wanted_m,
                size,
                wanted_direction,
                most_steps,
                wanted_dx,
                wanted_dy,
                shown_direction,
                shown_dx,
                shown_dy,
            ]
        );
    }
}
