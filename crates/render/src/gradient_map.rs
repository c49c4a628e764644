//! Gradient magnitudes of a volume, made on the device: the GPU twin of `wheatstone_core::gradient_map`.

use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::layers::{PaddedRows, copy_layers};
use crate::pipeline::KernelFiles;
use crate::readback::{read_buffer, read_texture};
use crate::skip::VoxelTexture;
use crate::volume::{GpuVolume, TexelFormat, byte_size, check_size, voxel_texture};
use bytemuck::{Pod, Zeroable};
use half::f16;
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::scene::GradientMethod;
use wheatstone_core::skip::RangeCodes;
use wheatstone_core::volume::StorageKind;

/// Most bytes of texels between the kernel and the texture.
const SLAB_BYTES: usize = 16 << 20;

const LARGEST: KernelFiles<'_> =
    KernelFiles { root: "gradient_map/largest", choices: &[], entry_point: "find_largest" };
const MAGNITUDES: KernelFiles<'_> =
    KernelFiles { root: "gradient_map/magnitudes", choices: &[], entry_point: "find_magnitudes" };

/// Mirror of `lib/gradient_uniform.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct GradientUniform {
    per_difference: [f32; 3],
    first_slice: u32,
    slices: u32,
    stored_per_sampled: f32,
    normalised_per_magnitude: f32,
    padding: u32,
}

/// Gradient magnitude of each voxel, 8 or 16 bits over the range from 0 to the largest, as a texture like the volume's.
#[derive(Debug, Clone)]
pub struct GpuGradientMap {
    pub(crate) view: wgpu::TextureView,
    dims: [usize; 3],
    format: TexelFormat,
    depth: GradientDepth,
    largest: f64,
}

impl GpuGradientMap {
    /// Estimates the gradients of the stored numbers, so that they do not depend on the window. Half floats hold the
    /// magnitudes where the device has no such texels.
    ///
    /// # Errors
    /// A map beyond the device's limits, no memory, a lost device.
    pub fn new(
        gpu: &Gpu,
        volume: &GpuVolume,
        method: GradientMethod,
        depth: GradientDepth,
    ) -> Result<Self, GpuError> {
        let kind = match depth {
            GradientDepth::Bits8 => StorageKind::U8,
            GradientDepth::Bits16 => StorageKind::U16,
        };
        let format = TexelFormat::choose(kind, gpu.capabilities(), gpu.description().is_software);
        Self::new_as(gpu, volume, method, format)
    }

    /// Estimates the gradients and holds them in a given format.
    ///
    /// # Errors
    /// As [`GpuGradientMap::new`].
    ///
    /// # Panics
    /// If the format is that of 32-bit floats.
    pub fn new_as(
        gpu: &Gpu,
        volume: &GpuVolume,
        method: GradientMethod,
        format: TexelFormat,
    ) -> Result<Self, GpuError> {
        let depth = match format {
            TexelFormat::R8Unorm | TexelFormat::R16FloatOf8Bit => GradientDepth::Bits8,
            TexelFormat::R16Unorm | TexelFormat::R16FloatOf16Bit => GradientDepth::Bits16,
            TexelFormat::R32Float | TexelFormat::Rgba8UnormQuads => {
                panic!("magnitudes are held in 8 or 16 bits of their own")
            }
        };
        check_size(gpu.capabilities(), volume.dims, format)?;
        let pass = GradientPass::new(gpu, volume, method);
        let largest = pass.largest(gpu)?;
        let view = pass.magnitudes(gpu, format, largest)?;
        let largest = f64::from(largest) * f64::from(pass.unit);
        Ok(Self { view, dims: volume.dims, format, depth, largest })
    }

    /// Voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Precision of the magnitudes.
    pub fn depth(&self) -> GradientDepth {
        self.depth
    }

    /// How the magnitudes are held.
    pub fn format(&self) -> TexelFormat {
        self.format
    }

    /// Bytes on the device.
    pub fn byte_size(&self) -> u64 {
        byte_size(self.dims, self.format)
    }

    /// The magnitude of the largest code, stored units per voxel length.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// Gradient of the stored numbers that a code stands for.
    pub(crate) fn stored_per_code(&self) -> f64 {
        self.largest / f64::from(self.depth.largest_code())
    }

    /// Scale from a sampled number to the magnitude of the normalised value's gradient per voxel length, before it is limited
    /// to 1. `value_scale` is that of [`wheatstone_core::volume::Encoding::normalised_from_stored`].
    pub(crate) fn normalised_from_sampled(&self, value_scale: f64) -> f64 {
        self.stored_per_code() * self.format.stored_per_sampled() * value_scale.abs()
    }

    /// The texture for the block ranges.
    pub(crate) fn voxels(&self) -> VoxelTexture<'_> {
        VoxelTexture {
            view: &self.view,
            dims: self.dims,
            format: self.format,
            codes: RangeCodes::of_gradients(self.depth),
        }
    }

    /// Reads the codes back, the first axis fastest.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u16>, GpuError> {
        let texture = self.view.texture();
        Ok(match self.format {
            TexelFormat::R8Unorm => read_texture::<u8>(gpu, texture)?.into_iter().map(u16::from).collect(),
            TexelFormat::R16FloatOf8Bit | TexelFormat::R16FloatOf16Bit => {
                let code_per_sampled = self.format.stored_per_sampled() as f32;
                let code = |half: f16| (half.to_f32() * code_per_sampled).round() as u16;
                read_texture::<f16>(gpu, texture)?.into_iter().map(code).collect()
            }
            TexelFormat::R16Unorm | TexelFormat::R32Float | TexelFormat::Rgba8UnormQuads => {
                read_texture(gpu, texture)?
            }
        })
    }
}

/// Passes over a volume's gradients, slab by slab.
struct GradientPass<'a> {
    volume: &'a GpuVolume,
    gradient: &'static str,
    /// Unit of the magnitudes, stored units per voxel length: the stored numbers' range, so that no square overflows.
    unit: f32,
    uniform: GradientUniform,
    uniform_buffer: wgpu::Buffer,
}

impl<'a> GradientPass<'a> {
    fn new(gpu: &Gpu, volume: &'a GpuVolume, method: GradientMethod) -> Self {
        let uniform_buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("gradient uniform"),
            size: size_of::<GradientUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let unit = volume.stored_range.max(f32::MIN_POSITIVE);
        let weight = match method {
            GradientMethod::CentralDifferences => 0.5,
            GradientMethod::Tetrahedron => 0.25,
        };
        let uniform = GradientUniform {
            per_difference: volume.spacing.map(|voxel_lengths| weight / voxel_lengths / unit),
            first_slice: 0,
            slices: 0,
            stored_per_sampled: volume.format().stored_per_sampled() as f32,
            normalised_per_magnitude: 0.0,
            padding: 0,
        };
        Self { volume, gradient: gradient_file(method), unit, uniform, uniform_buffer }
    }

    /// The largest magnitude, in units of `unit`.
    fn largest(&self, gpu: &Gpu) -> Result<f32, GpuError> {
        let choices = [("lib/voxel_gradient", self.gradient)];
        let kernel = Kernel::new(&gpu.device, &KernelFiles { choices: &choices, ..LARGEST })?;
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: 4,
                usage,
                mapped_at_creation: false,
            })
        };
        let largest = buffer(
            "largest gradient",
            wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
        );
        let readback =
            buffer("largest gradient", wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let group = self.bind(gpu, &kernel, &largest);
        let [width, height, depth] = self.volume.dims;
        let slab_slices = (SLAB_BYTES / (width * height)).clamp(1, depth);
        for first_slice in (0..depth).step_by(slab_slices) {
            let slices = slab_slices.min(depth - first_slice);
            self.run(gpu, self.slab(first_slice, slices), |encoder| {
                kernel.dispatch(encoder, &group, [width as u32, height as u32, 1]);
            })?;
        }
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&largest, 0, &readback, 0, 4);
        gpu.queue.submit([encoder.finish()]);
        read_buffer(gpu, &readback, bytemuck::pod_read_unaligned)
    }

    /// The texture of magnitudes; `largest` is in units of `unit`.
    fn magnitudes(
        &self,
        gpu: &Gpu,
        format: TexelFormat,
        largest: f32,
    ) -> Result<wgpu::TextureView, GpuError> {
        let choices = [("lib/voxel_gradient", self.gradient), ("lib/pack", pack_file(format))];
        let kernel = Kernel::new(&gpu.device, &KernelFiles { choices: &choices, ..MAGNITUDES })?;
        let [width, height, depth] = self.volume.dims;
        let row_bytes =
            (width * format.byte_size()).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize);
        let slab_slices = (SLAB_BYTES / (row_bytes * height)).clamp(1, depth);
        let texture = voxel_texture(gpu, "gradient map", self.volume.dims, format.wgpu());
        let slab = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("slab of gradients"),
            size: (row_bytes * height * slab_slices) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        gpu.check()?;
        let group = self.bind(gpu, &kernel, &slab);
        let words = (width * format.byte_size()).div_ceil(4);
        let rows = PaddedRows { buffer: &slab, first_byte: 0, row_bytes };
        for first_slice in (0..depth).step_by(slab_slices) {
            let slices = slab_slices.min(depth - first_slice);
            let normalised_per_magnitude = if largest > 0.0 { largest.recip() } else { 0.0 };
            let uniform = GradientUniform { normalised_per_magnitude, ..self.slab(first_slice, slices) };
            self.run(gpu, uniform, |encoder| {
                kernel.dispatch(encoder, &group, [words, height, slices].map(|side| side as u32));
                copy_layers(encoder, &rows, &texture, first_slice..first_slice + slices);
            })?;
        }
        Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
    }

    fn bind(&self, gpu: &Gpu, kernel: &Kernel, output: &wgpu::Buffer) -> wgpu::BindGroup {
        kernel.bind(
            &gpu.device,
            &[
                self.uniform_buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(&self.volume.texture),
                output.as_entire_binding(),
            ],
        )
    }

    fn slab(&self, first_slice: usize, slices: usize) -> GradientUniform {
        GradientUniform { first_slice: first_slice as u32, slices: slices as u32, ..self.uniform }
    }

    /// Submits the work on a slab and waits, so that one slab after the other keeps the device free for others.
    fn run(
        &self,
        gpu: &Gpu,
        uniform: GradientUniform,
        encode: impl FnOnce(&mut wgpu::CommandEncoder),
    ) -> Result<(), GpuError> {
        gpu.queue.write_buffer(&self.uniform_buffer, 0, bytemuck::bytes_of(&uniform));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encode(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        gpu.wait()
    }
}

fn gradient_file(method: GradientMethod) -> &'static str {
    match method {
        GradientMethod::CentralDifferences => "lib/voxel_gradient_central",
        GradientMethod::Tetrahedron => "lib/voxel_gradient_tetrahedron",
    }
}

fn pack_file(format: TexelFormat) -> &'static str {
    match format {
        TexelFormat::R8Unorm => "lib/pack_r8unorm",
        TexelFormat::R16FloatOf8Bit => "lib/pack_r16float_of_8bit",
        TexelFormat::R16FloatOf16Bit => "lib/pack_r16float_of_16bit",
        TexelFormat::R16Unorm | TexelFormat::R32Float | TexelFormat::Rgba8UnormQuads => "lib/pack_r16unorm",
    }
}

/// Every kernel of this module.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    const CENTRAL: (&str, &str) = ("lib/voxel_gradient", "lib/voxel_gradient_central");
    const TETRAHEDRON: (&str, &str) = ("lib/voxel_gradient", "lib/voxel_gradient_tetrahedron");
    let magnitudes = |choices| KernelFiles { choices, ..MAGNITUDES };
    vec![
        KernelFiles { choices: &[CENTRAL], ..LARGEST },
        KernelFiles { choices: &[TETRAHEDRON], ..LARGEST },
        magnitudes(&[CENTRAL, ("lib/pack", "lib/pack_r8unorm")]),
        magnitudes(&[CENTRAL, ("lib/pack", "lib/pack_r16unorm")]),
        magnitudes(&[TETRAHEDRON, ("lib/pack", "lib/pack_r16float_of_8bit")]),
        magnitudes(&[TETRAHEDRON, ("lib/pack", "lib/pack_r16float_of_16bit")]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::assert_layout;

    #[test]
    fn gradient_uniform_matches_wgsl() {
        assert_layout!(
            "lib/gradient_uniform",
            "GradientUniform",
            GradientUniform,
            [per_difference, first_slice, slices, stored_per_sampled, normalised_per_magnitude]
        );
    }
}
