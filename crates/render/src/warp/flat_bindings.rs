//! What quad and grid read.

use super::Shown;
use super::flat_uniform::WarpUniform;
use super::pass::{TEXTURE, float_texture, layout};
use crate::gpu::Gpu;
use crate::groups::bind;
use wgpu::util::DeviceExt as _;
use wheatstone_core::view::View;
use wheatstone_core::warp::{GridSettings, PixelMap};

/// How colours between pixels are found.
pub(super) struct Interpolation {
    colors: wgpu::BindingType,
    sampler: wgpu::SamplerBindingType,
    filter: wgpu::FilterMode,
    /// The file of the slot.
    pub(super) bilinear: &'static str,
}

/// By the sampler.
pub(super) const FILTERED: Interpolation = Interpolation {
    colors: float_texture(true),
    sampler: wgpu::SamplerBindingType::Filtering,
    filter: wgpu::FilterMode::Linear,
    bilinear: "lib/bilinear_filtered",
};

/// By the kernel.
pub(super) const LOADED: Interpolation = Interpolation {
    colors: TEXTURE,
    sampler: wgpu::SamplerBindingType::NonFiltering,
    filter: wgpu::FilterMode::Nearest,
    bilinear: "lib/bilinear_loaded",
};

/// A picture, and where the wanted view is.
#[derive(Debug)]
pub(super) struct FlatBindings {
    pub(super) layout: wgpu::BindGroupLayout,
    /// Of colours and of depths.
    samplers: [wgpu::Sampler; 2],
}

impl FlatBindings {
    pub(super) fn new(device: &wgpu::Device, interpolation: &Interpolation) -> Self {
        let samplers = [interpolation.sampler, wgpu::SamplerBindingType::NonFiltering];
        let [colors, depths] = samplers.map(wgpu::BindingType::Sampler);
        let layout = layout::<WarpUniform>(device, &[interpolation.colors, TEXTURE, colors, depths]);
        let samplers = [interpolation.filter, wgpu::FilterMode::Nearest].map(|filter| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("shown picture"),
                mag_filter: filter,
                min_filter: filter,
                ..Default::default()
            })
        });
        Self { layout, samplers }
    }

    pub(super) fn group(
        &self,
        gpu: &Gpu,
        map: &PixelMap,
        shown: &Shown<'_>,
        wanted: &View,
        settings: GridSettings,
    ) -> wgpu::BindGroup {
        let uniform = WarpUniform::new(map, shown, wanted, settings);
        let uniform = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("warp"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let [color, depth] = [&shown.target.color, &shown.target.depth]
            .map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let resources = [
            uniform.as_entire_binding(),
            wgpu::BindingResource::TextureView(&color),
            wgpu::BindingResource::TextureView(&depth),
            wgpu::BindingResource::Sampler(&self.samplers[0]),
            wgpu::BindingResource::Sampler(&self.samplers[1]),
        ];
        bind(&gpu.device, &self.layout, &resources)
    }
}
