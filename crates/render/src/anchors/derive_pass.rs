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

/// Every kernel of these passes.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    vec![LIST, DERIVE]
}

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
    /// Slabs of squares, two words each.
    listed: Option<wgpu::Buffer>,
}

impl DerivePass {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let [list, derive] = [LIST, DERIVE].map(|files| Kernel::new(&gpu.device, &files));
        let pass = Self { list: list?, derive: derive?, listed: None };
        gpu.check()?;
        Ok(pass)
    }

    /// Encodes the picture of a view into a target that is blank, within some squares, from its nearest anchor.
    pub(super) fn encode(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &Target,
        covered: &Squares,
        (source, slabs): (&Source, &GpuSlabs),
    ) {
        let squares = covered.counts();
        let uniform = ShearUniform {
            size: target.size(),
            anchor_size: slabs.size,
            first_square: [covered.columns.start, covered.bands.start],
            squares,
            offset_px: source.offset_px as f32,
            per_slab_px: source.per_slab_px as f32,
            slab_count: slabs.slabs.count,
            padding: 0,
        };
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("shear"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let bytes = 8 * squares.map(u64::from).iter().product::<u64>();
        let kept = self.listed.take().filter(|listed| listed.size() >= bytes);
        let listed =
            self.listed.insert(kept.unwrap_or_else(|| {
                storage(&gpu.device, "slabs of squares", bytes, wgpu::BufferUsages::empty())
            }));
        let color = target.color.create_view(&wgpu::TextureViewDescriptor::default());
        let color = wgpu::BindingResource::TextureView(&color);
        let [shear, listed] = [&uniform, listed].map(wgpu::Buffer::as_entire_binding);
        let group = self.list.bind(&gpu.device, &[shear.clone(), slabs.bits(), listed.clone()]);
        self.list.dispatch(encoder, &group, [squares[0], squares[1], 1]);
        let group = self.derive.bind(&gpu.device, &[shear, slabs.planes(), color, listed]);
        let pixels = squares.map(|squares| squares * super::slabs::SQUARE);
        self.derive.dispatch(encoder, &group, [pixels[0], pixels[1], 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{assert_layout, compose};
    use wheatstone_core::lightfield::anchors::LEAST_THROUGH;

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
    fn rays_end_as_those_of_the_reference() {
        let text = compose(DERIVE.root, DERIVE.choices).unwrap().text;
        assert!(text.contains(&format!("const LEAST_THROUGH: f32 = {LEAST_THROUGH:?};")));
    }
}
