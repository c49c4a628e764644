//! Finds the intervals of blocks: some rows of blocks at a time, as many as there is time for.

use super::{GpuBlockRanges, SkipKernels};
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::kernel::{Kernel, WORKGROUP_SIDE};
use crate::pace::Pace;
use crate::rows::Rows;
use crate::volume::{GpuVolume, TexelFormat};
use bytemuck::{Pod, Zeroable};
use std::time::{Duration, Instant};
use wheatstone_core::skip::{BlockGrid, BlockSize, RangeCodes};

/// Most bytes of ranges between the kernel and the texture.
const SLAB_BYTES: usize = 16 << 20;

/// Rows of blocks that a workgroup goes through: fewer take as long on software Vulkan.
const BAND_ROWS: usize = WORKGROUP_SIDE as usize;

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
    pub(super) first_row: u32,
    pub(super) padding: [u32; 2],
}

/// A texture with one number per voxel.
pub(crate) struct VoxelTexture<'a> {
    pub(crate) view: &'a wgpu::TextureView,
    pub(crate) dims: [usize; 3],
    pub(crate) format: TexelFormat,
    pub(crate) codes: RangeCodes,
}

/// Block ranges that are being found. Steps are submitted and waited for, so that they are as long as they seem; between them the device is
/// free for other work.
#[derive(Debug)]
pub struct RangeSearch {
    ranges: GpuBlockRanges,
    kernel: Kernel,
    group: wgpu::BindGroup,
    /// Of the next part but for what part it is.
    uniform: RangeUniform,
    uniform_buffer: wgpu::Buffer,
    /// Of what a step has found.
    slab: wgpu::Buffer,
    /// From a row of blocks to the next in the slab.
    row_bytes: usize,
    /// That a step may take.
    most_rows: usize,
    /// Rows of all layers that are done.
    rows: usize,
    /// Counts rows.
    pace: Pace,
}

impl RangeSearch {
    /// Begins to look for the intervals of a volume's stored numbers.
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

    /// Begins to look for the intervals of a volume's gradient magnitudes.
    ///
    /// # Errors
    /// As [`RangeSearch::of_values`].
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
        let ranges = GpuBlockRanges::empty(gpu, BlockGrid::new(voxels.dims, block_size), voxels.codes)?;
        let [width, height, depth] = ranges.grid().dims();
        let row_bytes = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let [_, block_height, block_depth] = block_size.sides().map(|side| side as usize);
        let row_voxels = voxels.dims[0] * block_height * block_depth;
        let most_rows = (SLAB_BYTES / row_bytes)
            .min(SLAB_VOXELS / row_voxels)
            .clamp(BAND_ROWS, BAND_ROWS.max(height * depth));
        let uniform_buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("block ranges uniform"),
            size: size_of::<RangeUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let slab = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("slab of block ranges"),
            size: (row_bytes * most_rows) as u64,
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
                uniform_buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(voxels.view),
                slab.as_entire_binding(),
            ],
        );
        let codes = &voxels.codes;
        let uniform = RangeUniform {
            block_size: block_size.sides(),
            first_layer: 0,
            blocks: [width as u32, 0, 0],
            last_code: (codes.count - 1) as u32,
            stored_per_sampled: voxels.format.stored_per_sampled() as f32,
            stored_per_code: codes.stored_per_code,
            stored_at_zero: codes.stored_at_zero,
            largest_stored: codes.largest_stored,
            rounding: codes.rounding,
            first_row: 0,
            padding: [0; 2],
        };
        gpu.check()?;
        let (kernel, pace) = (kernel.clone(), Pace::beginning_with(BAND_ROWS));
        Ok(Self { ranges, kernel, group, uniform, uniform_buffer, slab, row_bytes, most_rows, rows: 0, pace })
    }

    /// Goes through as many rows of blocks as a time holds, by what the last steps took: whole layers, or rows of one, but at least
    /// as many as a workgroup takes.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn step(&mut self, gpu: &Gpu, time: Duration) -> Result<(), GpuError> {
        if self.is_whole() {
            return Ok(());
        }
        let begun = Instant::now();
        let [width, height, depth] = self.ranges.grid().dims();
        let left = height * depth - self.rows;
        let most = self.pace.fitting(time).min(left).min(self.most_rows);
        let part = Rows::next(height, self.rows, most, BAND_ROWS);
        let uniform = RangeUniform {
            first_row: part.rows.start as u32,
            first_layer: part.layers.start as u32,
            blocks: [width, part.rows.len(), part.layers.len()].map(|side| side as u32),
            ..self.uniform
        };
        gpu.queue.write_buffer(&self.uniform_buffer, 0, bytemuck::bytes_of(&uniform));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.kernel.dispatch(&mut encoder, &self.group, uniform.blocks);
        encoder.copy_buffer_to_texture(
            wgpu::TexelCopyBufferInfo {
                buffer: &self.slab,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.row_bytes as u32),
                    rows_per_image: Some(part.rows.len() as u32),
                },
            },
            wgpu::TexelCopyTextureInfo { origin: part.origin(), ..self.ranges.texture.as_image_copy() },
            part.extent(width),
        );
        let submission = gpu.queue.submit([encoder.finish()]);
        gpu.wait_for(submission)?;
        self.pace.learn(part.count(), begun.elapsed());
        self.rows += part.count();
        Ok(())
    }

    /// Rows of blocks that are done, and all that there are.
    pub fn rows(&self) -> (usize, usize) {
        let [_, height, depth] = self.ranges.grid().dims();
        (self.rows, height * depth)
    }

    /// Whether all blocks are done.
    pub fn is_whole(&self) -> bool {
        let (done, all) = self.rows();
        done == all
    }

    /// The ranges.
    ///
    /// # Panics
    /// If blocks are missing.
    pub fn finish(self) -> GpuBlockRanges {
        assert!(self.is_whole(), "{} rows of blocks are done", self.rows);
        self.ranges
    }

    /// All steps, one after the other.
    pub(super) fn run(mut self, gpu: &Gpu) -> Result<GpuBlockRanges, GpuError> {
        while !self.is_whole() {
            self.step(gpu, Duration::MAX)?;
        }
        Ok(self.finish())
    }
}
