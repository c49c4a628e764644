//! Empty-space skipping on the device: what `wheatstone_core::skip` does, without reading the volume back.
//!
//! [`SkipBuilder`] finds the [`GpuBlockRanges`] of a volume once; from then on each change of the settings takes time
//! proportional to the number of blocks: occupied blocks, distances by sweeps along x, y and z, a [`GpuSkipMap`].

mod baseline;
mod block_ranges;
mod block_texture;
mod bounds_reading;
mod builder;
mod distance;
mod field;
mod kernels;
mod occupancy;
mod range_search;
mod skip_map;
mod table;

pub use baseline::DmBaseline;
pub use block_ranges::GpuBlockRanges;
pub use bounds_reading::BoundsReading;
pub use builder::SkipBuilder;
pub use kernels::SkipKernels;
pub use range_search::RangeSearch;
pub(crate) use range_search::VoxelTexture;
pub use skip_map::GpuSkipMap;
pub use wheatstone_core::skip::Structure;

/// Every kernel of this module.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<crate::pipeline::KernelFiles<'static>> {
    vec![
        kernels::RANGES_OF_WHOLE,
        kernels::RANGES_OF_FLOATS,
        kernels::OCCUPIED_BY_VALUE,
        kernels::OCCUPIED_BY_VALUE_GRADIENT,
        kernels::ROWS_UP,
        kernels::ROWS_DOWN,
        kernels::COLUMNS,
        baseline::VOXELS_BY_VALUE,
        baseline::VOXELS_BY_VALUE_GRADIENT,
        baseline::ZIGZAG,
    ]
}

#[cfg(test)]
mod tests {
    use super::baseline::VoxelUniform;
    use super::distance::SweepUniform;
    use super::range_search::RangeUniform;
    use crate::shader::assert_layout;

    #[test]
    fn range_uniform_matches_wgsl() {
        assert_layout!(
            "lib/range_uniform",
            "RangeUniform",
            RangeUniform,
            [
                block_size,
                first_layer,
                blocks,
                last_code,
                stored_per_sampled,
                stored_per_code,
                stored_at_zero,
                largest_stored,
                rounding,
                first_row,
            ]
        );
    }

    #[test]
    fn sweep_uniform_matches_wgsl() {
        assert_layout!(
            "lib/sweep",
            "Sweep",
            SweepUniform,
            [lines, line_strides, length, start, step, to_target]
        );
    }

    #[test]
    fn voxel_uniform_matches_wgsl() {
        assert_layout!(
            "lib/voxels",
            "VoxelUniform",
            VoxelUniform,
            [block_size, value_scale, blocks, value_offset, gradient_scale]
        );
    }
}
