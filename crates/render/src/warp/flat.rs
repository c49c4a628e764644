//! Quad and grid.

use super::flat_bindings::{FILTERED, FlatBindings, Interpolation, LOADED};
use super::pass::{BLANK, build, draw};
use super::{Canvas, Shown};
use crate::gpu::{Gpu, GpuError};
use crate::pipeline::KernelFiles;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, PixelMap, WarpError};

/// Warps to pictures of a format.
#[derive(Debug)]
pub struct Warps {
    format: wgpu::TextureFormat,
    bindings: FlatBindings,
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
        if !gpu.capabilities().has_f32_filtering {
            return Self::without_filtering(gpu, format);
        }
        let warps = Self::build(&gpu.device, format, &FILTERED)?;
        gpu.check()?;
        Ok(warps)
    }

    /// The same for any device, whether it interpolates 32-bit floats or not.
    ///
    /// # Errors
    /// As [`Warps::new`].
    pub fn without_filtering(gpu: &Gpu, format: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let warps = Self::build(&gpu.device, format, &LOADED)?;
        gpu.check()?;
        Ok(warps)
    }

    fn build(
        device: &wgpu::Device,
        format: wgpu::TextureFormat,
        interpolation: &Interpolation,
    ) -> Result<Self, GpuError> {
        let bindings = FlatBindings::new(device, interpolation);
        let choices = [("lib/bilinear", interpolation.bilinear)];
        let files = |root, entry_point| KernelFiles { root, choices: &choices, entry_point };
        let [blank, quad, grid] = [BLANK, files("warp/quad", "warp_quad"), files("warp/grid", "warp_grid")]
            .map(|files| build(device, &bindings.layout, &files, format));
        Ok(Self { format, bindings, blank: blank?, quad: quad?, grid: grid? })
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
        let group = self.bindings.group(gpu, &map.onto_plane(plane), shown, wanted, GridSettings::default());
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
        let group = self.bindings.group(gpu, &map, shown, wanted, settings);
        draw(encoder, [&self.blank, &self.grid], &group, &covered, into, wanted)
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
                for interpolation in [FILTERED, LOADED] {
                    Warps::build(device, format, &interpolation).unwrap();
                }
            }
        });
    }
}
