//! Samples that reach beyond their block.

use super::BlockSize;
use crate::cast::Classifier;

/// Factor by which rounding may lengthen a step: one of exactly a block must not lead over a block.
const ROUNDING: f64 = 1.0001;

/// Blocks by which distances are shortened: up to that distance a block counts as occupied, because samples read so much
/// further than their own block; 0 where a step is no longer than a voxel.
///
/// Both ends of a pre-integrated step may be half a voxel, that of the halo, away from the block. Neighbouring samples in empty
/// blocks are on the same side of an isovalue if the blocks touch.
pub fn margin_blocks(classifier: Classifier, step_voxels: f64, block_size: BlockSize) -> u32 {
    let shortest_side = f64::from(block_size.sides().into_iter().min().unwrap_or(1));
    let blocks = match classifier {
        Classifier::Value | Classifier::ValueGradient => 0.0,
        Classifier::PreIntegrated => (0.5 * (step_voxels - 1.0) / shortest_side).ceil(),
        Classifier::Isovalue => (ROUNDING * step_voxels / shortest_side).floor(),
    };
    blocks.max(0.0) as u32
}
