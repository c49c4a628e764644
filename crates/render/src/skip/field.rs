//! Bytes of blocks while they are worked out.

use crate::gpu::{Gpu, GpuError};
use wheatstone_core::skip::FieldLayout;

/// One byte per block, or per block and octant.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) buffer: wgpu::Buffer,
    pub(super) layout: FieldLayout,
}

impl Field {
    /// # Errors
    /// [`GpuError::TooManyBlocks`] for more than the device binds at once, no memory, a lost device.
    pub(super) fn new(gpu: &Gpu, layout: FieldLayout) -> Result<Self, GpuError> {
        let capabilities = gpu.capabilities();
        let byte_size = layout.byte_size() as u64;
        if byte_size > capabilities.largest_storage_binding {
            return Err(GpuError::TooManyBlocks {
                blocks: layout.blocks(),
                bytes: byte_size,
                largest_side: layout.blocks().into_iter().max().unwrap_or(0),
                allowed_bytes: capabilities.largest_storage_binding,
                allowed_side: capabilities.largest_3d_side,
            });
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("field of blocks"),
            size: byte_size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        gpu.check()?;
        Ok(Self { buffer, layout })
    }

    /// Words from a row to the next.
    pub(super) fn row_words(&self) -> u32 {
        (self.layout.row_bytes() / 4) as u32
    }

    /// Invocations of a kernel that writes word by word.
    pub(super) fn invocations(&self) -> [u32; 3] {
        let [_, height, depth] = self.layout.blocks();
        [self.layout.words(), height, depth].map(|side| side as u32)
    }
}
