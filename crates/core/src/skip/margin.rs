//! Samples that reach beyond their block.

use super::BlockSize;
use crate::cast::{CastParameters, Classifier};

/// How far from its block a sample may be classified, voxels: what the halo of one voxel allows.
const HALO_SLACK_VOXELS: f64 = 0.5;

/// Blocks by which distances are shortened, so that a leap ends before the first sample that reaches into an occupied
/// block: 0 but for sampling factors below 1, where steps are longer than a voxel. A pre-integrated sample reaches half a
/// step to either side of its middle, that of an isosurface to the sample before it.
pub fn margin_blocks(parameters: &CastParameters, block_size: BlockSize) -> u32 {
    let step_voxels = 1.0 / f64::from(parameters.sampling_factor);
    let reach_voxels = match parameters.classifier {
        Classifier::Value | Classifier::ValueGradient => 0.0,
        Classifier::PreIntegrated => 0.5 * step_voxels - HALO_SLACK_VOXELS,
        Classifier::Isovalue if step_voxels <= 1.0 => 0.0,
        Classifier::Isovalue => step_voxels,
    };
    let shortest_side = block_size.sides().into_iter().min().unwrap_or(1);
    (reach_voxels / f64::from(shortest_side)).ceil().max(0.0) as u32
}
