//! 3D textures with one texel per block, or per block and octant.

use crate::gpu::{Capabilities, Gpu, GpuError};
use crate::volume::voxel_texture;

/// Makes a texture that is copied to and read texel by texel.
///
/// # Errors
/// [`GpuError::TooManyBlocks`] for more than the device can hold, no memory, a lost device.
pub(super) fn block_texture(
    gpu: &Gpu,
    label: &str,
    dims: [usize; 3],
    format: wgpu::TextureFormat,
) -> Result<wgpu::Texture, GpuError> {
    check_size(gpu.capabilities(), dims, bytes_per_block(format))?;
    let texture = voxel_texture(gpu, label, dims, format);
    gpu.check()?;
    Ok(texture)
}

fn bytes_per_block(format: wgpu::TextureFormat) -> u64 {
    u64::from(format.block_copy_size(None).unwrap_or(1))
}

fn check_size(capabilities: &Capabilities, blocks: [usize; 3], bytes_per_block: u64) -> Result<(), GpuError> {
    let largest_side = blocks.into_iter().max().unwrap_or(0);
    let bytes = blocks.iter().map(|&side| side as u64).product::<u64>() * bytes_per_block;
    if largest_side <= capabilities.largest_3d_side as usize && bytes <= capabilities.largest_texture {
        return Ok(());
    }
    Err(GpuError::TooManyBlocks {
        blocks,
        bytes,
        largest_side,
        allowed_bytes: capabilities.largest_texture,
        allowed_side: capabilities.largest_3d_side,
    })
}
