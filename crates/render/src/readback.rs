//! Textures back to the host.

use crate::gpu::{Gpu, GpuError};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// A part of a buffer that is being mapped, to be read without waiting.
#[derive(Debug)]
pub(crate) struct Arrival(Receiver<Result<(), wgpu::BufferAsyncError>>);

impl Arrival {
    /// Begins to map, after the submission that fills the buffer.
    pub(crate) fn of(slice: &wgpu::BufferSlice<'_>) -> Self {
        let (sender, arrived) = channel();
        // Nobody listens any more where what is read has been given up.
        slice.map_async(wgpu::MapMode::Read, move |result| drop(sender.send(result)));
        Self(arrived)
    }

    /// Whether it has come to its end, once the device has been polled when it was ready: if the buffer is not mapped then, mapped ranges
    /// of it say so.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the buffer cannot be mapped.
    pub(crate) fn is_here(&self) -> Result<bool, GpuError> {
        match self.0.try_recv() {
            Err(TryRecvError::Empty) => Ok(false),
            Ok(Err(error)) => Err(GpuError::refused(error)),
            // wgpu drops the callbacks of buffers that it has mapped if a window cannot be configured because another thread gives the
            // device work.
            Ok(Ok(())) | Err(TryRecvError::Disconnected) => Ok(true),
        }
    }
}

/// All texels of a texture, row by row and slice by slice.
///
/// # Errors
/// No memory, a lost or hung device.
pub(crate) fn read_texture<T: bytemuck::Pod>(gpu: &Gpu, texture: &wgpu::Texture) -> Result<Vec<T>, GpuError> {
    let row_bytes = texture.width() as usize * size_of::<T>();
    let padded_row_bytes = row_bytes.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
    let rows = u64::from(texture.height()) * u64::from(texture.depth_or_array_layers());
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("readback"),
        size: padded_row_bytes as u64 * rows,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer: &buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(padded_row_bytes as u32),
                rows_per_image: Some(texture.height()),
            },
        },
        texture.size(),
    );
    gpu.queue.submit([encoder.finish()]);
    read_buffer(gpu, &buffer, |bytes| {
        bytes
            .chunks(padded_row_bytes)
            .flat_map(|row| bytemuck::cast_slice::<u8, T>(&row[..row_bytes]))
            .copied()
            .collect()
    })
}

/// What `read` makes of a mappable buffer's bytes, once all submitted work is done.
///
/// # Errors
/// No memory, a lost or hung device.
pub(crate) fn read_buffer<T>(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    read: impl FnOnce(&[u8]) -> T,
) -> Result<T, GpuError> {
    buffer.slice(..).map_async(wgpu::MapMode::Read, |_| {});
    gpu.wait()?;
    let mapped = buffer.slice(..).get_mapped_range().map_err(GpuError::refused)?;
    Ok(read(&mapped))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_buffer_whose_callback_was_dropped_is_looked_at_and_one_that_is_refused_is_told() {
        let (sender, arrived) = channel();
        let arrival = Arrival(arrived);
        assert_eq!(arrival.is_here(), Ok(false));
        sender.send(Ok(())).unwrap();
        assert_eq!(arrival.is_here(), Ok(true));
        sender.send(Err(wgpu::BufferAsyncError)).unwrap();
        assert!(matches!(arrival.is_here(), Err(GpuError::Refused { .. })));
        drop(sender);
        assert_eq!(arrival.is_here(), Ok(true));
    }
}
