//! Repair: tiles of the derived picture that are cast directly.

use super::PairError;
use super::pair::{Eye, PairFrame};
use super::strips::merged_workgroups;
use crate::buffers::storage;
use crate::cast_pass::{self, Workgroups};
use crate::gpu::{Gpu, GpuError};
use crate::groups::{Bindings, GroupLayouts, bind, layout, storage_buffer};
use crate::pacer::sample_limit;
use crate::pipeline::{KernelFiles, build};
use crate::renderer::{MOST_STATE_BYTES, Renderer};
use crate::stamps::Stamps;
use crate::target::Target;
use crate::tile_pass::{GROUPS_PER_ROW, TILE, tiles_of};
use crate::uniforms::{PairUniform, ViewUniform};
use bytemuck::Zeroable as _;

/// Bytes of a `RepairPlan`.
pub(crate) const PLAN_BYTES: u64 = 4 * (4 + RATINGS as u64);

/// Kinds of tiles by the error expected of them: `RATINGS` of `stereo/list_repairs.wgsl`.
const RATINGS: usize = 64;

/// Format of what is measured of tiles.
pub(crate) const MEASURE_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Bytes of that.
const MEASURE_BYTES: u64 = 16;

/// What is found out about the tiles of a derived picture, and which of them are to be cast.
#[derive(Debug, Clone)]
pub(crate) struct Repairs {
    /// A `RepairPlan`, whose first words are the workgroups of the cast along x, y and z.
    pub(crate) plan: wgpu::Buffer,
    /// A pixel for each tile.
    pub(crate) measures: wgpu::Texture,
    /// How many tiles are to be cast, and their numbers.
    pub(crate) tiles: wgpu::Buffer,
}

impl Repairs {
    /// Room for the tiles of a picture.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let buffer =
            |label, size, besides| storage(&gpu.device, label, size, wgpu::BufferUsages::COPY_DST | besides);
        let [width, height] = tile_counts(size);
        let measures = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("measures"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: MEASURE_FORMAT,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        Self {
            plan: buffer("repair plan", PLAN_BYTES, wgpu::BufferUsages::INDIRECT),
            measures,
            tiles: buffer("tiles", tile_bytes(size), wgpu::BufferUsages::empty()),
        }
    }

    /// Whether there is room for the tiles of a picture.
    pub(crate) fn has_room(&self, size: [u32; 2]) -> bool {
        let [width, height] = tile_counts(size);
        self.measures.width() >= width
            && self.measures.height() >= height
            && self.tiles.size() >= tile_bytes(size)
    }

    /// Bytes on the device.
    fn bytes(&self) -> u64 {
        let measures = u64::from(self.measures.width()) * u64::from(self.measures.height()) * MEASURE_BYTES;
        self.plan.size() + measures + self.tiles.size()
    }

    /// Forgets the last picture.
    fn clear(&self, queue: &wgpu::Queue) {
        let mut plan = [0; 4 + RATINGS];
        [plan[0], plan[2]] = [GROUPS_PER_ROW, 1];
        queue.write_buffer(&self.plan, 0, bytemuck::cast_slice(&plan));
        queue.write_buffer(&self.tiles, 0, bytemuck::bytes_of(&0_u32));
    }
}

/// Tiles of a picture along x and y.
fn tile_counts([width, height]: [u32; 2]) -> [u32; 2] {
    [width.div_ceil(TILE[0]), height.div_ceil(TILE[1])]
}

/// Bytes of the number of listed tiles, and of all tiles of a picture.
fn tile_bytes(size: [u32; 2]) -> u64 {
    4 * (1 + tiles_of(size))
}

/// The pass that lists what is to be cast.
#[derive(Debug, Clone)]
pub(crate) struct RepairPass {
    own_layout: wgpu::BindGroupLayout,
    count: wgpu::ComputePipeline,
    choose: wgpu::ComputePipeline,
    list: wgpu::ComputePipeline,
}

impl RepairPass {
    /// Builds the pipelines; what the driver says against them comes with the next [`Gpu::check`].
    ///
    /// # Errors
    /// [`GpuError::Refused`] for files that make no module.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts) -> Result<Self, GpuError> {
        let measures = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let own_layout = layout(device, "repairs", &[storage_buffer(PLAN_BYTES), measures]);
        let layout = groups.pipeline_layout(device, "repairs", Some(&own_layout));
        let [count, choose, list] = ["count_ratings", "choose_ratings", "list_repairs"].map(|entry_point| {
            let files = KernelFiles { root: "stereo/list_repairs", choices: &[], entry_point };
            build(device, Some(&layout), &files)
        });
        Ok(Self { own_layout, count: count?, choose: choose?, list: list? })
    }

    /// Encodes the listing of what is to be cast of the derived picture.
    fn dispatch(&self, encoder: &mut wgpu::CommandEncoder, frame: &PairFrame<'_>, repairs: &Repairs) {
        let measures = repairs.measures.create_view(&wgpu::TextureViewDescriptor::default());
        let resources = [repairs.plan.as_entire_binding(), wgpu::BindingResource::TextureView(&measures)];
        let group = bind(&frame.gpu.device, &self.own_layout, &resources);
        let bindings = frame.bind(Eye::Derived, &PairUniform::zeroed());
        let [x, y] = merged_workgroups(frame);
        let mut pass = bindings.begin_pass(encoder, &self.count, Some(&group));
        pass.dispatch_workgroups(x, y, 1);
        pass.set_pipeline(&self.choose);
        pass.dispatch_workgroups(1, 1, 1);
        pass.set_pipeline(&self.list);
        pass.dispatch_workgroups(x, y, 1);
    }
}

/// A repair of a derived picture, ready to be sent off.
#[derive(Debug)]
pub(crate) struct Repair {
    /// Bytes on the device.
    pub(crate) bytes: u64,
    repairs: Repairs,
    pass: RepairPass,
    target: wgpu::BindGroup,
    pipeline: wgpu::ComputePipeline,
    /// Samples of a ray in one dispatch.
    sample_limit: u32,
}

impl Repair {
    /// Sends off the listing of what is to be cast of the derived picture, and its cast. Waits for all dispatches but the last,
    /// and returns that submission.
    pub(crate) fn send(&self, frame: &PairFrame<'_>) -> Result<wgpu::SubmissionIndex, GpuError> {
        let PairFrame { gpu, prepared, epipolar, .. } = frame;
        self.repairs.clear(&gpu.queue);
        let mut sent = frame.send(|encoder| self.pass.dispatch(encoder, frame, &self.repairs));
        let bindings = Bindings { frame: &prepared.frame, volume: &prepared.volume, target: &self.target };
        let mut view = ViewUniform::new(&prepared.parameters, epipolar.derived());
        view.sample_limit = self.sample_limit;
        while view.first_sample < prepared.parameters.most_samples_per_ray() {
            if view.first_sample > 0 {
                gpu.wait_for(sent)?;
            }
            gpu.queue.write_buffer(&prepared.view_uniform, 0, bytemuck::bytes_of(&view));
            let workgroups = Workgroups::Listed(&self.repairs.plan);
            sent = frame.send(|encoder| {
                cast_pass::dispatch(encoder, &self.pipeline, &bindings, workgroups, Stamps::NONE);
            });
            view.first_sample = view.first_sample.saturating_add(self.sample_limit);
        }
        Ok(sent)
    }
}

impl Renderer {
    /// Makes ready to cast what is not to be derived of a picture.
    pub(super) fn ready_repair(
        &mut self,
        frame: &PairFrame<'_>,
        repairs: &Repairs,
        derived: &Target,
    ) -> Result<Repair, PairError> {
        let PairFrame { gpu, prepared, .. } = frame;
        let [width, height] = frame.size();
        let most_samples = prepared.parameters.most_samples_per_ray();
        let sample_limit = sample_limit(most_samples, prepared.iterations_per_sample, 1.0);
        let is_whole = sample_limit == u32::MAX;
        let rays = if is_whole { 1 } else { u64::from(width) * u64::from(height) };
        let state_bytes = rays * prepared.variant.state_bytes();
        if state_bytes > MOST_STATE_BYTES {
            return Err(PairError::LongRays { samples: most_samples });
        }
        let states = self.states(gpu, state_bytes);
        let variant = prepared.variant.of_listed_tiles();
        Ok(Repair {
            bytes: repairs.bytes() + state_bytes,
            target: self.target_group(gpu, derived, [&states, &repairs.tiles]),
            pipeline: self.casts.pipeline(gpu, if is_whole { variant } else { variant.in_parts() })?,
            pass: self.repair_pass(gpu)?.clone(),
            repairs: repairs.clone(),
            sample_limit,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;
    use crate::shader::compose;

    #[test]
    fn the_pass_builds_on_the_noop_device() {
        build_on_noop_device(|device| {
            RepairPass::new(device, &GroupLayouts::new(device)).unwrap();
        });
    }

    #[test]
    fn constants_are_those_of_the_kernels() {
        let text = compose("stereo/list_repairs", &[]).unwrap().text;
        assert!(text.contains(&format!("const RATINGS: u32 = {RATINGS}u;")));
    }
}
