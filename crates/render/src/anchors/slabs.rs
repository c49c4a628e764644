//! What the rays of an anchor pass, on the device.

use crate::buffers::{check_sizes, storage};
use crate::gpu::{Gpu, GpuError};
use crate::readback::read_buffer;
use crate::uniforms::PairUniform;
use bytemuck::Zeroable as _;
use std::num::NonZero;
use wheatstone_core::lightfield::anchors::{DepthSlabs, SlabPicture};

/// Side of a square that bits are kept for, pixels: `SLAB_SQUARE` of `lib/slab_cells.wgsl`.
pub(super) const SQUARE: u32 = 8;

/// Rows of a stack of cells: `STACK_ROWS` of `lib/slab_cells.wgsl`.
pub(super) const STACK_ROWS: u32 = 4;

/// Words of bits of a square.
const WORDS: u64 = 2;

/// Cells of a picture and bits of its squares, as of `lib/slab_cells.wgsl`.
#[derive(Debug)]
pub(crate) struct GpuSlabs {
    pub(crate) cells: wgpu::Buffer,
    pub(super) size: [u32; 2],
    pub(super) slabs: DepthSlabs,
}

/// Bytes before the planes: a binding may begin there.
fn bytes_of_bits(size: [u32; 2]) -> u64 {
    let words = size.map(|side| u64::from(side.div_ceil(SQUARE))).iter().product::<u64>() * WORDS;
    4 * words.next_multiple_of(64)
}

/// Bytes of the slabs of a picture, whose rows are filled up to whole stacks; what hides the last of them takes as much as a slab.
fn byte_size([width, height]: [u32; 2], slabs: &DepthSlabs) -> u64 {
    let planes = DepthSlabs { count: slabs.count + 1, ..*slabs };
    bytes_of_bits([width, height]) + planes.byte_size([width, height.next_multiple_of(STACK_ROWS)])
}

impl GpuSlabs {
    /// Clear ones.
    ///
    /// # Errors
    /// More than a buffer holds.
    pub(super) fn new(gpu: &Gpu, size: [u32; 2], slabs: &DepthSlabs) -> Result<Self, GpuError> {
        let bytes = byte_size(size, slabs);
        check_sizes(&gpu.device, "slabs of an anchor", &[bytes])?;
        let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        Ok(Self { cells: storage(&gpu.device, "slabs", bytes, usage), size, slabs: *slabs })
    }

    /// Those of the last anchor that had as many bytes, cleared.
    pub(super) fn cleared(self, gpu: &Gpu, size: [u32; 2], slabs: &DepthSlabs) -> Result<Self, GpuError> {
        if self.cells.size() != byte_size(size, slabs) {
            return Self::new(gpu, size, slabs);
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.cells, 0, None);
        gpu.queue.submit([encoder.finish()]);
        Ok(Self { size, slabs: *slabs, ..self })
    }

    /// The bits of squares.
    pub(super) fn bits(&self) -> wgpu::BindingResource<'_> {
        self.range(0, NonZero::new(bytes_of_bits(self.size)))
    }

    /// The planes.
    pub(super) fn planes(&self) -> wgpu::BindingResource<'_> {
        self.range(bytes_of_bits(self.size), None)
    }

    fn range(&self, offset: u64, size: Option<NonZero<u64>>) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: &self.cells, offset, size })
    }

    /// What a cast is told of them.
    pub(crate) fn uniform(&self) -> PairUniform {
        let DepthSlabs { nearest_per_m, thickness_per_m, count } = self.slabs;
        PairUniform {
            k: thickness_per_m.recip() as f32,
            offset: (nearest_per_m / thickness_per_m) as f32,
            count,
            ..PairUniform::zeroed()
        }
    }

    /// Reads the cells back, and what hides them.
    pub(super) fn read(&self, gpu: &Gpu) -> Result<SlabPicture, GpuError> {
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: self.cells.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&self.cells, 0, &buffer, 0, None);
        gpu.queue.submit([encoder.finish()]);
        let first = (bytes_of_bits(self.size) / 4) as usize;
        let words: Vec<u32> =
            read_buffer(gpu, &buffer, |bytes| bytemuck::cast_slice(bytes)[first..].to_vec())?;
        let mut picture = SlabPicture::clear(self.size, self.slabs.count);
        let [width, height] = self.size.map(|side| side as usize);
        let rows = STACK_ROWS as usize;
        for (index, held) in picture.ends.iter_mut().chain(&mut picture.cells).enumerate() {
            let (line, column) = (index / width, index % width);
            let (plane, row) = (line / height, line % height);
            let stack = (plane * height.div_ceil(rows) + row / rows) * width + column;
            *held = words[stack * rows + row % rows];
        }
        Ok(picture)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::compose;

    #[test]
    fn constants_are_those_of_the_kernel() {
        let text = compose("lib/slab_cells", &[]).unwrap().text;
        assert!(text.contains(&format!("const SLAB_SQUARE: u32 = {SQUARE}u;")));
        assert!(text.contains(&format!("const STACK_ROWS: u32 = {STACK_ROWS}u;")));
    }
}
