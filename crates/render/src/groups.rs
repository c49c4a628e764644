//! The bind groups that the passes of a cast share.

use crate::stamps::Stamps;
use crate::uniforms::{CastUniform, ViewUniform};
use std::num::NonZeroU64;
use wheatstone_core::transfer::LUT_1D_ENTRIES;

/// Bytes of a `RayState`.
pub(crate) const RAY_STATE_BYTES: u64 = 48;

/// Bytes of a `RayState` and an `OpenLayer`.
pub(crate) const LAYERED_RAY_BYTES: u64 = 80;

/// Layouts of the groups 0 to 2.
#[derive(Debug)]
pub(crate) struct GroupLayouts {
    /// Parameters and view.
    pub(crate) frame: wgpu::BindGroupLayout,
    /// Volume, tables, maps and lit spheres.
    pub(crate) volume: wgpu::BindGroupLayout,
    /// Picture, rays under way, listed tiles, layers, the picture in front, where rays start and what they see first.
    pub(crate) target: wgpu::BindGroupLayout,
}

impl GroupLayouts {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let texture_2d = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: true },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let volume = [
            texture_3d(wgpu::TextureSampleType::Float { filterable: true }),
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
            texture_2d,
            buffer(wgpu::BufferBindingType::Uniform, 16 * LUT_1D_ENTRIES as u64),
            texture_3d(wgpu::TextureSampleType::Uint),
            texture_3d(wgpu::TextureSampleType::Float { filterable: true }),
            texture_3d(wgpu::TextureSampleType::Float { filterable: true }),
        ];
        let picture = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let target = [
            storage_texture(wgpu::TextureFormat::Rgba32Float),
            storage_texture(wgpu::TextureFormat::Rgba32Float),
            // As many bytes as the variant's states take.
            storage_buffer(0),
            storage_buffer(8),
            storage_texture_array(wgpu::TextureFormat::Rgba32Uint),
            picture,
            picture,
            picture,
            storage_buffer(4),
        ];
        Self {
            frame: layout(device, "frame", &[uniform::<CastUniform>(), uniform::<ViewUniform>()]),
            volume: layout(device, "volume", &volume),
            target: layout(device, "target", &target),
        }
    }

    /// The layout of a pipeline that has, or has not, a group of its own after these.
    pub(crate) fn pipeline_layout(
        &self,
        device: &wgpu::Device,
        label: &str,
        own: Option<&wgpu::BindGroupLayout>,
    ) -> wgpu::PipelineLayout {
        let groups: Vec<_> =
            [&self.frame, &self.volume, &self.target].into_iter().chain(own).map(Some).collect();
        device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(label),
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
    }
}

/// Groups 0 to 2 of one dispatch.
pub(crate) struct Bindings<'a> {
    pub(crate) frame: &'a wgpu::BindGroup,
    pub(crate) volume: &'a wgpu::BindGroup,
    pub(crate) target: &'a wgpu::BindGroup,
}

impl Bindings<'_> {
    /// Begins a pass of a pipeline that has, or has not, a group of its own after these.
    pub(crate) fn begin_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        own: Option<&wgpu::BindGroup>,
    ) -> wgpu::ComputePass<'e> {
        self.begin_timed_pass(encoder, pipeline, own, Stamps::NONE)
    }

    /// The same with timestamps.
    pub(crate) fn begin_timed_pass<'e>(
        &self,
        encoder: &'e mut wgpu::CommandEncoder,
        pipeline: &wgpu::ComputePipeline,
        own: Option<&wgpu::BindGroup>,
        stamps: Stamps<'_>,
    ) -> wgpu::ComputePass<'e> {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: None,
            timestamp_writes: stamps.writes(),
        });
        pass.set_pipeline(pipeline);
        for (index, group) in (0..).zip([self.frame, self.volume, self.target].into_iter().chain(own)) {
            pass.set_bind_group(index, group, &[]);
        }
        pass
    }
}

/// A layout of resources at the bindings 0, 1, 2, …
pub(crate) fn layout(
    device: &wgpu::Device,
    label: &str,
    types: &[wgpu::BindingType],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(types)
        .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        })
        .collect();
    device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
}

/// Resources at the bindings 0, 1, 2, …
pub(crate) fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    resources: &[wgpu::BindingResource<'_>],
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// A buffer of at least so many bytes that a shader reads and writes.
pub(crate) fn storage_buffer(smallest: u64) -> wgpu::BindingType {
    buffer(wgpu::BufferBindingType::Storage { read_only: false }, smallest)
}

/// A uniform buffer that holds a `T`.
pub(crate) fn uniform<T>() -> wgpu::BindingType {
    buffer(wgpu::BufferBindingType::Uniform, size_of::<T>() as u64)
}

fn buffer(ty: wgpu::BufferBindingType, smallest: u64) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: NonZeroU64::new(smallest) }
}

fn texture_3d(sample_type: wgpu::TextureSampleType) -> wgpu::BindingType {
    wgpu::BindingType::Texture {
        sample_type,
        view_dimension: wgpu::TextureViewDimension::D3,
        multisampled: false,
    }
}

pub(crate) fn storage_texture(format: wgpu::TextureFormat) -> wgpu::BindingType {
    wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2,
    }
}

fn storage_texture_array(format: wgpu::TextureFormat) -> wgpu::BindingType {
    wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format,
        view_dimension: wgpu::TextureViewDimension::D2Array,
    }
}
