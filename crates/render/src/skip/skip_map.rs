//! Skip maps on the device: the GPU twin of [`wheatstone_core::skip::SkipMap`].

use super::Structure;
use super::block_texture::block_texture;
use super::field::Field;
use crate::gpu::{Gpu, GpuError};
use crate::layers::{PaddedRows, copy_layers};
use crate::readback::read_texture;
use wheatstone_core::skip::BlockGrid;

/// Blocks that a ray may leap over from each block, as a texture of 8-bit numbers. The octants of an anisotropic map are
/// stacked along z.
#[derive(Debug, Clone)]
pub struct GpuSkipMap {
    texture: wgpu::Texture,
    /// Read as `texture_3d<u32>`.
    pub(crate) view: wgpu::TextureView,
    grid: BlockGrid,
    structure: Structure,
}

impl GpuSkipMap {
    /// # Errors
    /// [`GpuError::TooManyBlocks`] for more than the device can hold, no memory, a lost device.
    pub(super) fn new(gpu: &Gpu, grid: BlockGrid, structure: Structure) -> Result<Self, GpuError> {
        let [width, height, depth] = grid.dims();
        let dims = [width, height, depth * structure.octants()];
        let texture = block_texture(gpu, "skip map", dims, wgpu::TextureFormat::R8Uint)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { texture, view, grid, structure })
    }

    /// Takes over the bytes of all its octants.
    pub(super) fn encode_copy(&self, encoder: &mut wgpu::CommandEncoder, field: &Field) {
        let layers = self.grid.dims()[2];
        for octant in 0..self.structure.octants() {
            let rows = PaddedRows {
                buffer: &field.buffer,
                first_byte: octant * field.layout.octant_bytes(),
                row_bytes: field.layout.row_bytes(),
            };
            copy_layers(encoder, &rows, &self.texture, octant * layers..(octant + 1) * layers);
        }
    }

    /// Hands out the numbers of the first octant, in rows of so many bytes.
    pub(super) fn encode_read(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        into: &wgpu::Buffer,
        row_bytes: usize,
    ) {
        let [_, height, depth] = self.grid.dims();
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(row_bytes as u32),
            rows_per_image: Some(height as u32),
        };
        encoder.copy_texture_to_buffer(
            self.texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: into, layout },
            wgpu::Extent3d { depth_or_array_layers: depth as u32, ..self.texture.size() },
        );
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// What the numbers are.
    pub fn structure(&self) -> Structure {
        self.structure
    }

    /// Bytes on the device.
    pub fn byte_size(&self) -> u64 {
        let size = self.texture.size();
        u64::from(size.width) * u64::from(size.height) * u64::from(size.depth_or_array_layers)
    }

    /// Reads the numbers back, in the order of [`wheatstone_core::skip::SkipMap::distances`].
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>, GpuError> {
        read_texture(gpu, &self.texture)
    }
}
