//! Mirror of the WGSL struct that warps share.

use super::Shown;
use crate::uniforms::{Columns, columns, vector};
use bytemuck::{Pod, Zeroable};
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, PixelMap};

/// Mirror of `lib/warp.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct WarpUniform {
    matrix: Columns,
    epipole: [f32; 3],
    nearest: f32,
    size: [f32; 2],
    pixel: [f32; 2],
    near_m: f32,
    tear_px: f32,
    close_px: f32,
    padding: u32,
}

impl WarpUniform {
    /// From the map of wanted pixels to shown ones.
    pub(super) fn new(map: &PixelMap, shown: &Shown<'_>, wanted: &View, settings: GridSettings) -> Self {
        Self {
            matrix: columns(map.matrix.as_mat3()),
            epipole: vector(map.epipole),
            nearest: shown.reach.nearest as f32,
            size: shown.view.size.map(|side| side as f32),
            pixel: shown.view.size.map(|side| 1.0 / side as f32),
            near_m: wanted.projection.depth_range_m().0 as f32,
            tear_px: settings.tear_px as f32,
            close_px: settings.close_px as f32,
            padding: 0,
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
            "lib/warp",
            "Warp",
            WarpUniform,
            [matrix, epipole, nearest, size, pixel, near_m, tear_px, close_px]
        );
    }
}
