//! Who holds the structures.

use super::{BlockGrid, FieldLayout, Structure};

/// Who holds the structures, as far as that bounds them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SkipHost {
    /// The CPU, with room for any.
    Cpu,
    /// A device.
    Gpu {
        /// Longest side of a 3D texture, texels.
        largest_side: usize,
        /// Largest buffer that is worked in, bytes.
        largest_buffer: usize,
    },
}

impl SkipHost {
    /// A device without limits.
    pub const ANY_GPU: Self = Self::Gpu { largest_side: usize::MAX, largest_buffer: usize::MAX };

    /// Bytes, at most, that working a structure out takes besides it.
    pub fn working_byte_size(self, grid: &BlockGrid, structure: Structure) -> usize {
        match self {
            Self::Cpu => structure.octants() * grid.block_count(),
            Self::Gpu { .. } => FieldLayout::new(grid.dims(), structure).byte_size(),
        }
    }

    /// Whether there can be such a structure: the octants of an anisotropic map are stacked along z in one texture.
    pub fn can_hold(self, grid: &BlockGrid, structure: Structure) -> bool {
        match self {
            Self::Cpu => true,
            Self::Gpu { largest_side, largest_buffer } => {
                let [width, height, depth] = grid.dims();
                [width, height, depth * structure.octants()].into_iter().all(|side| side <= largest_side)
                    && self.working_byte_size(grid, structure) <= largest_buffer
            }
        }
    }
}
