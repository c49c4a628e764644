//! Samples that reach beyond their block.

use super::BlockSize;
use crate::cast::{CastParameters, Classifier};

/// Blocks by which distances are shortened: up to that distance a block counts as occupied, because samples read so much
/// further than their own block. 0 but for sampling factors below 1, where steps are longer than a voxel.
///
/// Both ends of a pre-integrated step may be half a voxel, that of the halo, away from the block. Neighbouring samples in empty
/// blocks are on the same side of an isovalue if the blocks touch.
pub fn margin_blocks(parameters: &CastParameters, block_size: BlockSize) -> u32 {
    let step_voxels = 1.0 / f64::from(parameters.sampling_factor);
    let shortest_side = f64::from(block_size.sides().into_iter().min().unwrap_or(1));
    let blocks = match parameters.classifier {
        Classifier::Value | Classifier::ValueGradient => 0.0,
        Classifier::PreIntegrated => (0.5 * (step_voxels - 1.0) / shortest_side).ceil(),
        Classifier::Isovalue => (step_voxels / shortest_side).ceil() - 1.0,
    };
    blocks.max(0.0) as u32
}
