//! Layers of 3D textures out of buffers.

use std::ops::Range;

/// Copies whole layers of a texture from the start of a buffer of rows padded to `row_bytes`.
pub(crate) fn copy_layers(
    encoder: &mut wgpu::CommandEncoder,
    buffer: &wgpu::Buffer,
    row_bytes: usize,
    texture: &wgpu::Texture,
    layers: Range<usize>,
) {
    encoder.copy_buffer_to_texture(
        wgpu::TexelCopyBufferInfo {
            buffer,
            layout: wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(row_bytes as u32),
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
