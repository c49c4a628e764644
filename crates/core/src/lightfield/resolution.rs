//! What a display with beams of finite width resolves at which distance from its screen, and how much less it may be shown by.

use crate::detail::{Footprint, Slab};
use glam::{DAffine3, DMat3, DVec3};
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

    /// What a beam shows is the mean of what all of its rays meet: through all of a pixel of the screen, and sideways as wide as the
    /// beam. So many of them, spread evenly (Hammersley points), as maps of display space into itself: what such a map moves to the ray
    /// through the middle is what the other ray meets. The mean of the pictures of a world that is moved by each of them is what the
    /// display shows at best, to eyes and of its projectors.
    pub fn beam(self, rays: u32) -> impl Iterator<Item = DAffine3> {
        let Self { pixel_size_m, beam_angle_rad } = self;
        (0..rays).map(move |ray| {
            let across = |share: f64| pixel_size_m * (share - 0.5);
            let per_metre =
                (2.0 * (f64::from(ray) + 0.5) / f64::from(rays) - 1.0) * (0.5 * beam_angle_rad).tan();
            let sideways = DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(per_metre, 0.0, 1.0));
            let pixel =
                DVec3::new(across(radical_inverse(ray + 1, 2)), across(radical_inverse(ray + 1, 3)), 0.0);
            DAffine3::from_mat3_translation(sideways, pixel)
        })
    }

    /// How far from the screen things of a size are still reproduced, metres; 0 if nowhere (LF §4: the field of depth).
    pub fn field_of_depth_m(&self, size_m: f64) -> f64 {
        ((size_m - self.pixel_size_m) / self.per_metre()).max(0.0)
    }
}

/// The digits of a number mirrored at the point: from 0 to 1.
fn radical_inverse(mut number: u32, base: u32) -> f64 {
    let (mut mirrored, mut place) = (0.0, 1.0);
    while number > 0 {
        place /= f64::from(base);
        mirrored += place * f64::from(number % base);
        number /= base;
    }
    mirrored
}

/// How coarsely the views of a display's projectors may be cast.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Coarseness {
    /// Steps are at most 2ˡ times as long as at full detail.
    pub longest_step: usize,
    /// By how many levels the voxels that they sample are finer: 0 takes means over all that the display cannot resolve (LF §4),
    /// which leaves nothing to alias; 1 over half of it, which gives thin things more of their own colours.
    pub finer_voxels: usize,
}

impl Coarseness {
    /// In full.
    pub const NONE: Self = Self { longest_step: 0, finer_voxels: 0 };
    /// As LF has it.
    pub const ALL: Self = Self { longest_step: usize::MAX, finer_voxels: 0 };

    /// The longest steps over those at full detail.
    pub fn step_ratio(&self) -> usize {
        1 << self.longest_step
    }

    /// Voxels that a step passes, where it is longer than at full detail.
    pub fn voxels_per_step(&self) -> usize {
        1 << self.finer_voxels
    }

    /// Those of a longest step, most coarse first.
    fn of_step(longest_step: usize) -> [Self; 2] {
        [0, 1].map(|finer_voxels| Self { longest_step, finer_voxels })
    }
}

/// What came of casting so coarsely.
#[derive(Debug, Clone, PartialEq)]
pub struct Tried {
    /// How far each of some pictures is from the most that beams can show of it ([`Resolution::beam`]).
    pub dssims: Vec<f64>,
    /// Samples that were taken for all of them.
    pub samples: u64,
}

/// DSSIM by which coarser casts may take any picture further from the truth than those in full.
pub const MOST_LOST: f64 = 0.0035;

impl Tried {
    fn is_alike(&self, full: &Self) -> bool {
        self.dssims.iter().zip(&full.dssims).all(|(off, in_full)| *off <= in_full + MOST_LOST)
    }

    fn is_nearer_than(&self, other: &Self) -> bool {
        self.dssims.iter().sum::<f64>() < other.dssims.iter().sum::<f64>()
    }
}

/// The coarsest way, up to a longest step, by which pictures are about as near to the truth as in full, or nearer, if it takes fewer
/// samples: thin things may bear no longer steps, whatever the display resolves, if the transfer function makes much of them.
///
/// `cast` makes pictures of what there is to see so coarsely, of the volume alone: what is empty is never wrong.
///
/// # Errors
/// Those of `cast`.
pub fn coarsest_alike<E>(
    longest_step: usize,
    mut cast: impl FnMut(Coarseness) -> Result<Tried, E>,
) -> Result<Coarseness, E> {
    let full = cast(Coarseness::NONE)?;
    let (mut coarsest, mut samples) = (Coarseness::NONE, full.samples);
    for step in 1..=longest_step {
        let [all, half] = Coarseness::of_step(step);
        let (of_all, of_half) = (cast(all)?, cast(half)?);
        let (nearer, tried) = if of_half.is_nearer_than(&of_all) { (half, of_half) } else { (all, of_all) };
        if !tried.is_alike(&full) {
            break;
        }
        if tried.samples < samples {
            (coarsest, samples) = (nearer, tried.samples);
        }
    }
    Ok(coarsest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn rays_of_a_beam_are_spread_over_what_the_display_resolves() {
        let resolution = Resolution { pixel_size_m: 0.002, beam_angle_rad: 0.02 };
        for from_screen_m in [-0.3, 0.0, 0.2] {
            let point = DVec3::new(0.01, -0.02, from_screen_m);
            let moves: Vec<DVec3> =
                resolution.beam(256).map(|moved| moved.transform_point3(point) - point).collect();
            let widest = |along: fn(&DVec3) -> f64| {
                let all = || moves.iter().map(along);
                let mean = all().sum::<f64>() / 256.0;
                assert!(mean.abs() < 0.0001, "{mean}");
                all().fold(0.0, |most: f64, moved| most.max(moved.abs()))
            };
            let most_m = 0.5 * resolution.size_m(from_screen_m);
            let (sideways_m, upwards_m) = (widest(|moved| moved.x), widest(|moved| moved.y));
            assert!(sideways_m > 0.9 * most_m && sideways_m <= most_m, "{sideways_m} {most_m}");
            assert!(upwards_m > 0.98 * 0.001 && upwards_m <= 0.001, "{upwards_m}");
            assert!(moves.iter().all(|moved| moved.z == 0.0));
        }
    }

    #[test]
    fn coarser_casts_have_to_save_samples() {
        let tried = |samples: fn(usize) -> u64| {
            let tried = |coarseness: Coarseness| Tried {
                dssims: vec![0.1],
                samples: samples(coarseness.longest_step),
            };
            coarsest_alike(3, |coarseness| Ok::<_, Infallible>(tried(coarseness))).unwrap().longest_step
        };
        assert_eq!(tried(|step| 100 + step as u64), 0);
        assert_eq!(tried(|step| 100 - step as u64), 3);
        assert_eq!(tried(|step| [100, 110, 90, 95][step]), 2);
    }

    #[test]
    fn what_bears_no_longer_steps_is_cast_in_full_and_of_two_ways_the_nearer_one_is_taken() {
        let of = |longest_step, finer_voxels| Coarseness { longest_step, finer_voxels };
        let alike = |off: fn(Coarseness) -> f64| {
            let tried = |coarseness: Coarseness| Tried {
                dssims: vec![0.2, off(coarseness)],
                samples: 100 - coarseness.longest_step as u64,
            };
            coarsest_alike(3, |coarseness| Ok::<_, Infallible>(tried(coarseness))).unwrap()
        };
        assert_eq!(alike(|coarseness| coarseness.longest_step as f64), Coarseness::NONE);
        assert_eq!(alike(|_| 0.1), of(3, 0));
        assert_eq!(alike(|coarseness| 0.1 - 0.01 * coarseness.finer_voxels as f64), of(3, 1));
        assert_eq!(alike(|coarseness| if coarseness.longest_step > 2 { 1.0 } else { 0.0 }), of(2, 0));
        assert_eq!(alike(|coarseness| 0.9 * MOST_LOST * (coarseness.longest_step.min(1) as f64)), of(3, 0));
    }
}
