//! Strips: the reference view cast row by row in strips of columns, the derived view composited from their rays' segments.
//!
//! Single-pass stereo (SP) without its layers: a strip composites segments into the derived columns that it reaches, in the
//! order in which they are made; where strips overlap, their sums are merged, for `over` is associative.

use super::pair::{Eye, PairFrame, PairReport};
use super::repair::{MEASURE_FORMAT, Repair};
use super::{PairError, Quality, Splat};
use crate::buffers::{check_sizes, storage};
use crate::cast_pass::VariantPipelines;
use crate::gpu::{Gpu, GpuError};
use crate::groups::{GroupLayouts, bind, layout, storage_buffer, storage_texture};
use crate::pacer::{BAND_ROWS, ITERATION_LIMIT, LOCKSTEP_RAYS};
use crate::readback::read_buffer;
use crate::uniforms::PairUniform;
use std::time::{Duration, Instant};

/// Columns of a strip: two words of `lib/strip_bands.wgsl`. More of them overlap less, fewer keep more processors busy.
const STRIP_COLUMNS: u32 = 64;

/// Bytes of what a strip leaves for a derived pixel: RGBA.
const COLOR_BYTES: u64 = 16;

/// Bytes of what it leaves besides: the depth of the first hit.
const DEPTH_BYTES: u64 = 4;

/// Bytes of a row of a strip between dispatches: `Progress` of `cast_strips.wgsl`.
const PROGRESS_BYTES: u64 = 144;

/// Loop iterations of an invocation after which a GPU's dispatch ends, so that none runs for seconds.
const GPU_ITERATIONS: u32 = 1 << 18;

/// Samples of a stretch: `STRETCH` of `lib/ray_state.wgsl`.
const STRETCH: u32 = 16;

/// Loop iterations of a sample at most, besides shading: the largest `ITERATIONS_PER_SAMPLE` of a kernel.
const MOST_ITERATIONS_PER_SAMPLE: u32 = 5;

/// Bytes of a strip in a band of rows, and of what stands before all: `Strips` of `lib/strip_bands.wgsl`.
const BAND_BYTES: u64 = 16;

/// Bytes of what is known of 32 derived columns: two words of `lib/cuts_kept.wgsl`.
const CUT_BYTES: u64 = 8;

/// Derived columns of that.
const CUTS_PER_WORD: u64 = 32;

/// Files of kernels that do not ask for what ended rays leave out.
const CUTS_NONE: &[(&str, &str)] =
    &[("lib/segment_sink", "stereo/sink_strips"), ("lib/cuts", "lib/cuts_none")];

/// Files of kernels that do.
const CUTS_KEPT: &[(&str, &str)] =
    &[("lib/segment_sink", "stereo/sink_strips"), ("lib/cuts", "lib/cuts_kept")];

/// Pixels that a workgroup merges, along x and y: `TILES` of `lib/merged_tile.wgsl`.
const MERGED_PIXELS: [u32; 2] = [32, 8];

/// Pipelines, and the buffers of the last pair.
#[derive(Debug)]
pub(crate) struct StripPass {
    strip_layout: wgpu::BindGroupLayout,
    list: VariantPipelines,
    cast: VariantPipelines,
    merge: VariantPipelines,
    kept: Option<StripBuffers>,
    /// Whether the first dispatch of the last pair has left nothing to others.
    ends_at_once: bool,
}

/// What is sent off after a cast.
struct Derivation {
    merged: wgpu::SubmissionIndex,
    repaired: Option<wgpu::SubmissionIndex>,
}

impl Derivation {
    /// Waits until it is done, and returns what merging and repair have taken since.
    fn wait(self, gpu: &Gpu) -> Result<[Duration; 2], GpuError> {
        let start = Instant::now();
        gpu.wait_for(self.merged)?;
        let merged = start.elapsed();
        let Some(repaired) = self.repaired else { return Ok([merged, Duration::ZERO]) };
        gpu.wait_for(repaired)?;
        Ok([merged, start.elapsed() - merged])
    }
}

impl StripPass {
    /// Nothing built yet.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts, quality: Quality) -> Self {
        let (cuts, merge, entry_point) = match quality {
            Quality::Nearest | Quality::Fast => (CUTS_NONE, "stereo/merge_strips", "merge_strips"),
            Quality::Repaired => (CUTS_KEPT, "stereo/merge_and_measure", "merge_and_measure"),
        };
        let mut types =
            [COLOR_BYTES, DEPTH_BYTES, 2 * BAND_BYTES, PROGRESS_BYTES].map(storage_buffer).to_vec();
        if quality == Quality::Repaired {
            types.extend([storage_buffer(CUT_BYTES), storage_texture(MEASURE_FORMAT)]);
        }
        let files = [cuts, &[Splat::of(quality).file()]].concat();
        let strip_layout = layout(device, "strips", &types);
        let layout = groups.pipeline_layout(device, "strips", Some(&strip_layout));
        let merge = VariantPipelines::new(layout.clone(), merge, entry_point, cuts);
        let list = VariantPipelines::new(layout.clone(), "stereo/list_columns", "list_columns", &[]);
        let cast = VariantPipelines::new(layout, "stereo/cast_strips", "cast_strips", &files);
        Self { strip_layout, list, cast, merge, kept: None, ends_at_once: true }
    }

    /// Makes a pair. What follows the cast is sent off with it, before it is known whether it has ended, if that of the last
    /// pair had at once; if this one has not, it is sent again.
    pub(crate) fn render(
        &mut self,
        frame: &PairFrame<'_>,
        repair: Option<&Repair>,
    ) -> Result<PairReport, PairError> {
        let gpu = frame.gpu;
        let strips = PairUniform {
            iteration_limit: iteration_limit(frame)?,
            iterations_of_shading: frame.prepared.iterations_of_shading,
            lockstep_rays: LOCKSTEP_RAYS,
            ..frame.uniform(STRIP_COLUMNS)
        };
        let list = self.list.pipeline(gpu, frame.prepared.variant)?;
        let pipeline = self.cast.pipeline(gpu, frame.prepared.variant)?;
        let merge = self.merge.pipeline(gpu, frame.prepared.variant)?;
        let sizes = sizes(frame, &strips);
        let buffers = self.buffers(gpu, &sizes)?;
        let group = self.group(frame, &buffers);
        let [_, bands] = frame.squares(Eye::Reference);
        let derive = || -> Result<Derivation, GpuError> {
            let bindings = frame.bind(Eye::Derived, &strips);
            let merged = frame.send(|encoder| {
                let mut pass = bindings.begin_pass(encoder, &merge, Some(&group));
                let [x, y] = merged_workgroups(frame);
                pass.dispatch_workgroups(x, y, 1);
            });
            Ok(Derivation { merged, repaired: repair.map(|repair| repair.send(frame)).transpose()? })
        };

        let start = Instant::now();
        let bindings = frame.bind(Eye::Reference, &strips);
        buffers.finish_all(&gpu.queue);
        let sent = frame.send(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &list, Some(&group));
            pass.dispatch_workgroups(strips.count, bands, 1);
            pass.set_pipeline(&pipeline);
            pass.dispatch_workgroups(strips.count, bands, 1);
            drop(pass);
            buffers.count_unfinished(encoder);
        });
        let derived_at_once = self.ends_at_once.then(derive).transpose()?;
        gpu.wait_for(sent)?;
        let mut cast = start.elapsed();
        let mut times = derived_at_once.map(|derived| derived.wait(gpu)).transpose()?;
        self.ends_at_once = true;
        let resumed = PairUniform { is_resuming: 1, ..strips };
        while buffers.is_unfinished(gpu)? {
            (self.ends_at_once, times) = (false, None);
            let bindings = frame.bind(Eye::Reference, &resumed);
            buffers.finish_all(&gpu.queue);
            cast += frame.run(|encoder| {
                let mut pass = bindings.begin_pass(encoder, &pipeline, Some(&group));
                pass.dispatch_workgroups(strips.count, bands, 1);
                drop(pass);
                buffers.count_unfinished(encoder);
            })?;
        }
        let [composite, repair_time] = times.map_or_else(|| derive()?.wait(gpu), Ok)?;
        self.kept = Some(buffers);
        let bytes = sizes.iter().sum::<u64>() + repair.map_or(0, |repair| repair.bytes);
        Ok(PairReport { bytes, cast, composite, repair: repair_time, ..PairReport::default() })
    }

    /// Room for a pair: that of the last pair if it is large enough. Each strip empties its own sums.
    fn buffers(&mut self, gpu: &Gpu, sizes: &[u64]) -> Result<StripBuffers, GpuError> {
        let is_enough =
            |kept: &StripBuffers| kept.kept.iter().zip(sizes).all(|(kept, &size)| kept.size() >= size);
        match self.kept.take().filter(is_enough) {
            Some(kept) => Ok(kept),
            None => StripBuffers::new(gpu, sizes),
        }
    }

    fn group(&self, frame: &PairFrame<'_>, buffers: &StripBuffers) -> wgpu::BindGroup {
        let measures = frame
            .repairs
            .as_ref()
            .map(|repairs| repairs.measures.create_view(&wgpu::TextureViewDescriptor::default()));
        let buffers = buffers.kept.iter().map(wgpu::Buffer::as_entire_binding);
        let resources: Vec<_> =
            buffers.chain(measures.as_ref().map(wgpu::BindingResource::TextureView)).collect();
        bind(&frame.gpu.device, &self.strip_layout, &resources)
    }
}

/// Workgroups along x and y that have the derived picture's tiles.
pub(super) fn merged_workgroups(frame: &PairFrame<'_>) -> [u32; 2] {
    let [squares_x, squares_y] = frame.squares(Eye::Derived);
    let [pixels_x, pixels_y] = MERGED_PIXELS;
    [(squares_x * BAND_ROWS).div_ceil(pixels_x), (squares_y * BAND_ROWS).div_ceil(pixels_y)]
}

/// Bytes of the buffers of a pair: colours, depths, strips in bands, progress, and cuts if the pair is to be repaired.
fn sizes(frame: &PairFrame<'_>, strips: &PairUniform) -> Vec<u64> {
    let height = frame.size()[1];
    let strip_rows = u64::from(height) * u64::from(strips.count);
    let reach = u64::from(STRIP_COLUMNS + frame.slabs.layers() - 1);
    let sums = strip_rows * reach;
    let strip_bands = u64::from(height.div_ceil(BAND_ROWS)) * u64::from(strips.count);
    let cuts = frame.repairs.as_ref().map(|_| strip_rows * reach.div_ceil(CUTS_PER_WORD) * CUT_BYTES);
    let always =
        [sums * COLOR_BYTES, sums * DEPTH_BYTES, (1 + strip_bands) * BAND_BYTES, strip_rows * PROGRESS_BYTES];
    always.into_iter().chain(cuts).collect()
}

/// Partial sums of pairs of pictures.
#[derive(Debug)]
struct StripBuffers {
    /// Those of [`sizes`].
    kept: Vec<wgpu::Buffer>,
    /// Where the host reads how many rows of strips are not finished.
    unfinished: wgpu::Buffer,
}

impl StripBuffers {
    fn new(gpu: &Gpu, sizes: &[u64]) -> Result<Self, GpuError> {
        check_sizes(&gpu.device, "partial sums for stereo", sizes)?;
        let copied = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let kept = sizes.iter().map(|&size| storage(&gpu.device, "strips", size, copied)).collect();
        let unfinished = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("unfinished strips"),
            size: 4,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        gpu.check()?;
        Ok(Self { kept, unfinished })
    }

    fn bands(&self) -> &wgpu::Buffer {
        &self.kept[2]
    }

    /// Counts all rows of strips as finished, before a dispatch counts those that are not.
    fn finish_all(&self, queue: &wgpu::Queue) {
        queue.write_buffer(self.bands(), 0, bytemuck::bytes_of(&0_u32));
    }

    /// Encodes the copy of how many a dispatch leaves, after it.
    fn count_unfinished(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.copy_buffer_to_buffer(self.bands(), 0, &self.unfinished, 0, 4);
    }

    /// Whether the last dispatch has left anything to the next.
    fn is_unfinished(&self, gpu: &Gpu) -> Result<bool, GpuError> {
        let count: u32 = read_buffer(gpu, &self.unfinished, bytemuck::pod_read_unaligned)?;
        self.unfinished.unmap();
        Ok(count > 0)
    }
}

/// Loop iterations after which an invocation leaves the rest to the next dispatch.
///
/// Software Vulkan counts the iterations of eight invocations in lockstep: as many as that one has which does the most. An
/// invocation looks at its own after each stretch of samples.
///
/// # Errors
/// [`PairError::LongRays`] if a stretch may take more than there are.
fn iteration_limit(frame: &PairFrame<'_>) -> Result<u32, PairError> {
    if !frame.gpu.description().is_software {
        return Ok(GPU_ITERATIONS);
    }
    let samples = frame.parameters().most_samples_per_ray();
    let of_stretch = STRETCH * (MOST_ITERATIONS_PER_SAMPLE + frame.prepared.iterations_of_shading);
    let reach = STRIP_COLUMNS.saturating_add(frame.slabs.layers());
    let of_rays_in_turn = LOCKSTEP_RAYS.saturating_mul(samples.saturating_add(reach));
    let besides = of_rays_in_turn.saturating_add(of_stretch).saturating_add(reach.saturating_mul(2));
    let limit = ITERATION_LIMIT.saturating_sub(besides);
    if limit == 0 { Err(PairError::LongRays { samples }) } else { Ok(limit) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;
    use crate::shader::compose;

    #[test]
    fn the_passes_build_on_the_noop_device() {
        build_on_noop_device(|device| {
            for quality in [Quality::Nearest, Quality::Fast, Quality::Repaired] {
                let pass = StripPass::new(device, &GroupLayouts::new(device), quality);
                [pass.list, pass.cast, pass.merge]
                    .iter()
                    .for_each(|pipelines| pipelines.build_all_of_pairs(device));
            }
        });
    }

    #[test]
    fn constants_are_those_of_the_kernels() {
        let choices = [
            ("lib/join", "lib/join_over"),
            ("lib/cuts", "lib/cuts_kept"),
            ("lib/segment_sink", "stereo/sink_strips"),
            ("lib/accumulate", "lib/accumulate_composite"),
            ("lib/classify", "lib/classify_value"),
            ("lib/record", "lib/record_none"),
            ("lib/shade", "lib/shade_none"),
            ("lib/boundaries", "lib/boundaries_plain"),
            ("lib/gradient", "lib/gradient_central"),
            ("lib/skip", "lib/skip_none"),
            ("lib/volume", "lib/volume_filtered"),
        ];
        let text = compose("stereo/merge_and_measure", &choices).unwrap().text;
        let [x, y] = MERGED_PIXELS;
        for line in [
            format!("const TILES = vec2u({}u, {}u);", x / 4, y / 2),
            "const TILE = vec2u(4u, 2u);".to_owned(),
            format!("const STRETCH: u32 = {STRETCH}u;"),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }
}
