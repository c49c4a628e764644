//! Where a volume is occupied, read back without waiting.

use super::GpuSkipMap;
use crate::gpu::{Gpu, GpuError};
use crate::readback::Arrival;
use glam::Vec3;
use wheatstone_core::skip::BlockGrid;

/// The numbers of a skip map on their way to the host.
#[derive(Debug)]
pub struct BoundsReading {
    grid: BlockGrid,
    readable: wgpu::Buffer,
    row_bytes: usize,
    arrival: Arrival,
}

impl GpuSkipMap {
    /// Begins to read back where the volume is occupied.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub fn read_bounds(&self, gpu: &Gpu) -> Result<BoundsReading, GpuError> {
        let grid = *self.grid();
        let [width, height, depth] = grid.dims();
        let row_bytes = width.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let readable = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("occupied blocks"),
            size: (row_bytes * height * depth) as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        // All octants are 0 in the same blocks.
        self.encode_read(&mut encoder, &readable, row_bytes);
        gpu.queue.submit([encoder.finish()]);
        let arrival = Arrival::of(&readable.slice(..));
        gpu.check()?;
        Ok(BoundsReading { grid, readable, row_bytes, arrival })
    }
}

impl BoundsReading {
    /// Low and high corner of the box about the occupied blocks, texture space, once the device has been polled when it was ready.
    ///
    /// # Errors
    /// A lost device.
    pub fn poll(&self) -> Result<Option<[Vec3; 2]>, GpuError> {
        if !self.arrival.is_here()? {
            return Ok(None);
        }
        let mapped = self.readable.slice(..).get_mapped_range().map_err(GpuError::refused)?;
        let width = self.grid.dims()[0];
        let blocks = mapped.chunks(self.row_bytes).flat_map(|row| &row[..width]);
        let occupied = blocks.enumerate().filter(|&(_, &distance)| distance == 0).map(|(block, _)| block);
        Ok(Some(self.grid.bounds(occupied)))
    }
}
