//! Small tables of the CPU as textures, which kernels read faster than buffers on software devices.

use crate::gpu::{Gpu, GpuError};
use bytemuck::Pod;
use wheatstone_core::skip::RangeCodes;

/// Entries in a row of a table by code.
const CODES_PER_ROW: usize = 256;

/// A 2D texture that is rewritten per change of the settings.
#[derive(Debug)]
pub(super) struct Table {
    texture: wgpu::Texture,
}

impl Table {
    /// # Errors
    /// No memory, a lost device.
    pub(super) fn new(
        gpu: &Gpu,
        [width, height]: [usize; 2],
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("table"),
            size: wgpu::Extent3d { width: width as u32, height: height as u32, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        gpu.check()?;
        Ok(Self { texture })
    }

    /// A table with an entry for each code, 256 in a row.
    ///
    /// # Errors
    /// As [`Table::new`].
    pub(super) fn by_code(
        gpu: &Gpu,
        codes: &RangeCodes,
        format: wgpu::TextureFormat,
    ) -> Result<Self, GpuError> {
        Self::new(gpu, [CODES_PER_ROW, codes.count.div_ceil(CODES_PER_ROW)], format)
    }

    pub(super) fn size(&self) -> [usize; 2] {
        [self.texture.width() as usize, self.texture.height() as usize]
    }

    pub(super) fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Rewrites all entries, row by row.
    pub(super) fn write<T: Pod>(&self, gpu: &Gpu, entries: &[T]) {
        gpu.queue.write_texture(
            self.texture.as_image_copy(),
            bytemuck::cast_slice(entries),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(self.texture.width() * size_of::<T>() as u32),
                rows_per_image: None,
            },
            self.texture.size(),
        );
    }
}
