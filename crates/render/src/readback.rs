//! Textures back to the host.

use crate::gpu::{Gpu, GpuError};

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
    let mapped = buffer
        .slice(..)
        .get_mapped_range()
        .map_err(|error| GpuError::Refused { reason: error.to_string() })?;
    Ok(read(&mapped))
}
