//! The pass that fills what an anchor does not see.

use super::GpuSlabs;
use crate::buffers::storage;
use crate::gpu::{Gpu, GpuError};
use crate::kernel::Kernel;
use crate::pipeline::KernelFiles;
use bytemuck::{Pod, Zeroable};
use wgpu::util::DeviceExt as _;
use wheatstone_core::lightfield::anchors::Source;

const FILL: KernelFiles<'_> = KernelFiles { root: "anchors/fill", choices: &[], entry_point: "fill" };

/// Every kernel of this pass.
#[cfg(test)]
pub(crate) fn kernel_files() -> Vec<KernelFiles<'static>> {
    vec![FILL]
}

/// Mirror of `anchors/fill.wgsl`, where the fields are described.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct FillUniform {
    size: [u32; 2],
    widths: [u32; 2],
    offsets_px: [f32; 2],
    per_slab_px: [f32; 2],
    neighbour_count: u32,
    slab_count: u32,
}

/// The pipeline.
#[derive(Debug)]
pub(crate) struct FillPass {
    fill: Kernel,
    /// In place of an anchor where there is none.
    nothing: wgpu::Buffer,
}

impl FillPass {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let fill = Kernel::new(&gpu.device, &FILL)?;
        gpu.check()?;
        Ok(Self { fill, nothing: storage(&gpu.device, "no anchor", 16, wgpu::BufferUsages::empty()) })
    }

    /// Encodes the filling of an anchor by at most two that are next to it.
    pub(super) fn encode(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        own: &GpuSlabs,
        neighbours: &[(Source, &GpuSlabs)],
    ) {
        let mut uniform = FillUniform {
            size: own.size,
            neighbour_count: neighbours.len() as u32,
            slab_count: own.slabs.count,
            ..FillUniform::zeroed()
        };
        let mut planes = [0, 1].map(|_| self.nothing.as_entire_binding());
        for (i, (source, slabs)) in neighbours.iter().enumerate() {
            uniform.widths[i] = slabs.size[0];
            uniform.offsets_px[i] = source.offset_px as f32;
            uniform.per_slab_px[i] = source.per_slab_px as f32;
            planes[i] = slabs.planes();
        }
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("fill"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let [first, second] = planes;
        let resources = [uniform.as_entire_binding(), own.bits(), own.planes(), first, second];
        let [width, height] = own.size;
        self.fill.dispatch(encoder, &self.fill.bind(&gpu.device, &resources), [width, height, 1]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shader::{assert_layout, compose};
    use wheatstone_core::lightfield::anchors::MOST_BEHIND;

    #[test]
    fn it_matches_wgsl() {
        assert_layout!(
            "anchors/fill",
            "Fill",
            FillUniform,
            [size, widths, offsets_px, per_slab_px, neighbour_count, slab_count]
        );
        let text = compose(FILL.root, FILL.choices).unwrap().text;
        assert!(text.contains(&format!("const MOST_BEHIND: u32 = {MOST_BEHIND}u;")));
    }
}
