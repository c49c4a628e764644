//! Empty-space skipping as DM does it: every voxel is classified anew per change of the settings, and every block searches
//! for the nearest occupied one. The baseline of the benchmark.

use super::distance::{DistancePass, empty_byte};
use super::table::Table;
use super::{GpuSkipMap, SkipKernels, Structure};
use crate::gpu::{Gpu, GpuError};
use crate::gradient_map::GpuGradientMap;
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;
use crate::volume::GpuVolume;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::skip::{BlockGrid, BlockSize, FieldLayout};
use wheatstone_core::transfer::Lut;

pub(super) const VOXELS_BY_VALUE: KernelFiles<'_> = KernelFiles {
    root: "skip/occupancy",
    choices: &[("lib/occupy", "lib/occupy_voxels"), ("lib/voxel_visible", "lib/voxel_visible_value")],
    entry_point: "find_occupied",
};
pub(super) const VOXELS_BY_VALUE_GRADIENT: KernelFiles<'_> = KernelFiles {
    choices: &[
        ("lib/occupy", "lib/occupy_voxels"),
        ("lib/voxel_visible", "lib/voxel_visible_value_gradient"),
    ],
    ..VOXELS_BY_VALUE
};
pub(super) const ZIGZAG: KernelFiles<'_> =
    KernelFiles { root: "skip/zigzag", choices: &[], entry_point: "zigzag" };

/// Mirror of `lib/voxels.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct VoxelUniform {
    pub(super) block_size: [u32; 3],
    pub(super) value_scale: f32,
    pub(super) blocks: [u32; 3],
    pub(super) value_offset: f32,
    pub(super) gradient_scale: f32,
    pub(super) padding: [u32; 3],
}

/// Makes isotropic distance maps of one volume the way DM does (§3.3, Algorithms 2 and 3), for composites by value, or by
/// value and gradient magnitude.
#[derive(Debug)]
pub struct DmBaseline<'a> {
    volume: &'a GpuVolume,
    gradient_map: Option<&'a GpuGradientMap>,
    grid: BlockGrid,
    distances: DistancePass,
    empty_and_row: wgpu::Buffer,
    uniform: wgpu::Buffer,
    occupancy: Kernel,
    zigzag: Kernel,
}

impl<'a> DmBaseline<'a> {
    /// Prepares what does not depend on the settings. With a gradient map transfer functions are two-dimensional.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn new(
        gpu: &Gpu,
        kernels: &SkipKernels,
        volume: &'a GpuVolume,
        gradient_map: Option<&'a GpuGradientMap>,
        block_size: BlockSize,
    ) -> Result<Self, GpuError> {
        let grid = BlockGrid::new(volume.dims, block_size);
        let distances = DistancePass::new(gpu, kernels, FieldLayout::new(grid.dims(), Structure::Distance))?;
        let occupancy = if gradient_map.is_some() { &VOXELS_BY_VALUE_GRADIENT } else { &VOXELS_BY_VALUE };
        let empty_and_row = [u32::from(empty_byte(Structure::Distance)), distances.field().row_words(), 0, 0];
        let baseline = Self {
            volume,
            gradient_map,
            grid,
            distances,
            empty_and_row: gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("empty and row"),
                contents: bytemuck::cast_slice(&empty_and_row),
                usage: wgpu::BufferUsages::UNIFORM,
            }),
            uniform: gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("voxel uniform"),
                size: size_of::<VoxelUniform>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
            occupancy: Kernel::new(&gpu.device, occupancy)?,
            zigzag: Kernel::new(&gpu.device, &ZIGZAG)?,
        };
        gpu.check()?;
        Ok(baseline)
    }

    /// A new distance map for some settings. The work is submitted, not waited for.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub fn map(&self, gpu: &Gpu, parameters: &CastParameters) -> Result<GpuSkipMap, GpuError> {
        let map = GpuSkipMap::new(gpu, self.grid, Structure::Distance)?;
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.encode_occupancy(gpu, &mut encoder, parameters)?;
        self.distances.encode_rows(&mut encoder);
        for axis in [[0, 1, 0], [0, 0, 1]] {
            map.encode_copy(&mut encoder, self.distances.field());
            self.encode_zigzag(gpu, &mut encoder, axis, &map);
        }
        map.encode_copy(&mut encoder, self.distances.field());
        gpu.queue.submit([encoder.finish()]);
        gpu.check()?;
        Ok(map)
    }

    fn encode_occupancy(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        parameters: &CastParameters,
    ) -> Result<(), GpuError> {
        let (value_scale, value_offset) = self.volume.normalised_from_sampled(parameters.window);
        let (normalised_per_stored, _) = self.volume.encoding().normalised_from_stored(parameters.window);
        let uniform = VoxelUniform {
            block_size: self.grid.block_size().sides(),
            value_scale: value_scale as f32,
            blocks: self.grid.dims().map(|side| side as u32),
            value_offset: value_offset as f32,
            gradient_scale: self
                .gradient_map
                .map_or(0.0, |map| map.normalised_from_sampled(normalised_per_stored) as f32),
            padding: [0; 3],
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let opacities = opacity_table(gpu, &parameters.lut)?;
        let opacities = opacities.view();
        let mut resources = vec![
            self.empty_and_row.as_entire_binding(),
            self.distances.field().buffer.as_entire_binding(),
            self.uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&self.volume.texture),
            wgpu::BindingResource::TextureView(&opacities),
        ];
        resources.extend(self.gradient_map.map(|map| wgpu::BindingResource::TextureView(&map.view)));
        let group = self.occupancy.bind(&gpu.device, &resources);
        self.occupancy.dispatch(encoder, &group, self.distances.field().invocations());
        Ok(())
    }

    fn encode_zigzag(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        [x, y, z]: [u32; 3],
        so_far: &GpuSkipMap,
    ) {
        let field = self.distances.field();
        let axis_and_row = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("axis and row"),
            contents: bytemuck::bytes_of(&[x, y, z, field.row_words()]),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let resources = [
            axis_and_row.as_entire_binding(),
            field.buffer.as_entire_binding(),
            wgpu::BindingResource::TextureView(&so_far.view),
        ];
        let group = self.zigzag.bind(&gpu.device, &resources);
        self.zigzag.dispatch(encoder, &group, field.invocations());
    }
}

fn opacity_table(gpu: &Gpu, lut: &Lut) -> Result<Table, GpuError> {
    let table = Table::new(gpu, [lut.width(), lut.height()], wgpu::TextureFormat::R32Float)?;
    let opacities: Vec<f32> = lut.entries().iter().map(|[_, _, _, log2]| 1.0 - log2.exp2()).collect();
    table.write(gpu, &opacities);
    Ok(table)
}
