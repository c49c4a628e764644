//! What the panels tell of a volume.

use super::state::Transfer;
use crate::failure::Failure;
use crate::shipped;
use crate::transfer_spec::TransferSpec;
use std::path::Path;
use wheatstone_core::volume::{Grid, Histogram, Statistics, Volume, VoxelType, Window};

/// Bins of the histogram over all values: enough for a window of a hundredth of them.
const BINS: usize = 8192;

/// What stays in memory of a volume when its voxels are on the device.
#[derive(Debug, Clone)]
pub(crate) struct Facts {
    pub(crate) name: String,
    pub(crate) grid: Grid,
    pub(crate) voxel_type: VoxelType,
    pub(crate) full_window: Window,
    /// What the reader assumed or left out.
    pub(crate) warnings: Vec<String>,
    statistics: Statistics,
    histogram: Histogram,
}

impl Facts {
    pub(crate) fn of(volume: &Volume, file: Option<&Path>) -> Self {
        let statistics = volume.statistics();
        let full_window = volume.full_window();
        let name = file.unwrap_or(Path::new(shipped::BRAIN_PATH)).file_name().unwrap_or_default();
        Self {
            name: name.to_string_lossy().into_owned(),
            grid: volume.grid().clone(),
            voxel_type: volume.voxels().voxel_type(),
            full_window,
            warnings: Vec::new(),
            histogram: statistics.histogram(full_window, BINS),
            statistics,
        }
    }

    /// The same with what the reader assumed or left out.
    pub(crate) fn with_warnings(self, warnings: Vec<String>) -> Self {
        Self { warnings, ..self }
    }

    /// A transfer function for the volume.
    pub(crate) fn transfer(&self, spec: &TransferSpec) -> Result<Transfer, Failure> {
        let resolved =
            spec.resolve_for(self.grid.dims(), self.full_window, || self.statistics.clone(), None)?;
        Ok(Transfer::of(&resolved.transfer, resolved.window))
    }

    /// Voxels (of a sample) in each of so many equal parts of a window.
    pub(crate) fn counts(&self, window: Window, parts: usize) -> Vec<u64> {
        let mut counts = vec![0; parts];
        let bins = self.histogram.counts.len() as f64;
        for (bin, &count) in self.histogram.counts.iter().enumerate() {
            let value = self.full_window.denormalise((bin as f64 + 0.5) / bins);
            let part = (value - window.lo()) / (window.hi() - window.lo()) * parts as f64;
            if (0.0..parts as f64).contains(&part) {
                counts[part as usize] += count;
            }
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use wheatstone_core::volume::Voxels;

    #[test]
    fn counts_of_a_window_are_those_of_its_values() {
        let grid = Grid::centred([10, 10, 10], [1.0; 3]).unwrap();
        let voxels = (0..1000).map(|i| if i < 300 { 10 } else { 90 }).collect::<Vec<u8>>();
        let mut voxels = voxels;
        voxels[0] = 0;
        voxels[999] = 100;
        let facts = Facts::of(&Volume::new(grid, Voxels::U8(voxels)).unwrap(), None);
        let counts = facts.counts(Window::new(0.0, 100.0).unwrap(), 10);
        assert_eq!(counts.iter().sum::<u64>(), 1000);
        assert!(counts[1] == 299 && counts[0] == 1, "{counts:?}");
        let counts = facts.counts(Window::new(50.0, 250.0).unwrap(), 4);
        assert_eq!(counts[1..], [0, 0, 0], "{counts:?}");
        assert_eq!(counts[0], 700);
    }
}
