//! Novel views of layers of emission and absorption.

use super::Canvas;
use super::Shown;
use super::depths::{LayerDepths, array_view};
use super::pass::{BLANK, TEXTURE, build, draw, layout};
use super::volumetric_uniform::LayeredWarpUniform;
use crate::gpu::{Gpu, GpuError};
use crate::groups::bind;
use crate::pipeline::KernelFiles;
use wgpu::util::DeviceExt as _;
use wheatstone_core::view::View;
use wheatstone_core::warp::{PixelMap, VolumetricSettings, WarpError};

const LAYERS: wgpu::BindingType = wgpu::BindingType::Texture {
    sample_type: wgpu::TextureSampleType::Uint,
    view_dimension: wgpu::TextureViewDimension::D2Array,
    multisampled: false,
};

/// Volumetric warps to pictures of a format.
#[derive(Debug)]
pub struct VolumetricWarps {
    layout: wgpu::BindGroupLayout,
    blank: wgpu::RenderPipeline,
    warp: wgpu::RenderPipeline,
}

impl VolumetricWarps {
    /// Builds the pipelines for pictures of a colour format that can be rendered to.
    ///
    /// # Errors
    /// A kernel or format that the driver refuses, a lost device.
    pub fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let warps = Self::build(&gpu.device, format)?;
        gpu.check()?;
        Ok(warps)
    }

    fn build(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let layout = layout::<LayeredWarpUniform>(device, &[LAYERS, TEXTURE, TEXTURE]);
        let warp = KernelFiles { root: "warp/volumetric", choices: &[], entry_point: "warp_volumetric" };
        let [blank, warp] = [BLANK, warp].map(|files| build(device, &layout, &files, format));
        Ok(Self { layout, blank: blank?, warp: warp? })
    }

    /// Encodes `wheatstone_core::warp::volumetric` of a picture whose layers have these depths, into a picture of the wanted
    /// view's size and the format.
    ///
    /// # Errors
    /// Views, settings, pictures that do not go together; a picture without layers.
    #[expect(clippy::too_many_arguments, reason = "where from, what, how, where to")]
    pub fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        shown: &Shown<'_>,
        depths: &LayerDepths,
        wanted: &View,
        settings: &VolumetricSettings,
        into: &mut Canvas,
    ) -> Result<(), WarpError> {
        settings.check()?;
        let layers = shown.target.layers.as_ref().ok_or(WarpError::NoLayers)?;
        let covered = shown.covered_by_volume(wanted)?;
        let map = PixelMap::between(wanted, &shown.view)?;
        let uniform = LayeredWarpUniform::new(&map, &shown.view, wanted, settings);
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("volumetric warp"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let layers = array_view(layers);
        let [tiles, all] = depths.views();
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&layers),
            wgpu::BindingResource::TextureView(&tiles),
            wgpu::BindingResource::TextureView(&all),
        ];
        let group = bind(&gpu.device, &self.layout, &resources);
        draw(encoder, [&self.blank, &self.warp], &group, &covered, into, wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;

    #[test]
    fn the_pipeline_builds_on_the_noop_device() {
        build_on_noop_device(|device| {
            VolumetricWarps::build(device, wgpu::TextureFormat::Rgba16Float).unwrap();
        });
    }
}
