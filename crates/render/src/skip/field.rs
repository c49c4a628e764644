//! Bytes of blocks while they are worked out.

use crate::gpu::{Gpu, GpuError};

/// One byte per block, the layout of `lib/field.wgsl`: rows are padded so that they can be copied to a texture.
#[derive(Debug)]
pub(super) struct Field {
    pub(super) buffer: wgpu::Buffer,
    pub(super) layout: FieldLayout,
}

/// Where the byte of a block is.
#[derive(Debug, Clone, Copy)]
pub(super) struct FieldLayout {
    /// Blocks along each axis.
    pub(super) blocks: [usize; 3],
}

impl FieldLayout {
    pub(super) fn row_bytes(self) -> usize {
        self.blocks[0].next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize)
    }

    pub(super) fn byte_size(self) -> u64 {
        self.row_bytes() as u64 * self.blocks[1] as u64 * self.blocks[2] as u64
    }

    /// Invocations of a kernel that writes word by word.
    pub(super) fn invocations(self) -> [u32; 3] {
        [self.words(), self.blocks[1], self.blocks[2]].map(|side| side as u32)
    }

    /// Words of a row that hold blocks.
    pub(super) fn words(self) -> usize {
        self.blocks[0].div_ceil(4)
    }
}

impl Field {
    /// # Errors
    /// [`GpuError::TooManyBlocks`] for more than the device binds at once, no memory, a lost device.
    pub(super) fn new(gpu: &Gpu, layout: FieldLayout) -> Result<Self, GpuError> {
        let capabilities = gpu.capabilities();
        if layout.byte_size() > capabilities.largest_storage_binding {
            return Err(GpuError::TooManyBlocks {
                blocks: layout.blocks,
                bytes: layout.byte_size(),
                largest_side: layout.blocks.into_iter().max().unwrap_or(0),
                allowed_bytes: capabilities.largest_storage_binding,
                allowed_side: capabilities.largest_3d_side,
            });
        }
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("field of blocks"),
            size: layout.byte_size(),
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.check()?;
        Ok(Self { buffer, layout })
    }
}
