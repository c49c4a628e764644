//! The kernels of empty-space skipping.

use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;

pub(super) const RANGES_OF_WHOLE: KernelFiles<'_> = KernelFiles {
    root: "skip/block_ranges",
    choices: &[("lib/codes", "lib/codes_whole")],
    entry_point: "find_ranges",
};
pub(super) const RANGES_OF_FLOATS: KernelFiles<'_> =
    KernelFiles { choices: &[("lib/codes", "lib/codes_float")], ..RANGES_OF_WHOLE };
pub(super) const OCCUPIED_BY_VALUE: KernelFiles<'_> = KernelFiles {
    root: "skip/occupancy",
    choices: &[("lib/occupy", "lib/occupy_value")],
    entry_point: "find_occupied",
};
pub(super) const OCCUPIED_BY_VALUE_GRADIENT: KernelFiles<'_> =
    KernelFiles { choices: &[("lib/occupy", "lib/occupy_value_gradient")], ..OCCUPIED_BY_VALUE };
pub(super) const ROWS_UP: KernelFiles<'_> =
    KernelFiles { root: "skip/sweep_rows", choices: &[], entry_point: "sweep_up" };
pub(super) const ROWS_DOWN: KernelFiles<'_> = KernelFiles { entry_point: "sweep_down", ..ROWS_UP };
pub(super) const COLUMNS: KernelFiles<'_> =
    KernelFiles { root: "skip/sweep_columns", choices: &[], entry_point: "sweep_columns" };

/// Pipelines of empty-space skipping, made once per device. Cheap to clone.
#[derive(Debug, Clone)]
pub struct SkipKernels {
    pub(super) ranges_of_whole: Kernel,
    pub(super) ranges_of_floats: Kernel,
    pub(super) occupied_by_value: Kernel,
    pub(super) occupied_by_value_gradient: Kernel,
    pub(super) rows_up: Kernel,
    pub(super) rows_down: Kernel,
    pub(super) columns: Kernel,
}

impl SkipKernels {
    /// Builds the pipelines.
    ///
    /// # Errors
    /// A kernel that the driver refuses, a lost device.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let kernel = |files| Kernel::new(&gpu.device, files);
        let kernels = Self {
            ranges_of_whole: kernel(&RANGES_OF_WHOLE)?,
            ranges_of_floats: kernel(&RANGES_OF_FLOATS)?,
            occupied_by_value: kernel(&OCCUPIED_BY_VALUE)?,
            occupied_by_value_gradient: kernel(&OCCUPIED_BY_VALUE_GRADIENT)?,
            rows_up: kernel(&ROWS_UP)?,
            rows_down: kernel(&ROWS_DOWN)?,
            columns: kernel(&COLUMNS)?,
        };
        gpu.check()?;
        Ok(kernels)
    }
}
