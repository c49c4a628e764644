//! What trilinear samples in each block can read: the GPU twin of [`wheatstone_core::skip::BlockRanges`].

use super::block_texture::block_texture;
use super::{RangeSearch, SkipKernels};
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::readback::read_texture;
use crate::volume::GpuVolume;
use wheatstone_core::skip::{BlockGrid, BlockSize, RangeCodes};

/// Codes of the smallest and the largest number that trilinear samples in each block read, as a texture of two 16-bit
/// numbers per block. Made once per volume and block size.
#[derive(Debug, Clone)]
pub struct GpuBlockRanges {
    pub(super) texture: wgpu::Texture,
    grid: BlockGrid,
    codes: RangeCodes,
}

impl GpuBlockRanges {
    /// Finds the intervals of a volume's stored numbers.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn of_values(
        gpu: &Gpu,
        kernels: &SkipKernels,
        volume: &GpuVolume,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        RangeSearch::of_values(gpu, kernels, volume, block_size)?.run(gpu)
    }

    /// Finds the intervals of a volume's gradient magnitudes.
    ///
    /// # Errors
    /// As [`GpuBlockRanges::of_values`].
    pub fn of_gradients(
        gpu: &Gpu,
        kernels: &SkipKernels,
        gradient_map: &GpuGradientMap,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        RangeSearch::of_gradients(gpu, kernels, gradient_map, block_size)?.run(gpu)
    }

    /// Of blocks whose intervals are not there yet.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub(super) fn empty(gpu: &Gpu, grid: BlockGrid, codes: RangeCodes) -> Result<Self, GpuError> {
        let texture = block_texture(gpu, "block ranges", grid.dims(), wgpu::TextureFormat::Rg16Uint)?;
        Ok(Self { texture, grid, codes })
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        &self.grid
    }

    /// How the ends of the intervals are written.
    pub fn codes(&self) -> &RangeCodes {
        &self.codes
    }

    /// Bytes on the device.
    pub fn byte_size(&self) -> u64 {
        4 * self.grid.block_count() as u64
    }

    /// Read as `texture_3d<u32>`: codes of the smallest and the largest number.
    pub(crate) fn view(&self) -> wgpu::TextureView {
        self.texture.create_view(&wgpu::TextureViewDescriptor::default())
    }

    /// Reads the intervals back, in the order of [`BlockGrid::index`].
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[u16; 2]>, GpuError> {
        read_texture(gpu, &self.texture)
    }
}
