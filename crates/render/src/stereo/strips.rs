//! Strips: the reference view cast row by row in strips of columns, the derived view composited from their rays' segments.
//!
//! Single-pass stereo (SP) without its layers: a strip composites segments into the derived columns that it reaches, in the
//! order in which they are made; where strips overlap, their sums are merged, for `over` is associative.

use crate::cast_pass::{Variant, VariantPipelines};
use crate::gpu::{Gpu, GpuError};
use crate::groups::{Bindings, GroupLayouts, bind, layout, storage_buffer, uniform};
use crate::pipeline::{KernelFiles, build};
use crate::uniforms::StripUniform;
use std::ops::Range;
use wheatstone_core::stereo::{Epipolar, SlabRange};

/// Columns of a strip. More of them overlap less, fewer keep more processors busy.
const STRIP_COLUMNS: u32 = 64;

/// Bytes of what a strip leaves for a derived pixel: RGBA, and the depth of the first hit.
const PARTIAL_BYTES: [u64; 2] = [16, 4];

/// Pipelines.
#[derive(Debug)]
pub(crate) struct StripPass {
    strip_layout: wgpu::BindGroupLayout,
    cast: VariantPipelines,
    merge: wgpu::ComputePipeline,
}

impl StripPass {
    /// Builds the merging pipeline; what the driver says against it comes with the next [`Gpu::check`].
    ///
    /// # Errors
    /// [`GpuError::Refused`] for files that make no module.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts) -> Result<Self, GpuError> {
        let types = [uniform::<StripUniform>(), storage_buffer(16), storage_buffer(4)];
        let strip_layout = layout(device, "strips", &types);
        let layout = groups.pipeline_layout(device, "strips", Some(&strip_layout));
        let files = KernelFiles { root: "stereo/merge_strips", choices: &[], entry_point: "merge_strips" };
        let merge = build(device, Some(&layout), &files)?;
        let cast = VariantPipelines::new(layout, "stereo/cast_strips", "cast_strips");
        Ok(Self { strip_layout, cast, merge })
    }

    /// The casting pipeline of a variant, built when first asked for.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the driver does not take the kernel.
    pub(crate) fn pipeline(
        &mut self,
        gpu: &Gpu,
        variant: Variant,
    ) -> Result<wgpu::ComputePipeline, GpuError> {
        self.cast.pipeline(gpu, variant)
    }

    /// Room for the partial sums of a pair of pictures whose volume is in some slabs and sweep columns of rays; empty.
    ///
    /// # Errors
    /// [`GpuError::Refused`] if the device has no buffer of that size.
    pub(crate) fn buffers(
        &self,
        gpu: &Gpu,
        epipolar: &Epipolar,
        slabs: SlabRange,
        columns: &Range<i32>,
    ) -> Result<StripBuffers, GpuError> {
        let strips = StripUniform::new(epipolar, slabs, columns, STRIP_COLUMNS);
        let height = u64::from(epipolar.reference().size[1]);
        let slots = height * u64::from(strips.count) * u64::from(STRIP_COLUMNS + slabs.layers() - 1);
        let limits = gpu.device.limits();
        let largest = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if slots * PARTIAL_BYTES[0] > largest {
            let bytes = slots * PARTIAL_BYTES[0];
            return Err(GpuError::Refused {
                reason: format!("{bytes} bytes of partial sums for stereo; its buffers hold {largest}"),
            });
        }
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        let uniform_usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = buffer("strips", size_of::<StripUniform>() as u64, uniform_usage);
        let [partials, depths_m] =
            PARTIAL_BYTES.map(|bytes| buffer("partial sums", slots * bytes, wgpu::BufferUsages::STORAGE));
        let group = bind(
            &gpu.device,
            &self.strip_layout,
            &[uniform.as_entire_binding(), partials.as_entire_binding(), depths_m.as_entire_binding()],
        );
        gpu.check()?;
        let byte_size = slots * PARTIAL_BYTES.iter().sum::<u64>();
        Ok(StripBuffers { strips, uniform, group, byte_size })
    }

    /// Encodes the cast of a range of columns of every strip, counted from its last, over some bands of rows.
    pub(crate) fn cast(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        bindings: &Bindings<'_>,
        buffers: &StripBuffers,
        bands: u32,
    ) {
        let mut pass = bindings.begin_pass(encoder, pipeline, Some(&buffers.group));
        pass.dispatch_workgroups(buffers.strips.count, bands, 1);
    }

    /// Encodes the merge of squares of `BAND_ROWS` pixels along x and y.
    pub(crate) fn merge(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        bindings: &Bindings<'_>,
        buffers: &StripBuffers,
        [squares_x, squares_y]: [u32; 2],
    ) {
        let mut pass = bindings.begin_pass(encoder, &self.merge, Some(&buffers.group));
        pass.dispatch_workgroups(squares_x, squares_y, 1);
    }
}

/// Partial sums of one pair of pictures.
#[derive(Debug)]
pub(crate) struct StripBuffers {
    strips: StripUniform,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
    byte_size: u64,
}

impl StripBuffers {
    /// Bytes on the device.
    pub(crate) fn byte_size(&self) -> u64 {
        self.byte_size
    }

    /// Ranges of columns, counted from the last of each strip, that one dispatch each takes: no more than a number of them.
    pub(crate) fn columns(&self, most: u32) -> impl Iterator<Item = Range<u32>> + use<> {
        let step = most.clamp(1, STRIP_COLUMNS);
        (0..STRIP_COLUMNS).step_by(step as usize).map(move |begin| begin..(begin + step).min(STRIP_COLUMNS))
    }

    /// Chooses what the next dispatch takes of each strip.
    pub(crate) fn take(&self, queue: &wgpu::Queue, columns: &Range<u32>) {
        let strips = StripUniform { begin: columns.start, end: columns.end, ..self.strips };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&strips));
    }
}
