//! Where the bytes of blocks lie while a device works a structure out.

use super::Structure;

/// Multiple of bytes that rows take, as copies to textures want them.
const ROW_ALIGNMENT: usize = 256;

/// Multiple of bytes that the row of an octant begins at, as copies from buffers like it.
const OCTANT_ALIGNMENT: usize = 16;

/// One byte per block, or per block and octant: the octants of a row lie side by side, so that only whole rows are padded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FieldLayout {
    blocks: [usize; 3],
    octants: usize,
}

impl FieldLayout {
    /// Room to work a structure out over so many blocks along each axis.
    pub fn new(blocks: [usize; 3], structure: Structure) -> Self {
        Self { blocks, octants: structure.octants() }
    }

    /// Blocks along each axis.
    pub fn blocks(self) -> [usize; 3] {
        self.blocks
    }

    /// How many octants there is room for.
    pub fn octants(self) -> usize {
        self.octants
    }

    /// Bytes from a row to the next.
    pub fn row_bytes(self) -> usize {
        (self.octants * self.octant_bytes()).next_multiple_of(ROW_ALIGNMENT)
    }

    /// Bytes from an octant of a row to the next.
    pub fn octant_bytes(self) -> usize {
        self.blocks[0].next_multiple_of(OCTANT_ALIGNMENT)
    }

    /// Words of four blocks in an octant of a row.
    pub fn words(self) -> usize {
        self.blocks[0].div_ceil(4)
    }

    /// Bytes of all rows.
    pub fn byte_size(self) -> usize {
        self.row_bytes() * self.blocks[1] * self.blocks[2]
    }
}
