//! What can go wrong on a GPU.

use thiserror::Error;

/// An error of the device or of work given to it.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter was found or accepted.
    #[error("no usable GPU adapter ({found} found): install a Vulkan driver, software Vulkan will do")]
    NoAdapter {
        /// Adapters found before any was refused.
        found: usize,
    },
    /// An adapter was found but gave no device.
    #[error("adapter {adapter} gave no device: {reason}")]
    Device {
        /// Adapter name.
        adapter: String,
        /// What the driver said.
        reason: String,
    },
    /// The device ran out of memory.
    #[error("out of GPU memory: {reason}")]
    OutOfMemory {
        /// What the driver said.
        reason: String,
    },
    /// The device was lost: reset, unplugged, or its driver crashed.
    #[error("GPU device lost: {reason}")]
    Lost {
        /// What the driver said.
        reason: String,
    },
    /// Work did not finish in time.
    #[error("GPU work did not finish within {seconds} s")]
    Hung {
        /// The time waited.
        seconds: u64,
    },
    /// The device refused a call: a bug in this crate.
    #[error("GPU call refused: {reason}")]
    Refused {
        /// What validation said.
        reason: String,
    },
    /// A volume exceeds what the device can hold in one texture.
    #[error(
        "volume of {}×{}×{} voxels needs a texture of {bytes} bytes with sides up to {largest_side}; this device allows {allowed_bytes} bytes and sides up to {allowed_side}",
        dims[0], dims[1], dims[2]
    )]
    VolumeTooLarge {
        /// Dimensions of the volume.
        dims: [usize; 3],
        /// Bytes needed.
        bytes: u64,
        /// Largest dimension.
        largest_side: usize,
        /// Most bytes in one texture.
        allowed_bytes: u64,
        /// Largest texture side.
        allowed_side: u32,
    },
    /// A structure of empty-space skipping exceeds what the device can hold.
    #[error(
        "{}×{}×{} blocks for empty-space skipping need {bytes} bytes and a side of {largest_side}; this device allows {allowed_bytes} bytes and sides up to {allowed_side}: use larger blocks",
        blocks[0], blocks[1], blocks[2]
    )]
    TooManyBlocks {
        /// Blocks along each axis.
        blocks: [usize; 3],
        /// Bytes needed.
        bytes: u64,
        /// Largest side of the texture needed.
        largest_side: usize,
        /// Most bytes.
        allowed_bytes: u64,
        /// Largest texture side.
        allowed_side: u32,
    },
    /// A picture exceeds the device's largest texture.
    #[error("picture of {width}x{height} pixels: this device allows sides of 1 to {allowed}")]
    PictureSize {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// Largest side.
        allowed: u32,
    },
}

impl From<wgpu::Error> for GpuError {
    fn from(error: wgpu::Error) -> Self {
        match error {
            wgpu::Error::OutOfMemory { source } => Self::OutOfMemory { reason: source.to_string() },
            wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => {
                Self::Refused { reason: description }
            }
        }
    }
}

impl GpuError {
    /// [`GpuError::Refused`], for what an error says.
    pub(crate) fn refused(error: impl std::fmt::Display) -> Self {
        Self::Refused { reason: error.to_string() }
    }
}
