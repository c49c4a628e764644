//! What the rays of a cast leap over, and the numbers that the kernel needs for it.

use crate::skip::{GpuBlockRanges, GpuSkipMap};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::skip::{BlockGrid, BlockSize, Structure, margin_blocks};

/// What the rays of a cast leap over.
#[derive(Debug, Clone, Copy)]
pub enum Leap<'a> {
    /// Nothing: every sample is taken.
    Nothing,
    /// Blocks that are empty by a map.
    EmptyBlocks(&'a GpuSkipMap),
    /// Blocks whose values cannot better the extreme so far, for maximum and minimum intensity projections.
    IdleBlocks(&'a GpuBlockRanges),
}

/// The part of `lib/cast_parameters.wgsl` that leaping reads; zeros where nothing is leapt over.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LeapUniform {
    pub(crate) blocks_per_texture: [f32; 3],
    pub(crate) skip_margin: f32,
    pub(crate) last_block: [f32; 3],
    pub(crate) octant_slices: i32,
    pub(crate) code_scale: f32,
    pub(crate) code_offset: f32,
    pub(crate) shortest_run: f32,
}

impl Leap<'_> {
    /// The texture that the kernel reads.
    pub(crate) fn texture(&self) -> Option<wgpu::TextureView> {
        match self {
            Self::Nothing => None,
            Self::EmptyBlocks(map) => Some(map.view.clone()),
            Self::IdleBlocks(ranges) => Some(ranges.view()),
        }
    }

    /// The blocks of a map of empty ones.
    pub(crate) fn skip_block(&self) -> Option<BlockSize> {
        match self {
            Self::Nothing | Self::IdleBlocks(_) => None,
            Self::EmptyBlocks(map) => Some(map.grid().block_size()),
        }
    }

    /// The numbers for a cast whose stored numbers map to normalised values by `scale` and `offset`.
    pub(crate) fn uniform(
        &self,
        parameters: &CastParameters,
        (scale, offset): (f64, f64),
        shortest_run: f32,
    ) -> LeapUniform {
        let of_leap = match self {
            Self::Nothing => LeapUniform::default(),
            Self::EmptyBlocks(map) => LeapUniform {
                skip_margin: skip_margin(parameters, map.grid().block_size()),
                octant_slices: match map.structure() {
                    Structure::Anisotropic => map.grid().dims()[2] as i32,
                    Structure::Occupancy | Structure::Distance => 0,
                },
                ..LeapUniform::over(map.grid())
            },
            Self::IdleBlocks(ranges) => {
                let codes = ranges.codes();
                let at_zero = f64::from(codes.stored_at_zero);
                LeapUniform {
                    code_scale: (f64::from(codes.stored_per_code) * scale) as f32,
                    code_offset: (at_zero * scale + offset) as f32,
                    ..LeapUniform::over(ranges.grid())
                }
            }
        };
        LeapUniform { shortest_run, ..of_leap }
    }
}

/// Blocks by which the distances of a map are shortened.
pub(crate) fn skip_margin(parameters: &CastParameters, block_size: BlockSize) -> f32 {
    let step_voxels = f64::from(parameters.sampling_factor).recip();
    margin_blocks(parameters.classifier, step_voxels, block_size) as f32
}

impl LeapUniform {
    fn over(grid: &BlockGrid) -> Self {
        Self {
            blocks_per_texture: grid.blocks_from_texture().to_array(),
            last_block: grid.dims().map(|count| (count - 1) as f32),
            ..Self::default()
        }
    }
}
