//! Skip maps of one volume: what is made once, and what each change of the settings costs.

use super::distance::{DistancePass, empty_byte};
use super::occupancy::{NormalisedRanges, OccupancyPass};
use super::{GpuBlockRanges, GpuSkipMap, SkipKernels, Structure};
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::volume::GpuVolume;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::skip::{BlockGrid, BlockSize, FieldLayout, Visibility};
use wheatstone_core::volume::Encoding;

/// Makes skip maps of one volume with blocks of one size. Holds the ranges of the blocks; a change of the settings reads no
/// voxel. Buffers that were once needed are kept.
#[derive(Debug)]
pub struct SkipBuilder {
    kernels: SkipKernels,
    encoding: Encoding,
    values: GpuBlockRanges,
    gradients: Option<Gradients>,
    passes: Option<Passes>,
}

/// What works maps out, with room for one structure or more.
#[derive(Debug)]
struct Passes {
    occupancy: OccupancyPass,
    distances: DistancePass,
}

/// Ranges of gradient magnitudes, and the gradient map's scale.
#[derive(Debug)]
struct Gradients {
    ranges: GpuBlockRanges,
    /// Gradient of the stored numbers that a code stands for.
    stored_per_code: f64,
}

impl SkipBuilder {
    /// Finds the ranges of a volume's values. Two-dimensional transfer functions then count a block as occupied if any
    /// gradient makes it visible.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn new(
        gpu: &Gpu,
        kernels: &SkipKernels,
        volume: &GpuVolume,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        Ok(Self::of_values(kernels, volume, GpuBlockRanges::of_values(gpu, kernels, volume, block_size)?))
    }

    /// With the ranges of a volume's values, which have been found already.
    ///
    /// # Panics
    /// If the ranges are those of a volume of other dimensions.
    pub fn of_values(kernels: &SkipKernels, volume: &GpuVolume, values: GpuBlockRanges) -> Self {
        let grid = BlockGrid::new(volume.dims, values.grid().block_size());
        assert_eq!(&grid, values.grid(), "the ranges are the volume's");
        Self { kernels: kernels.clone(), encoding: volume.encoding(), values, gradients: None, passes: None }
    }

    /// Finds the ranges of a volume's values and of its gradient magnitudes.
    ///
    /// # Errors
    /// As [`SkipBuilder::new`].
    ///
    /// # Panics
    /// If the gradient map is that of a volume of other dimensions.
    pub fn with_gradients(
        gpu: &Gpu,
        kernels: &SkipKernels,
        volume: &GpuVolume,
        gradient_map: &GpuGradientMap,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        assert_eq!(volume.dims, gradient_map.dims(), "the gradient map is the volume's");
        let gradients = Gradients {
            ranges: GpuBlockRanges::of_gradients(gpu, kernels, gradient_map, block_size)?,
            stored_per_code: gradient_map.stored_per_code(),
        };
        Ok(Self { gradients: Some(gradients), ..Self::new(gpu, kernels, volume, block_size)? })
    }

    /// The blocks.
    pub fn grid(&self) -> &BlockGrid {
        self.values.grid()
    }

    /// Ranges of the values.
    pub fn values(&self) -> &GpuBlockRanges {
        &self.values
    }

    /// Bytes on the device of the ranges of values, and of gradients if there are any.
    pub fn ranges_byte_size(&self) -> u64 {
        self.values.byte_size() + self.gradients.as_ref().map_or(0, |gradients| gradients.ranges.byte_size())
    }

    /// Bytes on the device of the field that maps are worked out in: that of the largest structure so far.
    pub fn working_byte_size(&self) -> u64 {
        self.passes.as_ref().map_or(0, |passes| passes.distances.field().layout.byte_size() as u64)
    }

    fn take_passes(&mut self, gpu: &Gpu, structure: Structure) -> Result<Passes, GpuError> {
        if let Some(passes) = self.passes.take()
            && passes.distances.fits(structure)
        {
            return Ok(passes);
        }
        let layout = FieldLayout::new(self.grid().dims(), structure);
        let distances = DistancePass::new(gpu, &self.kernels, layout)?;
        let occupancy = OccupancyPass::new(gpu, &self.kernels, &self.values, distances.field())?;
        Ok(Passes { occupancy, distances })
    }

    /// Makes what maps of a structure are worked out in, if it is not there yet: else the first map does.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn make_room(&mut self, gpu: &Gpu, structure: Structure) -> Result<(), GpuError> {
        self.passes = Some(self.take_passes(gpu, structure)?);
        Ok(())
    }

    /// A new map for some settings. The work is submitted, not waited for.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn map(
        &mut self,
        gpu: &Gpu,
        parameters: &CastParameters,
        structure: Structure,
    ) -> Result<GpuSkipMap, GpuError> {
        let map = GpuSkipMap::new(gpu, *self.grid(), structure)?;
        self.update(gpu, parameters, &map)?;
        Ok(map)
    }

    /// Makes a map of this builder show other settings. Allocates nothing from the second time on for a structure; casts
    /// submitted before see the map as it was.
    ///
    /// # Errors
    /// No memory, a lost device.
    ///
    /// # Panics
    /// If the map is that of other blocks.
    pub fn update(
        &mut self,
        gpu: &Gpu,
        parameters: &CastParameters,
        map: &GpuSkipMap,
    ) -> Result<(), GpuError> {
        assert_eq!(map.grid(), self.grid(), "the map is one of this builder's");
        let structure = map.structure();
        let mut passes = self.take_passes(gpu, structure)?;
        let normalised_from_stored = self.encoding.normalised_from_stored(parameters.window);
        let values = NormalisedRanges { ranges: &self.values, normalised_from_stored };
        let gradients = self.gradients.as_ref().map(|gradients| NormalisedRanges {
            ranges: &gradients.ranges,
            normalised_from_stored: (gradients.stored_per_code * normalised_from_stored.0.abs(), 0.0),
        });
        let visibility = Visibility::new(parameters);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        passes.occupancy.encode(
            gpu,
            &self.kernels,
            &mut encoder,
            (values, gradients),
            &visibility,
            (passes.distances.field(), empty_byte(structure)),
        )?;
        passes.distances.encode(&mut encoder, structure);
        map.encode_copy(&mut encoder, passes.distances.field());
        self.passes = Some(passes);
        gpu.queue.submit([encoder.finish()]);
        gpu.check()
    }
}
