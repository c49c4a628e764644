//! Which blocks can contribute to a picture: the GPU twin of [`wheatstone_core::skip::Occupancy`].
//!
//! What a code means for the settings is worked out on the CPU, code by code, so that the kernels only look it up and
//! decide exactly as the twin does.

use super::field::Field;
use super::table::Table;
use super::{GpuBlockRanges, SkipKernels};
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use wheatstone_core::skip::{SecondAxis, Visibility};

/// Ranges with the scale and offset from their stored numbers to normalised ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct NormalisedRanges<'a> {
    pub(super) ranges: &'a GpuBlockRanges,
    pub(super) normalised_from_stored: (f64, f64),
}

/// Tables and bind groups of the kernels. What was once needed is kept.
#[derive(Debug)]
pub(super) struct OccupancyPass {
    empty_and_row: wgpu::Buffer,
    by_value: ByValue,
    by_value_gradient: Option<ByValueGradient>,
}

/// For each code of a smallest value the lowest code of a largest value with which a block is occupied.
#[derive(Debug)]
struct ByValue {
    occupied_from: Table,
    kernel: Kernel,
    group: wgpu::BindGroup,
}

/// Entries of the codes, and the summed-area table over them.
#[derive(Debug)]
struct ByValueGradient {
    value_entries: Table,
    gradient_entries: Table,
    visible_before: Table,
    kernel: Kernel,
    group: wgpu::BindGroup,
}

impl OccupancyPass {
    /// A pass that writes to a field.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub(super) fn new(
        gpu: &Gpu,
        kernels: &SkipKernels,
        values: &GpuBlockRanges,
        field: &Field,
    ) -> Result<Self, GpuError> {
        let empty_and_row = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("empty and row"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let occupied_from = Table::by_code(gpu, values.codes(), wgpu::TextureFormat::R32Uint)?;
        let kernel = kernels.occupied_by_value.clone();
        let group = kernel.bind(
            &gpu.device,
            &[
                empty_and_row.as_entire_binding(),
                field.buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(&values.view()),
                wgpu::BindingResource::TextureView(&occupied_from.view()),
            ],
        );
        gpu.check()?;
        Ok(Self {
            empty_and_row,
            by_value: ByValue { occupied_from, kernel, group },
            by_value_gradient: None,
        })
    }

    /// Finds the occupied blocks, which get the byte 0; others get `empty`. Without gradient ranges any gradient may occur.
    ///
    /// # Errors
    /// No memory, a lost device.
    pub(super) fn encode(
        &mut self,
        gpu: &Gpu,
        kernels: &SkipKernels,
        encoder: &mut wgpu::CommandEncoder,
        (values, gradients): (NormalisedRanges<'_>, Option<NormalisedRanges<'_>>),
        visibility: &Visibility,
        (field, empty): (&Field, u8),
    ) -> Result<(), GpuError> {
        let empty_and_row = [u32::from(empty), field.row_words(), 0, 0];
        gpu.queue.write_buffer(&self.empty_and_row, 0, bytemuck::bytes_of(&empty_and_row));
        let (codes, map) = (values.ranges.codes(), values.normalised_from_stored);
        let (kernel, group) = match (visibility.second_axis(), gradients) {
            (SecondAxis::Gradient, Some(gradients)) => {
                let kept = self.by_value_gradient.take();
                let pass = match kept.filter(|kept| kept.fits(visibility)) {
                    Some(kept) => kept,
                    None => ByValueGradient::new(
                        gpu,
                        kernels,
                        (&self.empty_and_row, field),
                        [values.ranges, gradients.ranges],
                        visibility,
                    )?,
                };
                let rows =
                    visibility.gradient_entries(gradients.ranges.codes(), gradients.normalised_from_stored);
                pass.value_entries.write(gpu, &visibility.value_entries(codes, map));
                pass.gradient_entries.write(gpu, &rows);
                pass.visible_before.write(gpu, visibility.sums());
                let pass = self.by_value_gradient.insert(pass);
                (&pass.kernel, &pass.group)
            }
            _ => {
                self.by_value.occupied_from.write(gpu, &visibility.occupied_from(codes, map));
                (&self.by_value.kernel, &self.by_value.group)
            }
        };
        kernel.dispatch(encoder, group, field.invocations());
        Ok(())
    }
}

impl ByValueGradient {
    fn new(
        gpu: &Gpu,
        kernels: &SkipKernels,
        (empty_and_row, field): (&wgpu::Buffer, &Field),
        [values, gradients]: [&GpuBlockRanges; 2],
        visibility: &Visibility,
    ) -> Result<Self, GpuError> {
        let value_entries = Table::by_code(gpu, values.codes(), wgpu::TextureFormat::Rg16Uint)?;
        let gradient_entries = Table::by_code(gpu, gradients.codes(), wgpu::TextureFormat::Rg16Uint)?;
        let size = visibility.size().map(|side| side + 1);
        let visible_before = Table::new(gpu, size, wgpu::TextureFormat::R32Uint)?;
        let kernel = kernels.occupied_by_value_gradient.clone();
        let group = kernel.bind(
            &gpu.device,
            &[
                empty_and_row.as_entire_binding(),
                field.buffer.as_entire_binding(),
                wgpu::BindingResource::TextureView(&values.view()),
                wgpu::BindingResource::TextureView(&gradients.view()),
                wgpu::BindingResource::TextureView(&value_entries.view()),
                wgpu::BindingResource::TextureView(&gradient_entries.view()),
                wgpu::BindingResource::TextureView(&visible_before.view()),
            ],
        );
        gpu.check()?;
        Ok(Self { value_entries, gradient_entries, visible_before, kernel, group })
    }

    fn fits(&self, visibility: &Visibility) -> bool {
        self.visible_before.size() == visibility.size().map(|side| side + 1)
    }
}
