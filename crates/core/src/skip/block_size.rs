//! The size of a block.

use thiserror::Error;

/// Voxels along each side of a block, from [`BlockSize::SMALLEST`] to [`BlockSize::LARGEST`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BlockSize([u32; 3]);

/// Why there are no such blocks.
#[derive(Debug, Error, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SkipError {
    /// A side is too short or too long.
    #[error(
        "blocks of {}×{}×{} voxels: each side must be from {} to {}", .0[0], .0[1], .0[2],
        BlockSize::SMALLEST, BlockSize::LARGEST
    )]
    BlockSize([u32; 3]),
}

impl BlockSize {
    /// Shortest side.
    pub const SMALLEST: u32 = 2;
    /// Longest side.
    pub const LARGEST: u32 = 16;

    /// Blocks of the given sides.
    ///
    /// # Errors
    /// [`SkipError::BlockSize`] for sides that are too short or too long.
    pub fn new(sides: [u32; 3]) -> Result<Self, SkipError> {
        if sides.iter().all(|side| (Self::SMALLEST..=Self::LARGEST).contains(side)) {
            Ok(Self(sides))
        } else {
            Err(SkipError::BlockSize(sides))
        }
    }

    /// Cubic blocks.
    ///
    /// # Errors
    /// As [`BlockSize::new`].
    pub fn cube(side: u32) -> Result<Self, SkipError> {
        Self::new([side; 3])
    }

    /// Voxels along each side.
    pub fn sides(self) -> [u32; 3] {
        self.0
    }
}
