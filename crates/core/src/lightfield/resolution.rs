//! What a display with beams of finite width resolves at which distance from its screen, and how much less it may be shown by.

use crate::detail::{Footprint, Slab};
use std::ops::Range;

/// The smallest thing that a display reproduces at a distance from its screen: s(z) = s₀ + 2 |z| tan(Φ/2) (LF Eq. 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Size of a pixel on the screen, s₀, metres.
    pub pixel_size_m: f64,
    /// Angle of a beam, Φ, radians.
    pub beam_angle_rad: f64,
}

/// Steps over s(z): the coarsest level whose steps are not longer (LF Eq. 5).
pub const RESOLVED_PIXELS: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl Resolution {
    /// The size at a distance from the screen, before or behind it, metres.
    pub fn size_m(&self, from_screen_m: f64) -> f64 {
        self.pixel_size_m + self.per_metre() * from_screen_m.abs()
    }

    fn per_metre(&self) -> f64 {
        2.0 * (0.5 * self.beam_angle_rad).tan()
    }

    /// The level of steps through voxels of a length at a distance from the screen, of so many levels (LF Eq. 5).
    pub fn level(&self, from_screen_m: f64, voxel_length_m: f64, level_count: usize) -> usize {
        let level = (self.size_m(from_screen_m) / voxel_length_m).log2().floor().max(0.0) as usize;
        level.min(level_count.saturating_sub(1))
    }

    /// Slabs of depth along −Z from the screen, from near to far, and the levels of the steps that they are cast by: in each of them
    /// the coarsest one whose steps, of a voxel at level 0, are not longer than s(z) anywhere in it, so that they leave out nothing
    /// that the display could show. The volume is between two depths, metres; together the slabs are all depths.
    pub fn slabs(&self, voxel_length_m: f64, depths_m: &Range<f64>, level_count: usize) -> Vec<Slab> {
        let footprint = Footprint { at_eye_m: self.pixel_size_m, per_metre: self.per_metre() };
        let away_to =
            |far_m: f64| footprint.slabs(RESOLVED_PIXELS, voxel_length_m, 0.0..far_m.max(0.0), level_count);
        let (mut before, behind) = (away_to(-depths_m.start), away_to(depths_m.end));
        before.reverse();
        let reflected =
            |slab: &Slab| Slab { level: slab.level, depths_m: -slab.depths_m.end..-slab.depths_m.start };
        // The slabs next to the screen are of one level and make one slab.
        let innermost = Slab {
            level: behind[0].level,
            depths_m: -before[before.len() - 1].depths_m.end..behind[0].depths_m.end,
        };
        let before = before[..before.len() - 1].iter().map(reflected);
        before.chain(std::iter::once(innermost)).chain(behind[1..].iter().cloned()).collect()
    }

    /// How far from the screen things of a size are still reproduced, metres; 0 if nowhere (LF §4: the field of depth).
    pub fn field_of_depth_m(&self, size_m: f64) -> f64 {
        ((size_m - self.pixel_size_m) / self.per_metre()).max(0.0)
    }
}

/// DSSIM by which longer steps may take a projector's picture further from the truth. An eye sees strips of such pictures, so that what
/// it sees is then further off by about as much.
pub const MOST_LOST: f64 = 0.0035;

/// The coarsest level of steps, of those up to a last one, until which a projector's picture is about as near to the truth as at full
/// detail: thin things may bear no longer ones, whatever the display resolves, if the transfer function makes much of them.
///
/// `off` tells how far the picture by steps that are at most of a level is from the truth, which has several rays in each pixel: their
/// DSSIM.
///
/// # Errors
/// Those of `off`.
pub fn coarsest_alike<E>(last: usize, mut off: impl FnMut(usize) -> Result<f64, E>) -> Result<usize, E> {
    let bearable = off(0)? + MOST_LOST;
    for level in 1..=last {
        if off(level)? > bearable {
            return Ok(level - 1);
        }
    }
    Ok(last)
}
