//! Buffers that shaders read and write.

use crate::gpu::GpuError;
use wgpu::BufferUsages;

/// A buffer of so many bytes for shaders and for what else is named; zero at first.
pub(crate) fn storage(device: &wgpu::Device, label: &str, size: u64, besides: BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size,
        usage: BufferUsages::STORAGE | besides,
        mapped_at_creation: false,
    })
}

/// Checks that buffers of some sizes can be made and bound.
///
/// # Errors
/// [`GpuError::Refused`] if a device holds none of one of the sizes.
pub(crate) fn check_sizes(device: &wgpu::Device, what: &str, sizes: &[u64]) -> Result<(), GpuError> {
    let limits = device.limits();
    let largest = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
    match sizes.iter().find(|&&bytes| bytes > largest) {
        None => Ok(()),
        Some(bytes) => {
            Err(GpuError::Refused { reason: format!("{bytes} bytes of {what}; its buffers hold {largest}") })
        }
    }
}
