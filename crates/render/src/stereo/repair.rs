//! Tiles of the derived picture that are cast directly.

use super::PairError;
use super::pair::{PairFrame, PairReport};
use crate::cast_pass::{self, Workgroups};
use crate::gpu::Gpu;
use crate::groups::{Bindings, RAY_STATE_BYTES};
use crate::pacer::sample_limit;
use crate::renderer::{MOST_STATE_BYTES, Renderer};
use crate::target::Target;
use crate::tile_pass::{GROUPS_PER_ROW, tiles_of};
use crate::uniforms::ViewUniform;
use std::time::Duration;

/// Bytes of the arguments of an indirect dispatch: workgroups along x, y and z.
pub(crate) const GROUPS_BYTES: u64 = 12;

/// Tiles of a picture that are to be cast.
#[derive(Debug, Clone)]
pub(crate) struct RepairList {
    /// Workgroups of the cast along x, y and z.
    pub(crate) groups: wgpu::Buffer,
    /// How many there are, and their numbers.
    pub(crate) tiles: wgpu::Buffer,
}

impl RepairList {
    /// Room for all tiles of a picture.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let buffer = |label, size, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST | usage,
                mapped_at_creation: false,
            })
        };
        Self {
            groups: buffer("workgroups", GROUPS_BYTES, wgpu::BufferUsages::INDIRECT),
            tiles: buffer("tiles", tile_bytes(size), wgpu::BufferUsages::empty()),
        }
    }

    /// Whether there is room for all tiles of a picture.
    pub(crate) fn has_room(&self, size: [u32; 2]) -> bool {
        self.tiles.size() >= tile_bytes(size)
    }

    /// Empties the list.
    pub(crate) fn clear(&self, queue: &wgpu::Queue) {
        queue.write_buffer(&self.groups, 0, bytemuck::cast_slice(&[GROUPS_PER_ROW, 0, 1]));
        queue.write_buffer(&self.tiles, 0, bytemuck::bytes_of(&0_u32));
    }
}

/// Bytes of the number of listed tiles, and of all tiles of a picture.
fn tile_bytes(size: [u32; 2]) -> u64 {
    4 * (1 + tiles_of(size))
}

impl Renderer {
    /// Casts the listed tiles of the derived picture, waits until they are done and adds what that takes to the pair's report.
    pub(super) fn repair(
        &mut self,
        frame: &PairFrame<'_>,
        derived: &Target,
        pair: PairReport,
    ) -> Result<PairReport, PairError> {
        let PairFrame { gpu, prepared, epipolar, .. } = frame;
        let [width, height] = frame.size();
        let most_samples = prepared.parameters.most_samples_per_ray();
        let limit = sample_limit(most_samples, prepared.iterations_per_sample, 1.0);
        let is_whole = limit == u32::MAX;
        let state_bytes = if is_whole { 1 } else { u64::from(width) * u64::from(height) } * RAY_STATE_BYTES;
        if state_bytes > MOST_STATE_BYTES {
            return Err(PairError::LongRays { samples: most_samples });
        }
        let states = self.states(gpu, state_bytes);
        let target = self.target_group(gpu, derived, [&states, &frame.repairs.tiles]);
        let bindings = Bindings { frame: &prepared.frame, volume: &prepared.volume, target: &target };
        let variant = prepared.variant.of_listed_tiles();
        let pipeline = self.casts.pipeline(gpu, if is_whole { variant } else { variant.in_parts() })?;
        let mut view = ViewUniform::new(&prepared.parameters, epipolar.derived());
        view.sample_limit = limit;
        let mut repair = Duration::ZERO;
        while view.first_sample < most_samples {
            gpu.queue.write_buffer(&prepared.view_uniform, 0, bytemuck::bytes_of(&view));
            let workgroups = Workgroups::Listed(&frame.repairs.groups);
            repair += frame.run(|encoder| cast_pass::dispatch(encoder, &pipeline, &bindings, workgroups))?;
            view.first_sample = view.first_sample.saturating_add(limit);
        }
        let bytes = pair.bytes + GROUPS_BYTES + tile_bytes(frame.size()) + state_bytes;
        Ok(PairReport { bytes, repair, ..pair })
    }
}
