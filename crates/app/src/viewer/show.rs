//! Pictures into an area of the window.

use super::state::Arrangement;
use std::collections::HashMap;

/// An area of a window, pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) left: u32,
    pub(crate) top: u32,
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Area {
    /// The whole of a window.
    pub(crate) fn whole([width, height]: [u32; 2]) -> Self {
        Self { left: 0, top: 0, width, height }
    }

    /// A rectangle in points.
    pub(crate) fn of_points(rect: egui::Rect, pixels_per_point: f32) -> Self {
        let pixels = |points: f32| (points * pixels_per_point).round().max(0.0) as u32;
        let (left, top) = (pixels(rect.left()), pixels(rect.top()));
        let (right, bottom) = (pixels(rect.right()), pixels(rect.bottom()));
        Self { left, top, width: right.saturating_sub(left), height: bottom.saturating_sub(top) }
    }

    /// Its width and height; at least one pixel each.
    pub(crate) fn size(self) -> [u32; 2] {
        [self.width.max(1), self.height.max(1)]
    }

    /// The part of it that lies within a window.
    pub(crate) fn within(self, [width, height]: [u32; 2]) -> Self {
        let (left, top) = (self.left.min(width), self.top.min(height));
        Self { left, top, width: self.width.min(width - left), height: self.height.min(height - top) }
    }
}

/// What `show.wgsl` reads.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ShowUniform {
    background: [f32; 3],
    padding: u32,
    area: [f32; 4],
}

/// The arrangements of eyes' pictures; what a light-field display shows is one picture where there are eyes.
const ENTRY_POINTS: [(Arrangement, &str); 3] = [
    (Arrangement::Mono, "mono"),
    (Arrangement::SideBySide, "side_by_side"),
    (Arrangement::Anaglyph, "anaglyph"),
];

/// Pipelines, one for each arrangement of eyes' pictures.
pub(crate) struct Show {
    layout: wgpu::BindGroupLayout,
    pipelines: HashMap<Arrangement, wgpu::RenderPipeline>,
    uniform: wgpu::Buffer,
    sampler: wgpu::Sampler,
}

impl Show {
    pub(crate) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("show.wgsl"));
        let texture = |binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: true },
                view_dimension: wgpu::TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let uniform_entry = wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let sampler_entry = wgpu::BindGroupLayoutEntry {
            binding: 3,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            count: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("show"),
            entries: &[uniform_entry, texture(1), texture(2), sampler_entry],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("show"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = |entry_point: &str| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("show"),
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("everywhere"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(format.into())],
                }),
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                multiview_mask: None,
                cache: None,
            })
        };
        let pipelines = ENTRY_POINTS
            .into_iter()
            .map(|(arrangement, entry_point)| (arrangement, pipeline(entry_point)))
            .collect();
        let uniform = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("show"),
            size: size_of::<ShowUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("interpolated"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self { layout, pipelines, uniform, sampler }
    }

    /// Draws the pictures of the eyes (the same twice for one eye) into an area.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        (arrangement, area, background): (Arrangement, Area, [f32; 3]),
        eyes: [&wgpu::TextureView; 2],
    ) {
        let of_eyes = if arrangement.is_of_display() { Arrangement::Mono } else { arrangement };
        let Some(pipeline) = self.pipelines.get(&of_eyes).filter(|_| area.width > 0 && area.height > 0)
        else {
            return;
        };
        let corners = [area.left, area.top, area.width, area.height].map(|number| number as f32);
        let uniform = ShowUniform { background, padding: 0, area: corners };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&uniform));
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("show"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.uniform.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(eyes[0]) },
                wgpu::BindGroupEntry { binding: 2, resource: wgpu::BindingResource::TextureView(eyes[1]) },
                wgpu::BindGroupEntry { binding: 3, resource: wgpu::BindingResource::Sampler(&self.sampler) },
            ],
        });
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.set_scissor_rect(area.left, area.top, area.width, area.height);
        pass.draw(0..3, 0..1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pipeline_builds_on_the_noop_device() {
        let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let show = Show::new(&device, wgpu::TextureFormat::Bgra8Unorm);
        assert_eq!(show.pipelines.len(), ENTRY_POINTS.len());
    }

    #[test]
    fn an_area_is_cut_to_its_window() {
        let area = Area { left: 10, top: 20, width: 100, height: 100 };
        assert_eq!(area.within([50, 200]), Area { width: 40, ..area });
        assert_eq!(area.within([5, 5]), Area { left: 5, top: 5, width: 0, height: 0 });
    }
}
