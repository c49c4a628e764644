//! Skip maps on the device: the GPU twin of [`wheatstone_core::skip::SkipMap`].

use super::block_texture::block_texture;
use super::field::Field;
use super::{OCTANTS, Structure};
use crate::gpu::{Gpu, GpuError};
use crate::layers::copy_layers;
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
        let octants = if structure == Structure::Anisotropic { OCTANTS } else { 1 };
        let [width, height, depth] = grid.dims();
        let dims = [width, height, depth * octants];
        let texture = block_texture(gpu, "skip map", dims, wgpu::TextureFormat::R8Uint)?;
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { texture, view, grid, structure })
    }

    /// Takes over the bytes of all octants.
    pub(super) fn encode_copy<'a>(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        octants: impl Iterator<Item = &'a Field>,
    ) {
        let layers = self.grid.dims()[2];
        for (octant, field) in octants.enumerate() {
            let row_bytes = field.layout.row_bytes();
            let copied = octant * layers..(octant + 1) * layers;
            copy_layers(encoder, &field.buffer, row_bytes, &self.texture, copied);
        }
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
