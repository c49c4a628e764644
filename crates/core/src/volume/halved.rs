//! Coarser levels of a volume.

use super::{Grid, Volume};
use std::f64::consts::SQRT_2;

/// Sides up to which a volume is not halved.
const SMALLEST_SIDE: usize = 8;

/// The voxels along an axis that one of half as many covers, and what each counts.
///
/// n voxels become ⌊n/2⌋: pairs, or, if n is odd, parts of three neighbours.
#[derive(Debug, Clone, Copy)]
struct Covered {
    first: usize,
    count: usize,
    weights: [f64; 3],
}

impl Covered {
    fn new(coarse: usize, coarse_side: usize, side: usize) -> Self {
        match side - coarse_side {
            0 => Self { first: coarse, count: 1, weights: [1.0, 0.0, 0.0] },
            difference if difference == coarse_side => {
                Self { first: 2 * coarse, count: 2, weights: [0.5, 0.5, 0.0] }
            }
            _ => {
                let part = |of: usize| of as f64 / side as f64;
                let weights = [part(coarse_side - coarse), part(coarse_side), part(coarse + 1)];
                Self { first: 2 * coarse, count: 3, weights }
            }
        }
    }

    /// Indices and weights.
    fn voxels(self) -> impl Iterator<Item = (usize, f64)> {
        (self.first..self.first + self.count).zip(self.weights)
    }
}

impl Volume {
    /// The levels that follow on this one, each with voxels about twice as long as the last one's: means over the same part of
    /// space, of the same type. An axis along which voxels are longer already waits for the others.
    pub fn coarser_levels(&self) -> Vec<Self> {
        let mut levels: Vec<Self> = Vec::new();
        let mut spacing_mm = self.grid.voxel_length_mm();
        while let Some(next) = levels.last().unwrap_or(self).halved(spacing_mm) {
            levels.push(next);
            spacing_mm *= 2.0;
        }
        levels
    }

    /// Half as many voxels along the axes along which they are about as long as given; nothing if none is, or too few are left.
    fn halved(&self, spacing_mm: f64) -> Option<Self> {
        let sides = self.grid.dims();
        let spacings_mm = self.grid.spacing_mm();
        let coarse_sides: [usize; 3] = std::array::from_fn(|axis| {
            let is_fine = spacings_mm[axis] < SQRT_2 * spacing_mm;
            if is_fine && sides[axis] > 1 { sides[axis] / 2 } else { sides[axis] }
        });
        if coarse_sides == sides || sides.into_iter().max() <= Some(SMALLEST_SIDE) {
            return None;
        }
        let grid = self.grid.resampled(coarse_sides).ok()?;
        let voxels = self.voxels.of_same_type(grid.voxel_count(), |index| self.mean(&grid, index));
        Self::new(grid, voxels).ok()
    }

    /// The mean of the voxels that one of a coarser grid covers.
    fn mean(&self, coarse: &Grid, index: usize) -> f64 {
        let (sides, [width, height, _]) = (self.grid.dims(), coarse.dims());
        let at = [index % width, index / width % height, index / (width * height)];
        let [x, y, z] = std::array::from_fn(|axis| Covered::new(at[axis], coarse.dims()[axis], sides[axis]));
        let mut mean = 0.0;
        for (k, weight_z) in z.voxels() {
            for (j, weight_y) in y.voxels() {
                let row = sides[0] * (j + sides[1] * k);
                let along_x: f64 = x.voxels().map(|(i, weight)| weight * self.voxels.value(row + i)).sum();
                mean += weight_z * weight_y * along_x;
            }
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::volume::Voxels;
    use glam::DVec3;

    fn ramp(dims: [usize; 3], spacing_mm: [f64; 3]) -> Volume {
        let [width, height, depth] = dims;
        let value = |i: usize| (i % width) as f32 + 10.0 * (i / width % height) as f32;
        let voxels = Voxels::F32((0..width * height * depth).map(value).collect());
        Volume::new(Grid::centred(dims, spacing_mm).unwrap(), voxels).unwrap()
    }

    fn mean_of(volume: &Volume) -> f64 {
        let voxels = volume.voxels();
        (0..voxels.len()).map(|i| voxels.value(i)).sum::<f64>() / voxels.len() as f64
    }

    #[test]
    fn levels_cover_the_same_space_and_keep_the_mean() {
        let volume = ramp([21, 16, 11], [1.0; 3]);
        let levels = volume.coarser_levels();
        let dims: Vec<_> = levels.iter().map(|level| level.grid().dims()).collect();
        assert_eq!(dims, [[10, 8, 5], [5, 4, 2]]);
        for level in &levels {
            assert!((mean_of(level) - mean_of(&volume)).abs() < 1e-4);
            for corner in [DVec3::ZERO, DVec3::ONE] {
                let at = |v: &Volume| v.grid().patient_from_texture().transform_point3(corner);
                assert!((at(level) - at(&volume)).length() < 1e-9);
            }
        }
        // Along x parts of three voxels, along y pairs.
        let first = levels[0].voxels().value(0);
        assert!((first - (0.0 * 10.0 + 1.0 * 10.0 + 2.0 * 1.0) / 21.0 - 5.0).abs() < 1e-6, "{first}");
    }

    #[test]
    fn long_voxels_wait_for_the_others() {
        let levels = ramp([64, 64, 16], [1.0, 1.0, 3.0]).coarser_levels();
        let dims: Vec<_> = levels.iter().map(|level| level.grid().dims()).collect();
        assert_eq!(dims, [[32, 32, 16], [16, 16, 16], [8, 8, 8]]);
    }

    #[test]
    fn whole_numbers_are_rounded() {
        let grid = Grid::centred([16, 1, 1], [1.0; 3]).unwrap();
        let voxels = Voxels::I8((0..16).map(|i| if i % 2 == 0 { -4 } else { -1 }).collect());
        let level = Volume::new(grid, voxels).unwrap().coarser_levels().remove(0);
        assert_eq!(level.voxels(), &Voxels::I8(vec![-3; 8]));
    }
}
