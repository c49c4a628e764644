//! Depths of the grid.

use super::flat_bindings::{FlatBindings, LOADED};
use super::pass::{BLANK, build, draw};
use super::{Canvas, Shown};
use crate::gpu::{Gpu, GpuError};
use crate::pipeline::KernelFiles;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, PixelMap, WarpError};

/// How far away the surface of a picture's first hits is from a new pose.
#[derive(Debug)]
pub struct GridDepths {
    bindings: FlatBindings,
    blank: wgpu::RenderPipeline,
    depths: wgpu::RenderPipeline,
}

impl GridDepths {
    /// The format that depths are drawn in.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;

    /// Builds the pipelines.
    ///
    /// # Errors
    /// A kernel that the driver refuses, a lost device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let depths = Self::build(&gpu.device)?;
        gpu.check()?;
        Ok(depths)
    }

    fn build(device: &wgpu::Device) -> Result<Self, GpuError> {
        let bindings = FlatBindings::new(device, &LOADED);
        let depths = KernelFiles { root: "warp/grid_depth", choices: &[], entry_point: "warp_grid_depth" };
        let [blank, depths] =
            [BLANK, depths].map(|files| build(device, &bindings.layout, &files, Self::FORMAT));
        Ok(Self { bindings, blank: blank?, depths: depths? })
    }

    /// Encodes `near_m / depth_m` of what `wheatstone_core::warp::grid` shows, by the near depth of the wanted view, into a
    /// picture of its size and the format: 1 is nearest, 0 infinitely far, or nothing.
    ///
    /// # Errors
    /// Views, settings or a picture that do not go together.
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        shown: &Shown<'_>,
        wanted: &View,
        settings: GridSettings,
        into: &mut Canvas,
    ) -> Result<(), WarpError> {
        settings.check()?;
        let covered = shown.covered(wanted, 0.0..shown.reach.nearest)?;
        let map = PixelMap::between(wanted, &shown.view)?;
        let group = self.bindings.group(gpu, &map, shown, wanted, settings);
        draw(encoder, [&self.blank, &self.depths], &group, &covered, into, wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;

    #[test]
    fn the_pipelines_build_on_the_noop_device() {
        build_on_noop_device(|device| {
            GridDepths::build(device).unwrap();
        });
    }
}
