//! Strips: the reference view cast row by row in strips of columns, the derived view composited from their rays' segments.
//!
//! Single-pass stereo (SP) without its layers: a strip composites segments into the derived columns that it reaches, in the
//! order in which they are made; where strips overlap, their sums are merged, for `over` is associative.

use super::PairError;
use super::pair::{Eye, PairFrame, PairReport};
use crate::cast_pass::VariantPipelines;
use crate::gpu::GpuError;
use crate::groups::{GroupLayouts, bind, layout, read_only_storage, storage_buffer};
use crate::uniforms::PairUniform;
use std::ops::Range;
use std::time::Duration;

/// Columns of a strip. More of them overlap less, fewer keep more processors busy.
const STRIP_COLUMNS: u32 = 64;

/// Bytes of what a strip leaves for a derived pixel: RGBA, and the depth of the first hit.
const PARTIAL_BYTES: [u64; 2] = [16, 4];

/// Pipelines.
#[derive(Debug)]
pub(crate) struct StripPass {
    strip_layout: wgpu::BindGroupLayout,
    cast: VariantPipelines,
    merge: VariantPipelines,
}

impl StripPass {
    /// Nothing built yet.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts) -> Self {
        let types = [read_only_storage::<PairUniform>(), storage_buffer(16), storage_buffer(4)];
        let strip_layout = layout(device, "strips", &types);
        let layout = groups.pipeline_layout(device, "strips", Some(&strip_layout));
        let merge = VariantPipelines::new(layout.clone(), "stereo/merge_strips", "merge_strips", &[]);
        let cast = VariantPipelines::new(
            layout,
            "stereo/cast_strips",
            "cast_strips",
            &[("lib/segment_sink", "stereo/sink_strips")],
        );
        Self { strip_layout, cast, merge }
    }

    /// Makes a pair.
    pub(crate) fn render(&mut self, frame: &PairFrame<'_>) -> Result<PairReport, PairError> {
        let pipeline = self.cast.pipeline(frame.gpu, frame.prepared.variant)?;
        let merge = self.merge.pipeline(frame.gpu, frame.prepared.variant)?;
        let buffers = self.buffers(frame)?;
        let bindings = frame.bind(Eye::Reference);
        let mut cast = Duration::ZERO;
        for columns in buffers.columns(frame.most_rays) {
            buffers.take(&frame.gpu.queue, &columns);
            cast += frame.run(|encoder| {
                let mut pass = bindings.begin_pass(encoder, &pipeline, Some(&buffers.group));
                let [_, bands] = frame.squares(Eye::Reference);
                pass.dispatch_workgroups(buffers.strips.count, bands, 1);
            })?;
        }
        let bindings = frame.bind(Eye::Derived);
        let composite = frame.run(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &merge, Some(&buffers.group));
            let [squares_x, squares_y] = frame.squares(Eye::Derived);
            pass.dispatch_workgroups(squares_x, squares_y, 1);
        })?;
        Ok(PairReport { bytes: buffers.byte_size, clear: Duration::ZERO, cast, composite })
    }

    /// Room for the partial sums of a pair; empty.
    fn buffers(&self, frame: &PairFrame<'_>) -> Result<StripBuffers, GpuError> {
        let PairFrame { gpu, epipolar, slabs, .. } = frame;
        let strips = PairUniform::new(epipolar, *slabs, &frame.columns, STRIP_COLUMNS);
        let height = u64::from(frame.size()[1]);
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
        let uniform_usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
        let uniform = buffer("strips", size_of::<PairUniform>() as u64, uniform_usage);
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
}

/// Partial sums of one pair of pictures.
#[derive(Debug)]
struct StripBuffers {
    strips: PairUniform,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
    byte_size: u64,
}

impl StripBuffers {
    /// Ranges of columns, counted from the last of each strip, that one dispatch each takes: no more than a number of them.
    fn columns(&self, most: u32) -> impl Iterator<Item = Range<u32>> + use<> {
        let step = most.clamp(1, STRIP_COLUMNS);
        (0..STRIP_COLUMNS).step_by(step as usize).map(move |begin| begin..(begin + step).min(STRIP_COLUMNS))
    }

    /// Chooses what the next dispatch takes of each strip.
    fn take(&self, queue: &wgpu::Queue, columns: &Range<u32>) {
        let strips = PairUniform { begin: columns.start, end: columns.end, ..self.strips };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&strips));
    }
}
