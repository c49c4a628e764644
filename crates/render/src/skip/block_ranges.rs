//! What trilinear samples in each block can read: the GPU twin of [`wheatstone_core::skip::BlockRanges`].

use super::SkipKernels;
use super::block_texture::block_texture;
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::layers::{PaddedRows, copy_layers};
use crate::readback::read_texture;
use crate::volume::{GpuVolume, TexelFormat};
use bytemuck::{Pod, Zeroable};
use wheatstone_core::skip::{BlockGrid, BlockSize, RangeCodes};

/// Most bytes of ranges between the kernel and the texture.
const SLAB_BYTES: usize = 16 << 20;

/// Most voxels that one dispatch reads.
const SLAB_VOXELS: usize = 1 << 27;

/// Mirror of `lib/range_uniform.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct RangeUniform {
    pub(super) block_size: [u32; 3],
    pub(super) first_layer: u32,
    pub(super) blocks: [u32; 3],
    pub(super) last_code: u32,
    pub(super) stored_per_sampled: f32,
    pub(super) stored_per_code: f32,
    pub(super) stored_at_zero: f32,
    pub(super) largest_stored: f32,
    pub(super) rounding: f32,
    pub(super) padding: [u32; 3],
}

/// Codes of the smallest and the largest number that trilinear samples in each block read, as a texture of two 16-bit
/// numbers per block. Made once per volume and block size.
#[derive(Debug, Clone)]
pub struct GpuBlockRanges {
    texture: wgpu::Texture,
    grid: BlockGrid,
    codes: RangeCodes,
}

/// A texture with one number per voxel.
pub(crate) struct VoxelTexture<'a> {
    pub(crate) view: &'a wgpu::TextureView,
    pub(crate) dims: [usize; 3],
    pub(crate) format: TexelFormat,
    pub(crate) codes: RangeCodes,
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
        let voxels = VoxelTexture {
            view: &volume.texture,
            dims: volume.dims,
            format: volume.format(),
            codes: volume.range_codes,
        };
        Self::new(gpu, kernels, &voxels, block_size)
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
        Self::new(gpu, kernels, &gradient_map.voxels(), block_size)
    }

    fn new(
        gpu: &Gpu,
        kernels: &SkipKernels,
        voxels: &VoxelTexture<'_>,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        let grid = BlockGrid::new(voxels.dims, block_size);
        let [width, height, depth] = grid.dims();
        let texture = block_texture(gpu, "block ranges", grid.dims(), wgpu::TextureFormat::Rg16Uint)?;

        let row_bytes = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let layer_voxels = voxels.dims[0] * voxels.dims[1] * block_size.sides()[2] as usize;
        let slab_layers = (SLAB_BYTES / (row_bytes * height)).min(SLAB_VOXELS / layer_voxels).clamp(1, depth);
        let uniform = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("block ranges uniform"),
            size: size_of::<RangeUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let slab = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("slab of block ranges"),
            size: (row_bytes * height * slab_layers) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let kernel = match voxels.format {
            TexelFormat::R8Unorm
            | TexelFormat::R16FloatOf8Bit
            | TexelFormat::Rgba8UnormQuads
            | TexelFormat::R16Unorm => &kernels.ranges_of_whole,
            TexelFormat::R16FloatOf16Bit | TexelFormat::R32Float => &kernels.ranges_of_floats,
        };
        let group = kernel.bind(
            &gpu.device,
            &[
                uniform.as_entire_binding(),
                wgpu::BindingResource::TextureView(voxels.view),
                slab.as_entire_binding(),
            ],
        );
        let rows = PaddedRows { buffer: &slab, first_byte: 0, row_bytes };
        for first_layer in (0..depth).step_by(slab_layers) {
            let layers = slab_layers.min(depth - first_layer);
            let blocks = [width, height, layers].map(|side| side as u32);
            let codes = &voxels.codes;
            let piece = RangeUniform {
                block_size: block_size.sides(),
                first_layer: first_layer as u32,
                blocks,
                last_code: (codes.count - 1) as u32,
                stored_per_sampled: voxels.format.stored_per_sampled() as f32,
                stored_per_code: codes.stored_per_code,
                stored_at_zero: codes.stored_at_zero,
                largest_stored: codes.largest_stored,
                rounding: codes.rounding,
                padding: [0; 3],
            };
            gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&piece));
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            kernel.dispatch(&mut encoder, &group, blocks);
            copy_layers(&mut encoder, &rows, &texture, first_layer..first_layer + layers);
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
        }
        Ok(Self { texture, grid, codes: voxels.codes })
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
