//! A texture that warps are drawn to.

use super::Canvas;
use crate::gpu::{Gpu, GpuError};
use crate::readback::read_texture;
use crate::target::check_size;
use half::f16;
use wheatstone_core::image::Image;

/// A picture of half floats, premultiplied: to be sampled, shown or read back.
#[derive(Debug)]
pub struct Picture {
    texture: wgpu::Texture,
    canvas: Canvas,
}

impl Picture {
    /// The format of its texture.
    pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;

    /// Makes a transparent picture.
    ///
    /// # Errors
    /// [`GpuError::PictureSize`] for an empty or too large picture, no memory, a lost device.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        check_size(size, gpu.capabilities().largest_2d_side)?;
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("warped"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: Self::FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                | wgpu::TextureUsages::TEXTURE_BINDING
                | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        gpu.check()?;
        let canvas = Canvas::new(texture.create_view(&wgpu::TextureViewDescriptor::default()));
        Ok(Self { texture, canvas })
    }

    /// What warps are drawn to.
    pub fn canvas(&mut self) -> &mut Canvas {
        &mut self.canvas
    }

    /// Waits for the device and reads the picture back; its depths are infinite.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Image, GpuError> {
        let color: Vec<[f16; 4]> = read_texture(gpu, &self.texture)?;
        let color = color.into_iter().map(|pixel| pixel.map(f16::to_f32)).collect();
        Ok(Image { color, ..Image::transparent(self.texture.width(), self.texture.height()) })
    }
}
