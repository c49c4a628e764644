//! Space leaping from the last frame on the device: what a picture saw first, and where the rays of the next one start.

use crate::buffers::storage;
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;
use crate::readback::{read_buffer, read_texture};
use crate::renderer::Prepared;
use crate::squares::Squares;
use crate::target::target_texture;
use bytemuck::{Pod, Zeroable};
use glam::DVec4;
use wgpu::util::DeviceExt as _;
use wheatstone_core::first_hits::{FirstHits, Passage, margin_m, tiles_of};
use wheatstone_core::view::View;

/// Further away than anything, metres: `NOWHERE_M` of `lib/first_hits.wgsl`.
const NOWHERE_M: f32 = 1e30;

const STARTS: KernelFiles<'_> =
    KernelFiles { root: "first_hits/starts", choices: &[], entry_point: "find_starts" };

/// Every kernel of this pass.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    vec![STARTS]
}

/// Mirror of `lib/passage.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct PassageUniform {
    origin: [[f32; 4]; 3],
    direction: [[f32; 4]; 3],
    slab_depths_m: [f32; 12],
    last_size: [f32; 2],
    last_range_m: [f32; 2],
    size: [u32; 2],
    first_tile: [u32; 2],
    margin_m: f32,
    padding: [u32; 3],
}

impl PassageUniform {
    fn new(passage: &Passage, size: [u32; 2]) -> Self {
        let columns = |vectors: [DVec4; 3]| vectors.map(|v| v.as_vec4().to_array());
        let mut slab_depths_m = [0.0; 12];
        for (bound_m, &exact_m) in slab_depths_m.iter_mut().zip(&passage.slab_depths_m) {
            *bound_m = exact_m as f32;
        }
        let finite = |depth_m: f64| depth_m.clamp(-f64::from(NOWHERE_M), f64::from(NOWHERE_M)) as f32;
        let (nearest_m, furthest_m) = passage.last_range_m;
        Self {
            origin: columns(passage.origin),
            direction: columns(passage.direction),
            slab_depths_m,
            last_size: passage.last_size.map(|side| side as f32),
            last_range_m: [finite(nearest_m), finite(furthest_m)],
            size,
            margin_m: passage.margin_m as f32,
            ..Self::zeroed()
        }
    }

    /// That of a picture without a last one: rays start at once.
    fn at_once(size: [u32; 2]) -> Self {
        let mut slab_depths_m = [0.0; 12];
        slab_depths_m[0] = -NOWHERE_M;
        Self { slab_depths_m, size, ..Self::zeroed() }
    }
}

/// What a picture saw first, tile by tile, and where its own rays started.
#[derive(Debug)]
pub(crate) struct GpuFirstHits {
    /// Numbers of `lib/first_hits.wgsl`, one for each tile.
    pub(crate) nearness: wgpu::Buffer,
    /// Depths in metres, a texel for each tile.
    pub(crate) starts: wgpu::Texture,
    seen: Option<Seen>,
}

/// What a picture shows.
#[derive(Debug)]
struct Seen {
    view: View,
    /// [`Prepared::scene`].
    scene: u64,
    margin_m: f64,
}

impl GpuFirstHits {
    /// Room for those of pictures of a size.
    pub(crate) fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let [columns, rows] = tiles_of(size);
        let bytes = 4 * u64::from(columns) * u64::from(rows);
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let nearness = storage(&gpu.device, "first hits", bytes, usage);
        let starts = target_texture(gpu, "ray starts", wgpu::TextureFormat::R32Float, [columns, rows], 1);
        Self { nearness, starts, seen: None }
    }

    /// Another picture is made.
    pub(crate) fn forget(&mut self) {
        self.seen = None;
    }

    /// The picture is whole: the next one may leap by it if it was cast so as to note first hits.
    pub(crate) fn note(&mut self, prepared: &Prepared, view: &View) {
        let margin_m = margin_m(&prepared.parameters);
        let seen = Seen { view: *view, scene: prepared.scene, margin_m };
        self.seen = prepared.variant.leaps().then_some(seen);
    }

    /// Reads what the picture saw back.
    pub(crate) fn read(&self, gpu: &Gpu) -> Result<Option<FirstHits>, GpuError> {
        let Some(seen) = &self.seen else { return Ok(None) };
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("readback"),
            size: self.nearness.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&self.nearness, 0, &buffer, 0, None);
        gpu.queue.submit([encoder.finish()]);
        let nearest_m = read_buffer(gpu, &buffer, |bytes| {
            bytemuck::cast_slice(bytes).iter().map(|&nearness| depth_of(nearness)).collect()
        })?;
        Ok(Some(FirstHits::of_tiles(&seen.view, seen.margin_m, nearest_m)))
    }

    /// Reads back where rays started.
    pub(crate) fn read_starts(&self, gpu: &Gpu) -> Result<Vec<f32>, GpuError> {
        read_texture(gpu, &self.starts)
    }
}

/// `depth_of` of `lib/first_hits.wgsl`.
fn depth_of(nearness: u32) -> f32 {
    const SIGN: u32 = 1 << 31;
    match nearness {
        0 => f32::INFINITY,
        above if above & SIGN != 0 => -f32::from_bits(above & !SIGN),
        below => -f32::from_bits(!below),
    }
}

/// The pass that finds where rays start. Cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct StartPass {
    kernel: Kernel,
}

impl StartPass {
    /// Builds the kernel; what the driver says against it comes with the next [`Gpu::check`].
    ///
    /// # Errors
    /// [`GpuError::Refused`] for files that make no module.
    pub(crate) fn new(device: &wgpu::Device) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(device, &STARTS)? })
    }

    /// Encodes what comes before a picture is cast: nothing is seen yet, and the rays of the tiles that something may be in start by the
    /// last picture, if one is given that shows the same scene.
    pub(crate) fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        (prepared, view): (&Prepared, &View),
        hits: &GpuFirstHits,
        last: Option<&GpuFirstHits>,
    ) {
        encoder.clear_buffer(&hits.nearness, 0, None);
        let passage = last.and_then(|last| {
            let seen = last.seen.as_ref().filter(|seen| seen.scene == prepared.scene)?;
            let passage = Passage::between(view, &seen.view, seen.margin_m, &prepared.parameters)?;
            Some((PassageUniform::new(&passage, view.size), &last.nearness))
        });
        let nothing = storage(&gpu.device, "nothing seen", 4, wgpu::BufferUsages::empty());
        let (uniform, nearness) = passage.unwrap_or((PassageUniform::at_once(view.size), &nothing));
        // A square is a tile.
        let covered = Squares::covered(view, &prepared.occupied_corners_world());
        let uniform = PassageUniform { first_tile: [covered.columns.start, covered.bands.start], ..uniform };
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("passage"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let starts = hits.starts.create_view(&wgpu::TextureViewDescriptor::default());
        let resources = [
            uniform.as_entire_binding(),
            nearness.as_entire_binding(),
            wgpu::BindingResource::TextureView(&starts),
        ];
        let group = self.kernel.bind(&gpu.device, &resources);
        let [columns, rows] = covered.counts();
        self.kernel.dispatch(encoder, &group, [columns, rows, 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{assert_layout, compose};
    use wheatstone_core::first_hits::{MARGIN_PX, MOST_TILES, SLABS, TILE};

    #[test]
    fn it_matches_wgsl() {
        assert_layout!(
            "lib/passage",
            "Passage",
            PassageUniform,
            [origin, direction, slab_depths_m, last_size, last_range_m, size, first_tile, margin_m]
        );
    }

    #[test]
    fn constants_are_those_of_the_kernel() {
        let text = compose(STARTS.root, STARTS.choices).unwrap().text;
        for line in [
            format!("const HIT_TILE: u32 = {TILE}u;"),
            format!("const SLABS: u32 = {SLABS}u;"),
            format!("const MOST_TILES: u32 = {MOST_TILES}u;"),
            format!("const MARGIN_PX: f32 = {MARGIN_PX:?};"),
            format!("const NOWHERE_M: f32 = {NOWHERE_M:e};"),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }

    #[test]
    fn a_square_is_a_tile() {
        assert_eq!(TILE, crate::pacer::BAND_ROWS);
    }

    #[test]
    fn nearer_depths_have_larger_numbers() {
        let nearness_of = |depth_m: f32| {
            let bits = (-depth_m).to_bits();
            if bits >> 31 == 0 { bits | 1 << 31 } else { !bits }
        };
        let depths_m = [-3e4, -1.5, -1e-3, 0.0, 1e-3, 0.7, 2.0, 5e8];
        for pair in depths_m.windows(2) {
            assert!(nearness_of(pair[0]) > nearness_of(pair[1]), "{pair:?}");
        }
        for depth_m in depths_m {
            assert_eq!(depth_of(nearness_of(depth_m)), depth_m);
            assert!(nearness_of(depth_m) > 0);
        }
        assert_eq!(depth_of(0), f32::INFINITY);
    }
}
