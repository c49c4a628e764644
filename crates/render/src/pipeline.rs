//! Compute pipelines out of WGSL files.

use crate::gpu::GpuError;
use crate::shader::compose;

/// The files and the entry point of a kernel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct KernelFiles<'a> {
    pub(crate) root: &'static str,
    /// The file of each slot.
    pub(crate) choices: &'a [(&'static str, &'static str)],
    pub(crate) entry_point: &'static str,
}

/// Builds the pipeline of a kernel, without a layout as its shader declares it; what the driver says against it comes with
/// the next [`Gpu::check`](crate::Gpu::check).
///
/// # Errors
/// [`GpuError::Refused`] for files that make no module.
pub(crate) fn build(
    device: &wgpu::Device,
    layout: Option<&wgpu::PipelineLayout>,
    files: &KernelFiles<'_>,
) -> Result<wgpu::ComputePipeline, GpuError> {
    let source = compose(files.root, files.choices).map_err(GpuError::refused)?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(files.root),
        source: wgpu::ShaderSource::Wgsl(source.text.into()),
    });
    Ok(device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(files.root),
        layout,
        module: &module,
        entry_point: Some(files.entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    }))
}
