//! Layers of 3D textures out of buffers.

use std::ops::Range;

/// Rows in a buffer, one after the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PaddedRows<'a> {
    pub(crate) buffer: &'a wgpu::Buffer,
    /// Where the first row begins.
    pub(crate) first_byte: usize,
    /// From a row to the next: a multiple of 256.
    pub(crate) row_bytes: usize,
}

/// Copies whole layers of a texture from rows.
pub(crate) fn copy_layers(
    encoder: &mut wgpu::CommandEncoder,
    rows: &PaddedRows<'_>,
    texture: &wgpu::Texture,
    layers: Range<usize>,
) {
    encoder.copy_buffer_to_texture(
        wgpu::TexelCopyBufferInfo {
            buffer: rows.buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: rows.first_byte as u64,
                bytes_per_row: Some(rows.row_bytes as u32),
                rows_per_image: Some(texture.height()),
            },
        },
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layers.start as u32 },
            aspect: wgpu::TextureAspect::All,
        },
        wgpu::Extent3d { depth_or_array_layers: layers.len() as u32, ..texture.size() },
    );
}
