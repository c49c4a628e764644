//! What pieces take by the device's timestamps.

use crate::gpu::{Gpu, GpuError};
use crate::readback::Arrival;
use crate::stamps::Stamps;

/// Bytes of a timestamp.
const STAMP_BYTES: u64 = 8;

/// Timestamps at the end of each piece, and at the beginning of the first.
#[derive(Debug)]
pub(super) struct StampClock {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    tick_s: f64,
    reading: Option<Reading>,
}

/// Timestamps on their way to the host.
#[derive(Debug)]
struct Reading {
    bytes: u64,
    arrival: Arrival,
}

impl StampClock {
    /// Most pieces of a submission: the timestamps of a set but the first.
    pub(super) const MOST_PIECES: usize = wgpu::QUERY_SET_MAX_QUERIES as usize - 1;

    pub(super) fn new(gpu: &Gpu) -> Self {
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: u64::from(wgpu::QUERY_SET_MAX_QUERIES) * STAMP_BYTES,
                usage,
                mapped_at_creation: false,
            })
        };
        let resolve = wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC;
        Self {
            set: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("ends of pieces"),
                ty: wgpu::QueryType::Timestamp,
                count: wgpu::QUERY_SET_MAX_QUERIES,
            }),
            resolved: buffer("timestamps", resolve),
            readable: buffer("timestamps read", wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ),
            tick_s: f64::from(gpu.queue.get_timestamp_period()) * 1e-9,
            reading: None,
        }
    }

    /// Timestamps of a piece: of its end, and of the beginning of the first.
    pub(super) fn stamps(&self, piece: usize) -> Stamps<'_> {
        let end = piece as u32 + 1;
        Stamps::new(&self.set, (piece == 0).then_some(0), Some(end))
    }

    /// Encodes the reading of the timestamps of one or more pieces, after them.
    pub(super) fn encode_reading(&self, encoder: &mut wgpu::CommandEncoder, pieces: usize) {
        let stamps = pieces as u32 + 1;
        encoder.resolve_query_set(&self.set, 0..stamps, &self.resolved, 0);
        let bytes = u64::from(stamps) * STAMP_BYTES;
        encoder.copy_buffer_to_buffer(&self.resolved, 0, &self.readable, 0, bytes);
    }

    /// Begins to read, after the submission.
    pub(super) fn begin_reading(&mut self, pieces: usize) {
        let bytes = (pieces as u64 + 1) * STAMP_BYTES;
        let arrival = Arrival::of(&self.readable.slice(..bytes));
        self.reading = Some(Reading { bytes, arrival });
    }

    /// What the pieces took, seconds, once the device has finished them.
    pub(super) fn read(&mut self) -> Result<Option<Vec<f64>>, GpuError> {
        let Some(reading) = self.reading.take() else { return Ok(None) };
        if !reading.arrival.is_here()? {
            self.reading = Some(reading);
            return Ok(None);
        }
        let seconds = self.between_stamps(reading.bytes);
        self.readable.unmap();
        seconds.map(Some)
    }

    fn between_stamps(&self, bytes: u64) -> Result<Vec<f64>, GpuError> {
        let mapped = self.readable.slice(..bytes).get_mapped_range().map_err(GpuError::refused)?;
        let stamps: &[u64] = bytemuck::cast_slice(&mapped);
        let between = |stamps: &[u64]| stamps[1].saturating_sub(stamps[0]) as f64 * self.tick_s;
        Ok(stamps.windows(2).map(between).collect())
    }
}
