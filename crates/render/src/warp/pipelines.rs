//! Render pipelines of warps: a triangle over the picture, and what each of its pixels shows.

use crate::gpu::GpuError;
use crate::groups::uniform;
use crate::shader::compose;

/// What the pipelines read: a uniform buffer, then textures.
pub(super) fn layout<Uniform>(device: &wgpu::Device, textures: u32) -> wgpu::BindGroupLayout {
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let types = std::iter::once(uniform::<Uniform>()).chain((0..textures).map(|_| texture));
    let entries: Vec<_> = (0..)
        .zip(types)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        })
        .collect();
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("warp"), entries: &entries })
}

/// Builds the pipeline of a file; what the driver says against it comes with the next [`Gpu::check`](crate::Gpu::check).
///
/// # Errors
/// [`GpuError::Refused`] for a file that makes no module.
pub(super) fn build(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    (root, entry_point): (&'static str, &'static str),
    format: wgpu::TextureFormat,
) -> Result<wgpu::RenderPipeline, GpuError> {
    let source = compose(root, &[]).map_err(|error| GpuError::Refused { reason: error.to_string() })?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(root),
        source: wgpu::ShaderSource::Wgsl(source.text.into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(root),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    Ok(device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(root),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("cover_picture"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    }))
}
