//! From occupied blocks to distances: one-sided sweeps along x, y and z, in place.

use super::field::{Field, FieldLayout};
use super::{OCTANTS, SkipKernels, Structure};
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;

/// Mirror of `lib/sweep.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
pub(super) struct SweepUniform {
    pub(super) lines: [u32; 2],
    pub(super) line_strides: [u32; 2],
    pub(super) length: u32,
    pub(super) start: u32,
    pub(super) step: u32,
    pub(super) padding: u32,
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
    fn new(layout: FieldLayout, axis: usize, side: Side) -> Self {
        let blocks = layout.blocks.map(|side| side as u32);
        let words = layout.words() as u32;
        let row = (layout.row_bytes() / 4) as u32;
        let layer = row * blocks[1];
        let (lines, line_strides, length, stride) = match axis {
            0 => ([blocks[1], blocks[2]], [row, layer], words, 1),
            1 => ([words, blocks[2]], [1, layer], blocks[1], row),
            _ => ([words, blocks[1]], [1, row], blocks[2], layer),
        };
        let (start, step) = match side {
            Side::Below => (0, stride),
            Side::Above => ((length - 1) * stride, stride.wrapping_neg()),
        };
        Self { lines, line_strides, length, start, step, padding: 0 }
    }
}

/// A sweep over one field.
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

/// A field with its sweeps along each axis, above and below.
#[derive(Debug)]
struct SweptField {
    field: Field,
    sweeps: [[Sweep; 2]; 3],
}

/// Fields for up to eight octants. Those that were once needed are kept.
#[derive(Debug)]
pub(super) struct DistancePass {
    kernels: SkipKernels,
    layout: FieldLayout,
    uniforms: [[(SweepUniform, wgpu::Buffer); 2]; 3],
    fields: Vec<SweptField>,
}

impl DistancePass {
    pub(super) fn new(gpu: &Gpu, kernels: &SkipKernels, layout: FieldLayout) -> Result<Self, GpuError> {
        let uniform = |axis, side| {
            let uniform = SweepUniform::new(layout, axis, side);
            let buffer = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("sweep"),
                contents: bytemuck::bytes_of(&uniform),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            (uniform, buffer)
        };
        let uniforms = [0, 1, 2].map(|axis| [uniform(axis, Side::Above), uniform(axis, Side::Below)]);
        let mut pass = Self { kernels: kernels.clone(), layout, uniforms, fields: Vec::new() };
        pass.reserve(gpu, Structure::Distance)?;
        Ok(pass)
    }

    /// Makes the fields that a structure needs.
    ///
    /// # Errors
    /// More blocks than the device can hold, no memory, a lost device.
    pub(super) fn reserve(&mut self, gpu: &Gpu, structure: Structure) -> Result<(), GpuError> {
        while self.fields.len() < field_count(structure) {
            let field = Field::new(gpu, self.layout)?;
            let sweep = |axis: usize, side: usize| {
                let kernel = match (axis, side) {
                    (0, 0) => &self.kernels.rows_down,
                    (0, _) => &self.kernels.rows_up,
                    _ => &self.kernels.columns,
                };
                let (uniform, buffer) = &self.uniforms[axis][side];
                let resources = [buffer.as_entire_binding(), field.buffer.as_entire_binding()];
                let group = kernel.bind(&gpu.device, &resources);
                Sweep { kernel: kernel.clone(), group, lines: uniform.lines }
            };
            let sweeps = [0, 1, 2].map(|axis| [sweep(axis, 0), sweep(axis, 1)]);
            self.fields.push(SweptField { field, sweeps });
        }
        Ok(())
    }

    /// The field that occupied blocks are written to: 0 for occupied, [`empty_byte`] for others.
    pub(super) fn occupied(&self) -> &Field {
        &self.fields[0].field
    }

    /// Fields of the octants of a structure, in order.
    pub(super) fn octants(&self, structure: Structure) -> impl Iterator<Item = &Field> {
        self.fields[..field_count(structure)].iter().map(|swept| &swept.field)
    }

    /// Bytes on the device.
    pub(super) fn byte_size(&self) -> u64 {
        self.fields.len() as u64 * self.layout.byte_size()
    }

    /// Turns occupied blocks into what a structure holds.
    pub(super) fn encode(&self, encoder: &mut wgpu::CommandEncoder, structure: Structure) {
        match structure {
            Structure::Occupancy => {}
            Structure::Distance => {
                self.fields[0].sweeps.iter().flatten().for_each(|sweep| sweep.encode(encoder));
            }
            Structure::Anisotropic => self.encode_octants(encoder),
        }
    }

    /// Turns occupied blocks into distances along x only.
    pub(super) fn encode_rows(&self, encoder: &mut wgpu::CommandEncoder) {
        self.fields[0].sweeps[0].iter().for_each(|sweep| sweep.encode(encoder));
    }

    /// Each axis splits every field in two, above and below: 2 + 4 + 8 sweeps (DM §3.6).
    fn encode_octants(&self, encoder: &mut wgpu::CommandEncoder) {
        for axis in 0..3 {
            let bit = 1 << axis;
            for octant in 0..bit {
                let (above, below) = (&self.fields[octant], &self.fields[octant | bit]);
                encoder.copy_buffer_to_buffer(
                    &above.field.buffer,
                    0,
                    &below.field.buffer,
                    0,
                    self.layout.byte_size(),
                );
                above.sweeps[axis][0].encode(encoder);
                below.sweeps[axis][1].encode(encoder);
            }
        }
    }
}

fn field_count(structure: Structure) -> usize {
    match structure {
        Structure::Occupancy | Structure::Distance => 1,
        Structure::Anisotropic => OCTANTS,
    }
}

/// The byte of empty blocks before any sweep.
pub(super) fn empty_byte(structure: Structure) -> u8 {
    match structure {
        Structure::Occupancy => 1,
        Structure::Distance | Structure::Anisotropic => u8::MAX,
    }
}
