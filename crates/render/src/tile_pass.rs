//! The tile pass: lists the tiles of a picture of which some ray may meet something.
//!
//! Software Vulkan runs the whole of a kernel for every eight rays in lockstep, also where all of them miss. A kernel that
//! only finds that out is far cheaper; the cast is then sent to the others alone.

use crate::buffers::storage;
use crate::gpu::{Gpu, GpuError};
use crate::groups::{Bindings, GroupLayouts, bind, layout, storage_buffer};
use crate::leap::Leap;
use crate::pipeline::{KernelFiles, build};
use crate::stamps::Stamps;
use wgpu::BufferUsages;
use wgpu::util::DeviceExt as _;
use wheatstone_core::cast::CastParameters;

/// Pixels of a tile along x and y: `TILE` of `lib/tile_list.wgsl`.
pub(crate) const TILE: [u32; 2] = [4, 2];

/// Workgroups of a cast along x: `GROUPS_PER_ROW` of `lib/tile_list.wgsl`.
pub(crate) const GROUPS_PER_ROW: u32 = 256;

/// By what tiles are listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Listing {
    /// Occupied blocks.
    Blocks,
    /// What the last picture saw first.
    Starts,
    /// Both.
    BlocksAndStarts,
}

impl Listing {
    const ALL: [Self; 3] = [Self::Blocks, Self::Starts, Self::BlocksAndStarts];

    /// Whether and how to list the tiles of a cast: on software Vulkan, where rays that meet no occupied block leave blank pixels.
    pub(crate) fn for_cast(gpu: &Gpu, parameters: &CastParameters, leap: &Leap<'_>) -> Option<Self> {
        let leaves_blank = parameters.has_first_hits() && matches!(leap, Leap::EmptyBlocks(_));
        (gpu.description().is_software && leaves_blank).then_some(Self::Blocks)
    }

    /// The same of the cast that leaps by what the last picture saw.
    pub(crate) fn of_leaping(gpu: &Gpu, listing: Option<Self>) -> Option<Self> {
        let by = if listing.is_some() { Self::BlocksAndStarts } else { Self::Starts };
        gpu.description().is_software.then_some(by)
    }

    /// The files of the kernel's slots.
    fn choices(self) -> [(&'static str, &'static str); 3] {
        let skip = if self == Self::Starts { "lib/skip_none" } else { "lib/skip_blocks" };
        let start = if self == Self::Blocks { "lib/start_at_once" } else { "lib/start_by_tile" };
        [("lib/skip", skip), ("lib/blocks", "lib/blocks_by_distance"), ("lib/start", start)]
    }
}

/// Tiles of a picture.
pub(crate) fn tiles_of([width, height]: [u32; 2]) -> u64 {
    u64::from(width.div_ceil(TILE[0])) * u64::from(height.div_ceil(TILE[1]))
}

/// The pipelines. Cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct TilePass {
    list_layout: wgpu::BindGroupLayout,
    /// In the order of [`Listing::ALL`].
    pipelines: [wgpu::ComputePipeline; 3],
    /// Arguments of a cast of no tiles.
    no_groups: wgpu::Buffer,
}

impl TilePass {
    /// Builds the pipelines; what the driver says against them comes with the next [`Gpu::check`].
    ///
    /// # Errors
    /// [`GpuError::Refused`] for files that make no module.
    pub(crate) fn new(device: &wgpu::Device, groups: &GroupLayouts) -> Result<Self, GpuError> {
        let list_layout = layout(device, "tile list", &[storage_buffer(12), storage_buffer(4)]);
        let layout = groups.pipeline_layout(device, "tiles", Some(&list_layout));
        let [blocks, starts, both] = Listing::ALL.map(|listing| {
            let choices = &listing.choices();
            build(device, Some(&layout), &KernelFiles { root: "tiles", choices, entry_point: "list_tiles" })
        });
        let pipelines = [blocks?, starts?, both?];
        let no_groups = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("no workgroups"),
            contents: bytemuck::cast_slice(&[GROUPS_PER_ROW, 0, 1]),
            usage: BufferUsages::COPY_SRC,
        });
        Ok(Self { list_layout, pipelines, no_groups })
    }

    /// The list of a picture: the one given if it has room.
    pub(crate) fn list(&self, device: &wgpu::Device, size: [u32; 2], kept: Option<TileList>) -> TileList {
        let tiles = tiles_of(size);
        if let Some(kept) = kept.filter(|list| list.is_listed.size() >= 4 * tiles) {
            return kept;
        }
        let buffer =
            |label, words, besides| storage(device, label, 4 * words, BufferUsages::COPY_DST | besides);
        let groups = buffer("workgroups", 3, BufferUsages::INDIRECT);
        let is_listed = buffer("listed", tiles, BufferUsages::empty());
        let tiles = buffer("tiles", 1 + tiles, BufferUsages::empty());
        let group =
            bind(device, &self.list_layout, &[groups.as_entire_binding(), is_listed.as_entire_binding()]);
        TileList { groups, tiles, is_listed, group }
    }

    /// Encodes the listing of a piece of squares of `BAND_ROWS` pixels along x and y, of which no tile has been listed in this
    /// picture.
    pub(crate) fn dispatch(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        (list, listing): (&TileList, Listing),
        bindings: &Bindings<'_>,
        [squares_x, squares_y]: [u32; 2],
        stamps: Stamps<'_>,
    ) {
        encoder.copy_buffer_to_buffer(&self.no_groups, 0, &list.groups, 0, None);
        encoder.clear_buffer(&list.tiles, 0, Some(4));
        let mut pass =
            bindings.begin_timed_pass(encoder, &self.pipelines[listing as usize], Some(&list.group), stamps);
        pass.dispatch_workgroups(squares_x, squares_y, 1);
    }
}

/// Tiles of a piece of a picture, each once per picture.
#[derive(Debug)]
pub(crate) struct TileList {
    /// Workgroups of the cast along x, y and z.
    pub(crate) groups: wgpu::Buffer,
    /// How many there are, and their numbers.
    pub(crate) tiles: wgpu::Buffer,
    /// 1 for each tile that has been in the list of a piece of the picture.
    is_listed: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl TileList {
    /// Forgets which tiles have been listed, before the first piece of a picture is.
    pub(crate) fn begin_picture(&self, encoder: &mut wgpu::CommandEncoder) {
        encoder.clear_buffer(&self.is_listed, 0, None);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;
    use crate::pacer::BAND_ROWS;
    use crate::shader::compose;

    #[test]
    fn the_pipelines_build_on_the_noop_device() {
        build_on_noop_device(|device| {
            TilePass::new(device, &GroupLayouts::new(device)).unwrap();
        });
    }

    #[test]
    fn constants_are_those_of_the_kernel() {
        let text = compose("tiles", &Listing::Blocks.choices()).unwrap().text;
        for line in [
            format!("const TILE = vec2u({}u, {}u);", TILE[0], TILE[1]),
            format!("const GROUPS_PER_ROW: u32 = {GROUPS_PER_ROW}u;"),
            format!("const BAND_ROWS: u32 = {BAND_ROWS}u;"),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }
}
