//! Pipelines that keep views and draw them, and what they are kept in.

use crate::viewer::state::Arrangement;
use std::collections::HashMap;
use wheatstone_core::lightfield::simulator::SeenView;

/// Of kept views: what a display shows, and what is interpolated fastest.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Of the views that a panel's sub-pixels show.
const SHOWN_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Uint;

/// What `tiles.wgsl` reads.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct TilesUniform {
    pub(super) background: [f32; 3],
    pub(super) views: u32,
    pub(super) area: [f32; 4],
    pub(super) tile: [u32; 2],
    pub(super) grid: [u32; 2],
    pub(super) panel: [u32; 2],
    pub(super) begins_below: u32,
    pub(super) flips: [u32; 2],
    pub(super) padding: [u32; 3],
}

/// What `tiles.wgsl` reads of a view that is seen in a column.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
pub(super) struct SeenUniform {
    view: u32,
    weight: f32,
    along: f32,
    top: f32,
    bottom: f32,
}

impl From<&SeenView> for SeenUniform {
    fn from(seen: &SeenView) -> Self {
        let [top, bottom] = seen.down.map(|share| share as f32);
        Self { view: seen.index as u32, weight: seen.weight as f32, along: seen.along as f32, top, bottom }
    }
}

/// Pipelines, and what they take besides pictures.
pub(super) struct Passes {
    keep_layout: wgpu::BindGroupLayout,
    keep: wgpu::RenderPipeline,
    pub(super) layout: wgpu::BindGroupLayout,
    pub(super) pipelines: HashMap<Arrangement, wgpu::RenderPipeline>,
    pub(super) sampler: wgpu::Sampler,
}

impl Passes {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let texture = |binding, sample_type, view_dimension| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false },
            count: None,
        };
        let buffer = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let sampler = wgpu::BindGroupLayoutEntry {
            binding: 2,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let layout = |label, entries: &[wgpu::BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let read_only = wgpu::BufferBindingType::Storage { read_only: true };
        let exact = wgpu::TextureSampleType::Float { filterable: false };
        let filtered = wgpu::TextureSampleType::Float { filterable: true };
        let keep_layout = layout("keep", &[texture(0, exact, wgpu::TextureViewDimension::D2)]);
        let tiles_layout = layout(
            "tiles",
            &[
                buffer(0, wgpu::BufferBindingType::Uniform),
                texture(1, filtered, wgpu::TextureViewDimension::D2Array),
                sampler,
                buffer(3, read_only),
                buffer(4, read_only),
                texture(5, wgpu::TextureSampleType::Uint, wgpu::TextureViewDimension::D2),
            ],
        );
        let everywhere = device.create_shader_module(wgpu::include_wgsl!("../show.wgsl"));
        let pipeline = |layout: &wgpu::BindGroupLayout, module: &wgpu::ShaderModule, entry_point, format| {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            });
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                vertex: wgpu::VertexState {
                    module: &everywhere,
                    entry_point: Some("everywhere"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                fragment: Some(wgpu::FragmentState {
                    module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState::from(format))],
                }),
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
        };
        let keep = device.create_shader_module(wgpu::include_wgsl!("keep.wgsl"));
        let tiles = device.create_shader_module(wgpu::include_wgsl!("tiles.wgsl"));
        let pipelines = [
            (Arrangement::Quilt, "quilt"),
            (Arrangement::LightField, "light_field"),
            (Arrangement::Panel, "panel"),
        ]
        .into_iter()
        .map(|(arrangement, entry_point)| (arrangement, pipeline(&tiles_layout, &tiles, entry_point, format)))
        .collect();
        Self {
            keep: pipeline(&keep_layout, &keep, "keep", FORMAT),
            keep_layout,
            layout: tiles_layout,
            pipelines,
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("interpolated"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }

    /// Encodes the keeping of a view in a layer.
    pub(super) fn keep(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        cast: &wgpu::TextureView,
        layers: &wgpu::Texture,
        layer: u32,
    ) {
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("keep"),
            layout: &self.keep_layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(cast),
            }],
        });
        let into = layers.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Default::default()
        });
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("keep"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &into,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(&self.keep);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
    }
}

/// Room for views of a size.
pub(super) fn layers(device: &wgpu::Device, [width, height]: [u32; 2], views: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("views"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: views },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Room for what a panel's sub-pixels show.
pub(super) fn shown_texture(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("views of sub-pixels"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: SHOWN_FORMAT,
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pipeline_builds_on_the_noop_device() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let passes = Passes::new(&device, wgpu::TextureFormat::Bgra8Unorm);
        let all = Arrangement::ALL.into_iter().filter(|arrangement| arrangement.is_of_display());
        assert_eq!(passes.pipelines.len(), all.count());
    }

    #[test]
    fn light_ends_where_the_simulators_does() {
        let dark = format!("const DARK = {:e};", wheatstone_core::lightfield::simulator::DARK);
        assert!(include_str!("tiles.wgsl").contains(&dark), "{dark}");
    }
}
