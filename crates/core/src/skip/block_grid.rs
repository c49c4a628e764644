//! A volume cut into blocks.

use super::BlockSize;
use glam::Vec3;
use std::ops::Range;

/// The blocks of a volume. Block b covers the voxels [b·B, (b+1)·B) along an axis; the last may stick out of the volume.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockGrid {
    volume_dims: [usize; 3],
    block_size: BlockSize,
    dims: [usize; 3],
}

impl BlockGrid {
    /// Cuts a volume of the given dimensions.
    pub fn new(volume_dims: [usize; 3], block_size: BlockSize) -> Self {
        let sides = block_size.sides();
        let dims = [0, 1, 2].map(|axis| volume_dims[axis].div_ceil(sides[axis] as usize));
        Self { volume_dims, block_size, dims }
    }

    /// Voxels along each axis.
    pub fn volume_dims(&self) -> [usize; 3] {
        self.volume_dims
    }

    /// Voxels along each side of a block.
    pub fn block_size(&self) -> BlockSize {
        self.block_size
    }

    /// Blocks along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Product of the dimensions.
    pub fn block_count(&self) -> usize {
        self.dims.iter().product()
    }

    /// Linear index of a block, the first axis fastest.
    pub fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.dims[0] * (y + self.dims[1] * z)
    }

    /// Texture space to block units (DM Eq. 6): block b covers [b, b+1).
    pub fn blocks_from_texture(&self) -> Vec3 {
        let sides = self.block_size.sides();
        Vec3::from([0, 1, 2].map(|axis| self.volume_dims[axis] as f32 / sides[axis] as f32))
    }

    /// Low and high corner of the box about some blocks, by their linear indices, texture space; both are the same without any.
    pub fn bounds(&self, blocks: impl Iterator<Item = usize>) -> [Vec3; 2] {
        let [nx, ny, _] = self.dims;
        let position = |block: usize| [block % nx, block / nx % ny, block / nx / ny].map(|at| at as f32);
        let (lo, hi) = blocks
            .map(|block| Vec3::from(position(block)))
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(lo, hi), at| (lo.min(at), hi.max(at + 1.0)));
        if lo.cmpgt(hi).any() {
            return [Vec3::ZERO; 2];
        }
        [lo, hi].map(|corner| (corner / self.blocks_from_texture()).min(Vec3::ONE))
    }

    /// The voxels along an axis that trilinear samples in a block read: its own and the *halo*, one more to each side.
    pub fn voxels_read(&self, axis: usize, block: usize) -> Range<usize> {
        let side = self.block_size.sides()[axis] as usize;
        (block * side).saturating_sub(1)..((block + 1) * side + 1).min(self.volume_dims[axis])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_those_of_the_blocks_within_the_volume() {
        let grid = BlockGrid::new([10, 8, 6], BlockSize::new([4, 4, 2]).unwrap());
        let of = |blocks: &[[usize; 3]]| grid.bounds(blocks.iter().map(|&block| grid.index(block)));
        assert_eq!(of(&[[1, 0, 2]]), [Vec3::new(0.4, 0.0, 2.0 / 3.0), Vec3::new(0.8, 0.5, 1.0)]);
        assert_eq!(of(&[[2, 1, 0], [0, 1, 1]]), [Vec3::new(0.0, 0.5, 0.0), Vec3::new(1.0, 1.0, 2.0 / 3.0)]);
        assert_eq!(of(&[]), [Vec3::ZERO; 2]);
    }
}
