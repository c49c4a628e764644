//! Quad and grid.

use super::flat_uniform::WarpUniform;
use super::pass::{BLANK, TEXTURE, build, draw, layout};
use super::{Canvas, Shown};
use crate::gpu::{Gpu, GpuError};
use crate::groups::bind;
use wgpu::util::DeviceExt as _;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, PixelMap, WarpError};

/// Warps to pictures of a format.
#[derive(Debug)]
pub struct Warps {
    format: wgpu::TextureFormat,
    layout: wgpu::BindGroupLayout,
    blank: wgpu::RenderPipeline,
    quad: wgpu::RenderPipeline,
    grid: wgpu::RenderPipeline,
}

impl Warps {
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
        let layout = layout::<WarpUniform>(device, &[TEXTURE; 2]);
        let [blank, quad, grid] = [BLANK, ("warp/quad", "warp_quad"), ("warp/grid", "warp_grid")]
            .map(|file| build(device, &layout, file, format));
        Ok(Self { format, layout, blank: blank?, quad: quad?, grid: grid? })
    }

    /// The format of the pictures.
    pub fn format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// Encodes `wheatstone_core::warp::quad`, on a plane through the middle of what may be in the picture, into a picture of the wanted
    /// view's size and the format.
    ///
    /// # Errors
    /// Views or a picture that do not go together.
    pub fn quad(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        shown: &Shown<'_>,
        wanted: &View,
        into: &mut Canvas,
    ) -> Result<(), WarpError> {
        let map = PixelMap::between(wanted, &shown.view)?;
        let plane = map.plane_before_eye(shown.reach.middle());
        let covered = shown.covered(wanted, plane..plane)?;
        let group = self.bind(gpu, &map.onto_plane(plane), shown, wanted, GridSettings::default());
        draw(encoder, [&self.blank, &self.quad], &group, &covered, into, wanted)
    }

    /// Encodes `wheatstone_core::warp::grid` into a picture of the wanted view's size and the format.
    ///
    /// # Errors
    /// Views, settings or a picture that do not go together.
    pub fn grid(
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
        let group = self.bind(gpu, &map, shown, wanted, settings);
        draw(encoder, [&self.blank, &self.grid], &group, &covered, into, wanted)
    }

    fn bind(
        &self,
        gpu: &Gpu,
        map: &PixelMap,
        shown: &Shown<'_>,
        wanted: &View,
        settings: GridSettings,
    ) -> wgpu::BindGroup {
        let uniform = WarpUniform::new(map, shown, wanted, settings);
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("warp"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let [color, depth] = [&shown.target.color, &shown.target.depth]
            .map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&color),
            wgpu::BindingResource::TextureView(&depth),
        ];
        bind(&gpu.device, &self.layout, &resources)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;

    #[test]
    fn the_pipelines_build_on_the_noop_device() {
        build_on_noop_device(|device| {
            for format in [wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::Bgra8UnormSrgb] {
                Warps::build(device, format).unwrap();
            }
        });
    }
}
