//! How many samples a ray leaves out.

use glam::Vec3;

/// Steps from a position in a block to the first sample that may be outside the blocks nearer than `distance` (DM Eq. 14
/// and 9): at least 1. Positions and the step between samples are in block units; `block` is the one whose distance it is.
///
/// A distance of 1 leaves the block itself (DM Eq. 7), be it empty or occupied. A ray that never leaves gets `u32::MAX`.
pub fn steps_out_of(block: [usize; 3], distance: u8, position: Vec3, step: Vec3) -> u32 {
    let distance = f32::from(distance);
    let steps = |axis: usize| {
        let low = block[axis] as f32;
        let edge = if step[axis] < 0.0 { low + 1.0 - distance } else { low + distance };
        if step[axis] == 0.0 { f32::INFINITY } else { (edge - position[axis]) / step[axis] }
    };
    steps(0).min(steps(1)).min(steps(2)).ceil().max(1.0) as u32
}
