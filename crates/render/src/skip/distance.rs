//! From occupied blocks to distances: one-sided sweeps along x, y and z.

use super::field::Field;
use super::{SkipKernels, Structure};
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;
use wheatstone_core::skip::FieldLayout;

/// Mirror of `lib/sweep.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct SweepUniform {
    pub(super) lines: [u32; 2],
    pub(super) line_strides: [u32; 2],
    pub(super) length: u32,
    pub(super) start: u32,
    pub(super) step: u32,
    pub(super) to_target: u32,
}

/// Where occupied blocks are counted from a block along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    /// At higher indices.
    Above,
    /// At lower indices.
    Below,
}

impl SweepUniform {
    /// From one octant of a field to the same or another.
    fn new(layout: FieldLayout, axis: usize, side: Side, [from, to]: [usize; 2]) -> Self {
        let [_, height, depth] = layout.blocks().map(|side| side as u32);
        let words = layout.words() as u32;
        let row = (layout.row_bytes() / 4) as u32;
        let layer = row * height;
        let (lines, line_strides, length, stride) = match axis {
            0 => ([height, depth], [row, layer], words, 1),
            1 => ([words, depth], [1, layer], height, row),
            _ => ([words, height], [1, row], depth, layer),
        };
        let (first, step) = match side {
            Side::Below => (0, stride),
            Side::Above => ((length - 1) * stride, stride.wrapping_neg()),
        };
        let [from, to] = [from, to].map(|octant| (octant * layout.octant_bytes() / 4) as u32);
        Self { lines, line_strides, length, start: from + first, step, to_target: to - from }
    }
}

/// A sweep over a field.
#[derive(Debug)]
struct Sweep {
    kernel: Kernel,
    group: wgpu::BindGroup,
    lines: [u32; 2],
}

impl Sweep {
    fn encode(&self, encoder: &mut wgpu::CommandEncoder) {
        self.kernel.dispatch(encoder, &self.group, [self.lines[0], self.lines[1], 1]);
    }
}

/// A field with the sweeps over it: in the first octant only, and if there is room for all octants those between them.
#[derive(Debug)]
pub(super) struct DistancePass {
    field: Field,
    in_place: Vec<Sweep>,
    by_octant: Vec<Sweep>,
}

impl DistancePass {
    /// With room for a structure.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub(super) fn new(gpu: &Gpu, kernels: &SkipKernels, layout: FieldLayout) -> Result<Self, GpuError> {
        let field = Field::new(gpu, layout)?;
        let sweep = |axis: usize, side: Side, octants: [usize; 2]| {
            let kernel = match (axis, side) {
                (0, Side::Above) => &kernels.rows_down,
                (0, Side::Below) => &kernels.rows_up,
                _ => &kernels.columns,
            };
            let uniform = SweepUniform::new(layout, axis, side, octants);
            let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("sweep"),
                contents: bytemuck::bytes_of(&uniform),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let resources = [buffer.as_entire_binding(), field.buffer.as_entire_binding()];
            let group = kernel.bind(&gpu.device, &resources);
            Sweep { kernel: kernel.clone(), group, lines: uniform.lines }
        };
        let in_place = (0..3)
            .flat_map(|axis| [Side::Above, Side::Below].map(|side| sweep(axis, side, [0, 0])))
            .collect();
        // Each axis splits every octant so far in two, below and above: 2 + 4 + 8 sweeps (DM §3.6).
        let axes = if layout.octants() == Structure::Anisotropic.octants() { 0..3 } else { 0..0 };
        let by_octant = axes
            .flat_map(|axis| (0..1 << axis).map(move |octant| (axis, octant)))
            .flat_map(|(axis, octant)| {
                [
                    sweep(axis, Side::Below, [octant, octant | 1 << axis]),
                    sweep(axis, Side::Above, [octant; 2]),
                ]
            })
            .collect();
        gpu.check()?;
        Ok(Self { field, in_place, by_octant })
    }

    /// Whether there is room for a structure.
    pub(super) fn fits(&self, structure: Structure) -> bool {
        structure.octants() <= self.field.layout.octants()
    }

    /// The field, to whose first octant occupied blocks are written: 0 for occupied, [`empty_byte`] for others.
    pub(super) fn field(&self) -> &Field {
        &self.field
    }

    /// Turns occupied blocks into what a structure holds.
    pub(super) fn encode(&self, encoder: &mut wgpu::CommandEncoder, structure: Structure) {
        let sweeps: &[Sweep] = match structure {
            Structure::Occupancy => &[],
            Structure::Distance => &self.in_place[..],
            Structure::Anisotropic => &self.by_octant[..],
        };
        sweeps.iter().for_each(|sweep| sweep.encode(encoder));
    }

    /// Turns occupied blocks into distances along x only.
    pub(super) fn encode_rows(&self, encoder: &mut wgpu::CommandEncoder) {
        self.in_place[..2].iter().for_each(|sweep| sweep.encode(encoder));
    }
}

/// The byte of empty blocks before any sweep.
pub(super) fn empty_byte(structure: Structure) -> u8 {
    match structure {
        Structure::Occupancy => 1,
        Structure::Distance | Structure::Anisotropic => u8::MAX,
    }
}
