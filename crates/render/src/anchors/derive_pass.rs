//! The passes that make views of anchors.

use super::GpuSlabs;
use crate::buffers::storage;
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;
use crate::squares::Squares;
use crate::target::Target;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;
use wheatstone_core::lightfield::anchors::Source;

const LIST: KernelFiles<'_> =
    KernelFiles { root: "anchors/list_slabs", choices: &[], entry_point: "list_slabs" };

const DERIVE: KernelFiles<'_> = KernelFiles { root: "anchors/derive", choices: &[], entry_point: "derive" };

const ASK_BOTH: KernelFiles<'_> =
    KernelFiles { root: "anchors/ask_both", choices: &[], entry_point: "ask_both" };

/// Every kernel of these passes.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    vec![LIST, DERIVE, ASK_BOTH]
}

/// Bytes of `Unknown` of `lib/unknown.wgsl`: what is not known of a stack.
const UNKNOWN_BYTES: u64 = 80;

/// Mirror of `lib/shear.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct ShearUniform {
    size: [u32; 2],
    anchor_size: [u32; 2],
    first_square: [u32; 2],
    squares: [u32; 2],
    offset_px: f32,
    per_slab_px: f32,
    slab_count: u32,
    padding: u32,
}

/// Pipelines, and room for what is found out about a view.
#[derive(Debug)]
pub(crate) struct DerivePass {
    list: Kernel,
    derive: Kernel,
    ask_both: Kernel,
    room: Option<Room>,
}

/// Room for what is found out about a view of a size.
#[derive(Debug)]
struct Room {
    size: [u32; 2],
    /// Slabs of squares, two words each.
    listed: wgpu::Buffer,
    /// Rays where the nearest anchor does not see on.
    unknown: wgpu::Buffer,
}

impl Room {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Self {
        let buffer = |label, bytes| storage(&gpu.device, label, bytes, wgpu::BufferUsages::empty());
        let stacks = u64::from(size[0]) * u64::from(size[1].div_ceil(super::slabs::STACK_ROWS));
        let squares: u64 = size.map(|side| u64::from(side.div_ceil(super::slabs::SQUARE))).iter().product();
        Self {
            size,
            listed: buffer("slabs of squares", 8 * squares),
            unknown: buffer("unknown", UNKNOWN_BYTES * stacks),
        }
    }
}

impl DerivePass {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let [list, derive, ask_both] = [LIST, DERIVE, ASK_BOTH].map(|files| Kernel::new(&gpu.device, &files));
        let pass = Self { list: list?, derive: derive?, ask_both: ask_both?, room: None };
        gpu.check()?;
        Ok(pass)
    }

    /// Encodes the picture of a view into a target that is blank, within some squares, from its nearest anchor and another one (the same,
    /// if there is none).
    pub(super) fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        covered: &Squares,
        sources: [(&Source, &GpuSlabs); 2],
    ) {
        let size = target.size();
        let kept = self.room.take().filter(|room| room.size == size);
        let room = self.room.insert(kept.unwrap_or_else(|| Room::new(gpu, size)));
        let color = target.color.create_view(&wgpu::TextureViewDescriptor::default());
        let color = wgpu::BindingResource::TextureView(&color);
        let squares = covered.counts();
        let uniforms = sources.map(|(source, slabs)| {
            let uniform = ShearUniform {
                size,
                anchor_size: slabs.size,
                first_square: [covered.columns.start, covered.bands.start],
                squares,
                offset_px: source.offset_px as f32,
                per_slab_px: source.per_slab_px as f32,
                slab_count: slabs.slabs.count,
                padding: 0,
            };
            gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("shear"),
                contents: bytemuck::bytes_of(&uniform),
                usage: wgpu::BufferUsages::UNIFORM,
            })
        });
        let [nearest, other] = uniforms.each_ref().map(wgpu::Buffer::as_entire_binding);
        let [cells, cells_of_other] = sources.map(|(_, slabs)| slabs.cells.as_entire_binding());
        let [unknown, listed] = [&room.unknown, &room.listed].map(wgpu::Buffer::as_entire_binding);
        let pixels = [squares[0] * super::slabs::SQUARE, squares[1] * super::slabs::SQUARE, 1];
        let group = self.list.bind(&gpu.device, &[nearest.clone(), cells.clone(), listed.clone()]);
        self.list.dispatch(encoder, &group, [squares[0], squares[1], 1]);
        let resources = [nearest.clone(), cells.clone(), unknown.clone(), color.clone(), listed];
        self.derive.dispatch(encoder, &self.derive.bind(&gpu.device, &resources), pixels);
        let resources = [nearest, cells, unknown, color, other, cells_of_other];
        self.ask_both.dispatch(encoder, &self.ask_both.bind(&gpu.device, &resources), pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{assert_layout, compose};
    use wheatstone_core::lightfield::anchors::{LEAST_THROUGH, LEAST_UNKNOWN, MOST_BEHIND};

    #[test]
    fn it_matches_wgsl() {
        assert_layout!(
            "lib/shear",
            "Shear",
            ShearUniform,
            [size, anchor_size, first_square, squares, offset_px, per_slab_px, slab_count]
        );
    }

    #[test]
    fn constants_are_those_of_the_reference() {
        let text = compose(ASK_BOTH.root, ASK_BOTH.choices).unwrap().text;
        for line in [
            format!("const LEAST_THROUGH: f32 = {LEAST_THROUGH:?};"),
            format!("const LEAST_UNKNOWN: f32 = {LEAST_UNKNOWN:?};"),
            format!("const MOST_BEHIND: u32 = {MOST_BEHIND}u;"),
        ] {
            assert!(text.contains(&line), "{line}");
        }
    }
}
