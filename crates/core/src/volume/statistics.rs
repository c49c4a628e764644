//! Histogram, percentiles and the robust automatic window.

use super::{Volume, Window};
use rayon::prelude::*;

/// Percentiles are taken from at most this many voxels, one from each of as many equal runs.
const SAMPLE_LIMIT: usize = 1 << 20;

/// Counts of normalised values in equal bins over a window.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Histogram {
    /// Voxels per bin; bin `b` of `n` covers normalised values [b/n, (b+1)/n).
    pub counts: Vec<u64>,
}

/// Distribution of a volume's values.
#[derive(Debug, Clone)]
pub struct Statistics {
    sorted_sample: Vec<f64>,
    range: (f64, f64),
    mean: f64,
}

impl Statistics {
    pub(super) fn of(volume: &Volume) -> Self {
        let voxels = volume.voxels();
        let run = voxels.len().div_ceil(SAMPLE_LIMIT);
        let mut sorted_sample: Vec<f64> = (0..voxels.len())
            .into_par_iter()
            .step_by(run)
            .map(|start| voxels.value(start + scattered(start, run.min(voxels.len() - start))))
            .collect();
        sorted_sample.par_sort_unstable_by(f64::total_cmp);
        let mean = sorted_sample.iter().sum::<f64>() / sorted_sample.len() as f64;
        Self { sorted_sample, range: volume.range(), mean }
    }

    /// Smallest and largest value over all voxels.
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// Mean value.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The value below which `percent` (0–100) of the voxels lie, linearly interpolated.
    pub fn percentile(&self, percent: f64) -> f64 {
        let last = self.sorted_sample.len() - 1;
        let position = (percent / 100.0).clamp(0.0, 1.0) * last as f64;
        let below = self.sorted_sample[position as usize];
        let above = self.sorted_sample[(position as usize + 1).min(last)];
        below + (above - below) * position.fract()
    }

    /// A window that ignores outliers: from the 0.1st to the 99.9th percentile, or the full range where those
    /// coincide.
    pub fn robust_window(&self) -> Window {
        Window::new(self.percentile(0.1), self.percentile(99.9))
            .unwrap_or_else(|_| Window::spanning(self.range.0, self.range.1))
    }

    /// Histogram of the normalised values (of the sample, at most about a million voxels).
    pub fn histogram(&self, window: Window, bins: usize) -> Histogram {
        let mut counts = vec![0_u64; bins.max(1)];
        let last = counts.len() - 1;
        for &value in &self.sorted_sample {
            let bin = window.normalise(value) * counts.len() as f64;
            counts[(bin as usize).min(last)] += 1;
        }
        Histogram { counts }
    }
}

/// A place within a run of voxels that follows no pattern (`SplitMix64`), the same every time. The first of each run
/// would not do: where the length of a row divides that of a run, all of them lie in one plane.
fn scattered(start: usize, run: usize) -> usize {
    let mut hash = (start as u64).wrapping_add(0x9e37_79b9_7f4a_7c15);
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((hash ^ (hash >> 31)) % run as u64) as usize
}

#[cfg(test)]
mod tests {
    use super::SAMPLE_LIMIT;
    use crate::volume::{Grid, Volume, Voxels};

    fn volume(values: Vec<f32>) -> Volume {
        let grid = Grid::centred([values.len(), 1, 1], [1.0; 3]).unwrap();
        Volume::new(grid, Voxels::F32(values)).unwrap()
    }

    #[test]
    fn percentiles_interpolate() {
        let statistics = volume(vec![3.0, 1.0, 2.0, 5.0, 4.0]).statistics();
        assert_eq!(statistics.percentile(0.0), 1.0);
        assert_eq!(statistics.percentile(50.0), 3.0);
        assert_eq!(statistics.percentile(62.5), 3.5);
        assert_eq!(statistics.percentile(100.0), 5.0);
    }

    #[test]
    fn robust_window_ignores_an_outlier() {
        let mut values: Vec<f32> = (0..10_000).map(|i| i as f32 / 10_000.0).collect();
        values[77] = 1e30;
        let window = volume(values).statistics().robust_window();
        assert!(window.hi() < 1.01, "{window:?}");
    }

    #[test]
    fn non_finite_voxels_become_the_low_end() {
        let mut volume = volume(vec![f32::NAN, 2.0, f32::INFINITY, 4.0, f32::NEG_INFINITY]);
        assert_eq!(volume.range(), (2.0, 4.0));
        assert_eq!(volume.non_finite_count(), 3);
        assert_eq!(volume.voxels(), &Voxels::F32(vec![2.0, 2.0, 2.0, 4.0, 2.0]));
        volume.fill_non_finite(-7.0);
        assert_eq!(volume.voxels(), &Voxels::F32(vec![-7.0, 2.0, -7.0, 4.0, -7.0]));
        assert_eq!(volume.range(), (-7.0, 4.0));
    }

    #[test]
    fn the_sample_of_a_large_volume_is_of_every_plane() {
        let dims = [8, 1024, SAMPLE_LIMIT / 1024];
        let grid = Grid::centred(dims, [1.0; 3]).unwrap();
        let count = grid.voxel_count();
        for axis in 0..3 {
            let place = |i: usize| [i % 8, i / 8 % 1024, i / (8 * 1024)][axis];
            let voxels = Voxels::U16((0..count).map(|i| place(i) as u16).collect());
            let statistics = Volume::new(grid.clone(), voxels).unwrap().statistics();
            let last = (dims[axis] - 1) as f64;
            assert!(
                (statistics.mean() - 0.5 * last).abs() < 0.01 * last,
                "axis {axis}: {}",
                statistics.mean()
            );
            assert!((statistics.percentile(90.0) - 0.9 * last).abs() < 0.1 * last.max(10.0), "axis {axis}");
        }
    }

    #[test]
    fn histogram_covers_every_voxel() {
        let volume = volume(vec![0.0, 0.2, 0.5, 1.0]);
        let histogram = volume.statistics().histogram(volume.full_window(), 2);
        assert_eq!(histogram.counts, vec![2, 2]);
    }
}
