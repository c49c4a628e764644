//! Render passes of warps: a triangle over the picture, and what each of its pixels shows.

use super::Canvas;
use crate::gpu::GpuError;
use crate::groups::uniform;
use crate::pipeline::KernelFiles;
use crate::shader::compose;
use wheatstone_core::view::{PixelRect, View};
use wheatstone_core::warp::WarpError;

/// A texture of floats between which nothing is interpolated.
pub(super) const TEXTURE: wgpu::BindingType = float_texture(false);

/// A texture of floats.
pub(super) const fn float_texture(filterable: bool) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    }
}

/// What pipelines read: a uniform buffer, then textures and samplers.
pub(super) fn layout<Uniform>(device: &wgpu::Device, others: &[wgpu::BindingType]) -> wgpu::BindGroupLayout {
    let types = std::iter::once(uniform::<Uniform>()).chain(others.iter().copied());
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

/// The pass that empties pixels.
pub(super) const BLANK: KernelFiles<'_> =
    KernelFiles { root: "warp/blank", choices: &[], entry_point: "warp_blank" };

/// Builds the pipeline of a warp's files; what the driver says against it comes with the next [`Gpu::check`](crate::Gpu::check).
///
/// # Errors
/// [`GpuError::Refused`] for files that make no module.
pub(super) fn build(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    &KernelFiles { root, choices, entry_point }: &KernelFiles<'_>,
    format: wgpu::TextureFormat,
) -> Result<wgpu::RenderPipeline, GpuError> {
    let source = compose(root, choices).map_err(GpuError::refused)?;
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

/// Encodes a pass of a warp over some pixels, as far as they can be seen; the others are transparent after it.
///
/// # Errors
/// A canvas that is not of the wanted view's size.
pub(super) fn draw(
    encoder: &mut wgpu::CommandEncoder,
    [blank, warp]: [&wgpu::RenderPipeline; 2],
    group: &wgpu::BindGroup,
    covered: &PixelRect,
    into: &mut Canvas,
    wanted: &View,
) -> Result<(), WarpError> {
    WarpError::unless_of_size(into.size(), wanted)?;
    let before = into.draw(covered);
    let load = match before {
        Some(_) => wgpu::LoadOp::Load,
        None => wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("warp"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: into.view(),
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
        })],
        ..Default::default()
    });
    pass.set_bind_group(0, group, &[]);
    let mut fill = |pipeline, rect: &PixelRect| {
        if !rect.is_empty() {
            let PixelRect { columns, rows } = rect;
            pass.set_pipeline(pipeline);
            pass.set_scissor_rect(columns.start, rows.start, columns.len() as u32, rows.len() as u32);
            pass.draw(0..3, 0..1);
        }
    };
    for left in before.iter().flat_map(|before| before.without(covered)) {
        fill(blank, &left);
    }
    for seen in into.seen(covered) {
        fill(warp, &seen);
    }
    Ok(())
}
