//! Slabs of depth, and the levels that they are cast of.

use super::Footprint;
use crate::cast::CastParameters;
use crate::lightfield::{Coarseness, Resolution};
use crate::view::View;
use std::ops::Range;

/// How coarse parts of a view may be cast.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LevelOfDetail {
    /// Pixels that a voxel covers, and a step at one sample per voxel: between √½ and √2 times as many where there are
    /// levels for it.
    Pixels(f64),
    /// By steps as long as what a light-field display resolves at each depth from its screen (LF Eq. 5), for the views of its
    /// projectors.
    Resolved {
        /// What the display resolves.
        resolution: Resolution,
        /// What they bear ([`coarsest_alike`](crate::lightfield::coarsest_alike)).
        coarseness: Coarseness,
    },
}

/// A part of a view's depths that is cast of one level.
#[derive(Debug, Clone, PartialEq)]
pub struct Slab {
    /// Steps of level l are 2ˡ times as long as at full detail, which is 0. The level of the volume that they sample, whose voxels are
    /// as many times as long, is [`LevelOfDetail::sampled`].
    pub level: usize,
    /// Depths along view −Z, metres.
    pub depths_m: Range<f64>,
}

impl LevelOfDetail {
    /// How many levels of steps there are for a volume of so many levels, itself included.
    pub fn level_count(&self, volumes: usize) -> usize {
        match self {
            Self::Pixels(_) => volumes,
            Self::Resolved { coarseness, .. } => {
                (volumes + coarseness.finer_voxels).min(coarseness.longest_step.saturating_add(1))
            }
        }
    }

    /// The level of the volume that steps of a level sample.
    pub fn sampled(&self, level: usize) -> usize {
        match self {
            Self::Pixels(_) => level,
            Self::Resolved { coarseness, .. } => level.saturating_sub(coarseness.finer_voxels),
        }
    }

    /// The slabs of a view, from near to far, of so many levels of steps; at least one, and together all depths.
    pub fn slabs(&self, view: &View, parameters: &CastParameters, level_count: usize) -> Vec<Slab> {
        let (near_m, far_m) = view.depths_m(&parameters.visible_corners_world());
        let view_per_world = view.view_from_world.matrix3.determinant().abs().cbrt();
        let (voxel_length_m, depths_m) = (parameters.voxel_length_m() * view_per_world, near_m..far_m);
        match self {
            Self::Pixels(pixels) => Footprint::of(view).slabs(*pixels, voxel_length_m, depths_m, level_count),
            Self::Resolved { resolution, .. } => resolution.slabs(voxel_length_m, &depths_m, level_count),
        }
    }
}

impl Footprint {
    /// Slabs in which a voxel is about so many times as wide as the footprint, of a volume between two depths, metres.
    pub fn slabs(
        &self,
        pixels: f64,
        voxel_length_m: f64,
        depths_m: Range<f64>,
        level_count: usize,
    ) -> Vec<Slab> {
        let coarsest = level_count.saturating_sub(1);
        let level_at = |depth_m: f64| {
            let voxels = pixels * self.width_m(depth_m).max(0.0) / voxel_length_m;
            (voxels.log2().round() as usize).min(coarsest)
        };
        let first_depth_m = |level: usize| {
            let width_m = voxel_length_m * (level as f64 - 0.5).exp2() / pixels;
            self.depth_m(width_m)
        };
        let (nearest, furthest) = (level_at(depths_m.start), level_at(depths_m.end));
        let slab = |level: usize| {
            let start = if level == nearest { f64::NEG_INFINITY } else { first_depth_m(level) };
            let end = if level == furthest { f64::INFINITY } else { first_depth_m(level + 1) };
            Slab { level, depths_m: start..end }
        };
        (nearest..=furthest).map(slab).collect()
    }
}

impl Slab {
    /// The part of a view that is in the slab.
    pub fn part_of(&self, view: &View) -> View {
        View { projection: view.projection.within(&self.depths_m), ..*view }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PER_METRE: Footprint = Footprint { at_eye_m: 0.0, per_metre: 0.001 };

    #[test]
    fn a_voxel_is_about_a_pixel_wide() {
        let slabs = PER_METRE.slabs(1.0, 0.004, 1.0..40.0, 9);
        let levels: Vec<usize> = slabs.iter().map(|slab| slab.level).collect();
        assert_eq!(levels, [0, 1, 2, 3]);
        for pair in slabs.windows(2) {
            assert_eq!(pair[0].depths_m.end, pair[1].depths_m.start);
            let pixels = 0.004 * (pair[1].level as f64).exp2() / PER_METRE.width_m(pair[1].depths_m.start);
            assert!((pixels - 2.0_f64.sqrt()).abs() < 1e-12, "{pixels}");
        }
        assert_eq!(slabs[0].depths_m.start, f64::NEG_INFINITY);
        assert_eq!(slabs[3].depths_m.end, f64::INFINITY);
    }

    #[test]
    fn levels_end_and_pixels_of_one_width_have_one() {
        let all = f64::NEG_INFINITY..f64::INFINITY;
        assert_eq!(PER_METRE.slabs(2.0, 0.004, 30.0..40.0, 2), [Slab { level: 1, depths_m: all.clone() }]);
        let parallel = Footprint { at_eye_m: 0.004, per_metre: 0.0 };
        assert_eq!(parallel.slabs(2.0, 0.002, -3.0..40.0, 9), [Slab { level: 2, depths_m: all }]);
        // From behind a light-field display's screen.
        let spread = Footprint { at_eye_m: 0.001, per_metre: 0.01 };
        assert_eq!(spread.slabs(2.0, 0.001, -3.0..0.05, 9).len(), 3);
    }
}
