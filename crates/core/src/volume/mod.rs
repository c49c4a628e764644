//! A volume: typed voxels on a grid that knows where it lies in the patient.

mod grid;
mod halved;
mod statistics;
mod storage;
mod stored_slices;
mod voxels;
mod window;

pub(crate) use grid::DIAGONALS;
pub use grid::{Grid, GridError, MOST_VOXEL_LENGTHS};
pub use statistics::{Histogram, Statistics};
pub use storage::{Encoding, StorageKind, StoredVoxels};
pub(crate) use stored_slices::StoredSlices;
pub use voxels::{Voxel, VoxelType, Voxels};
pub use window::{Window, WindowError};

use thiserror::Error;

/// A scalar volume in memory.
///
/// Voxel (i, j, k) is at `i + dims.x * (j + dims.y * k)`: the first axis varies fastest. All values are
/// finite; [`Volume::new`] replaces NaN and infinities by the smallest finite value and remembers where they were.
#[derive(Debug, Clone)]
pub struct Volume {
    grid: Grid,
    voxels: Voxels,
    range: (f64, f64),
    non_finite_mask: Vec<u64>,
}

/// Why voxels and a grid do not make a volume.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// The number of voxels is not the product of the dimensions.
    #[error("{found} voxels where a grid of {}×{}×{} needs {expected}", dims[0], dims[1], dims[2])]
    VoxelCount {
        /// Voxels given.
        found: usize,
        /// Voxels that the grid holds.
        expected: usize,
        /// Dimensions of the grid.
        dims: [usize; 3],
    },
    /// No voxel holds a finite value.
    #[error("all {count} voxels are NaN or infinite: there is nothing to show")]
    NothingFinite {
        /// Voxels in the volume.
        count: usize,
    },
}

impl Volume {
    /// Joins voxels and grid, replacing non-finite voxels by the smallest finite value.
    ///
    /// # Errors
    /// [`VolumeError::VoxelCount`] if the sizes differ, [`VolumeError::NothingFinite`] if no voxel is finite.
    pub fn new(grid: Grid, mut voxels: Voxels) -> Result<Self, VolumeError> {
        if voxels.len() != grid.voxel_count() {
            return Err(VolumeError::VoxelCount {
                found: voxels.len(),
                expected: grid.voxel_count(),
                dims: grid.dims(),
            });
        }
        let range = voxels.finite_range().ok_or(VolumeError::NothingFinite { count: grid.voxel_count() })?;
        let non_finite_mask = voxels.non_finite_mask();
        voxels.fill(&non_finite_mask, range.0);
        Ok(Self { grid, voxels, range, non_finite_mask })
    }

    /// Size, spacing and place of the voxel grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The voxels as the file typed them.
    pub fn voxels(&self) -> &Voxels {
        &self.voxels
    }

    /// Smallest and largest finite value, in the file's unit after slope and intercept.
    pub fn range(&self) -> (f64, f64) {
        self.range
    }

    /// How many voxels were NaN or infinite.
    pub fn non_finite_count(&self) -> usize {
        self.non_finite_mask.iter().map(|bits| bits.count_ones() as usize).sum()
    }

    /// Gives the voxels that were NaN or infinite a value, such as the low end of the window; the range then takes it
    /// in.
    pub fn fill_non_finite(&mut self, value: f64) {
        if self.non_finite_mask.is_empty() {
            return;
        }
        self.range = (self.range.0.min(value), self.range.1.max(value));
        self.voxels.fill(&self.non_finite_mask, value);
    }

    /// Histogram, percentiles and moments of the values.
    pub fn statistics(&self) -> Statistics {
        Statistics::of(self)
    }

    /// The default window: the range of the values.
    pub fn full_window(&self) -> Window {
        Window::spanning(self.range.0, self.range.1)
    }
}
