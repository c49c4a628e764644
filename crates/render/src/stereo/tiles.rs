//! Tiles: the reference view cast by workgroups that own a row of neighbouring columns, and composite the derived view from
//! the segments in their memory; the tiles' sums are merged as those of strips.
//!
//! More rays are cast at once than in strips, on devices that have the processors. Nothing is emptied: a tile writes all of
//! its sums.

use super::pair::{Eye, PairFrame, PairReport};
use super::{PairError, Quality, Splat};
use crate::buffers::{check_sizes, storage};
use crate::cast_pass::VariantPipelines;
use crate::gpu::{Gpu, GpuError};
use crate::groups::{GroupLayouts, bind, layout, storage_buffer};
use crate::pacer::BAND_ROWS;

/// Columns of a tile: `TILE_COLUMNS` of `stereo/sink_tiles.wgsl`.
const TILE_COLUMNS: u32 = 32;

/// Bytes of what a tile leaves for a derived pixel: RGBA, and the depth of the first hit.
const PARTIAL_BYTES: [u64; 2] = [16, 4];

/// Files of the kernels' slots.
const FILES: &[(&str, &str)] = &[("lib/segment_sink", "stereo/sink_tiles"), ("lib/cuts", "lib/cuts_none")];

/// Pipelines, and the buffers of the last pair.
#[derive(Debug)]
pub(crate) struct PairTilePass {
    tile_layout: wgpu::BindGroupLayout,
    cast: VariantPipelines,
    merge: VariantPipelines,
    kept: Option<TileBuffers>,
}

impl PairTilePass {
    /// Nothing built yet.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts, quality: Quality) -> Self {
        let files = [FILES, &[Splat::of(quality).file()]].concat();
        let types = [storage_buffer(PARTIAL_BYTES[0]), storage_buffer(PARTIAL_BYTES[1])];
        let tile_layout = layout(device, "pair tiles", &types);
        let layout = groups.pipeline_layout(device, "pair tiles", Some(&tile_layout));
        let merge = VariantPipelines::new(layout.clone(), "stereo/merge_tiles", "merge_tiles", FILES);
        let cast = VariantPipelines::new(layout, "stereo/cast_tiles", "cast_tiles", &files);
        Self { tile_layout, cast, merge, kept: None }
    }

    /// Makes a pair.
    pub(crate) fn render(&mut self, frame: &PairFrame<'_>) -> Result<PairReport, PairError> {
        frame.check_whole_rays()?;
        let PairFrame { gpu, slabs, .. } = frame;
        let pipeline = self.cast.pipeline(gpu, frame.prepared.variant)?;
        let merge = self.merge.pipeline(gpu, frame.prepared.variant)?;
        let tiles = frame.uniform(TILE_COLUMNS);
        let rows = frame.size()[1].next_multiple_of(BAND_ROWS);
        let reached = u64::from(rows) * u64::from(tiles.count) * u64::from(TILE_COLUMNS + slabs.layers() - 1);
        let buffers = match self.kept.take() {
            Some(kept) if kept.reached >= reached => kept,
            _ => TileBuffers::new(gpu, &self.tile_layout, reached)?,
        };
        let bindings = frame.bind(Eye::Reference, &tiles);
        let cast = frame.run(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &pipeline, Some(&buffers.group));
            let [_, bands] = frame.squares(Eye::Reference);
            pass.dispatch_workgroups(tiles.count, bands, BAND_ROWS);
        })?;
        let bindings = frame.bind(Eye::Derived, &tiles);
        let composite = frame.run(|encoder| {
            let mut pass = bindings.begin_pass(encoder, &merge, Some(&buffers.group));
            let [squares_x, squares_y] = frame.squares(Eye::Derived);
            pass.dispatch_workgroups(squares_x, squares_y, 1);
        })?;
        let bytes = reached * PARTIAL_BYTES.iter().sum::<u64>();
        self.kept = Some(buffers);
        Ok(PairReport { bytes, cast, composite, ..PairReport::default() })
    }
}

/// Partial sums of tiles.
#[derive(Debug)]
struct TileBuffers {
    /// Derived pixels that tiles reach, each counted once for each tile.
    reached: u64,
    group: wgpu::BindGroup,
}

impl TileBuffers {
    fn new(gpu: &Gpu, layout: &wgpu::BindGroupLayout, reached: u64) -> Result<Self, GpuError> {
        let [color_bytes, depth_bytes] = PARTIAL_BYTES.map(|bytes| reached * bytes);
        check_sizes(&gpu.device, "partial sums for stereo", &[color_bytes, depth_bytes])?;
        let buffer = |label, size| storage(&gpu.device, label, size, wgpu::BufferUsages::empty());
        let partials = buffer("partial sums", color_bytes);
        let depths_m = buffer("partial depths", depth_bytes);
        let group = bind(&gpu.device, layout, &[&partials, &depths_m].map(wgpu::Buffer::as_entire_binding));
        gpu.check()?;
        Ok(Self { reached, group })
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
            for quality in [Quality::Nearest, Quality::Fast] {
                let pass = PairTilePass::new(device, &GroupLayouts::new(device), quality);
                [pass.cast, pass.merge].iter().for_each(|pipelines| pipelines.build_all_of_pairs(device));
            }
        });
    }

    #[test]
    fn constants_are_those_of_the_kernel() {
        let text = compose("stereo/sink_tiles", &[("lib/join", "lib/join_over")]).unwrap().text;
        assert!(text.contains(&format!("const TILE_COLUMNS: u32 = {TILE_COLUMNS}u;")));
    }
}
