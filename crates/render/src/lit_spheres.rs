//! Lit spheres on the device.

use crate::gpu::Gpu;
use half::f16;
use wgpu::util::DeviceExt as _;
use wheatstone_core::lit_sphere::{LIT_SPHERE_SIDE, LitSphere};

/// The lit spheres of value 0 and of value 1 as `lib/shade_lit_sphere.wgsl` reads them: in slices, first what becomes of the colour
/// of each, then what becomes of the density.
pub(crate) fn texture(gpu: &Gpu, maps: &[LitSphere]) -> wgpu::TextureView {
    let of_color = |map: &LitSphere, i: usize| [0, 1, 2, 3].map(|channel| map.plane(channel)[i]);
    let of_density = |map: &LitSphere, i: usize| [map.plane(4)[i], 0.0, 0.0, 0.0];
    let slices = |texel: fn(&LitSphere, usize) -> [f32; 4]| {
        maps.iter().flat_map(move |map| (0..LIT_SPHERE_SIDE * LIT_SPHERE_SIDE).map(move |i| texel(map, i)))
    };
    let texels: Vec<f16> = slices(of_color).chain(slices(of_density)).flatten().map(f16::from_f32).collect();
    let side = LIT_SPHERE_SIDE as u32;
    let descriptor = wgpu::TextureDescriptor {
        label: Some("lit spheres"),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 2 * maps.len() as u32 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    gpu.device
        .create_texture_with_data(&gpu.queue, &descriptor, order, bytemuck::cast_slice(&texels))
        .create_view(&wgpu::TextureViewDescriptor::default())
}
