//! Compute kernels with one bind group, laid out as their shader declares it.

use crate::gpu::GpuError;
use crate::groups::bind;
use crate::pipeline::{KernelFiles, build};

/// Invocations along x and y of every workgroup; along z there is one.
pub(crate) const WORKGROUP_SIDE: u32 = 8;

/// A pipeline. Cheap to clone.
#[derive(Debug, Clone)]
pub(crate) struct Kernel {
    pipeline: wgpu::ComputePipeline,
}

impl Kernel {
    /// Builds the pipeline; what the driver says against it comes with the next [`Gpu::check`](crate::Gpu::check).
    ///
    /// # Errors
    /// [`GpuError::Refused`] for files that make no module.
    pub(crate) fn new(device: &wgpu::Device, files: &KernelFiles<'_>) -> Result<Self, GpuError> {
        Ok(Self { pipeline: build(device, None, files)? })
    }

    /// A bind group of resources at the bindings 0, 1, 2, …
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        resources: &[wgpu::BindingResource<'_>],
    ) -> wgpu::BindGroup {
        bind(device, &self.pipeline.get_bind_group_layout(0), resources)
    }

    /// Adds a pass of at least the given invocations along each axis.
    pub(crate) fn dispatch(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        group: &wgpu::BindGroup,
        [x, y, z]: [u32; 3],
    ) {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.dispatch_workgroups(x.div_ceil(WORKGROUP_SIDE), y.div_ceil(WORKGROUP_SIDE), z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noop_device::build_on_noop_device;
    use crate::shader::{FILES, compose};

    /// Roots of the passes of a cast, which share bind groups.
    const CAST_ROOTS: [&str; 2] = ["cast", "tiles"];

    fn all() -> Vec<KernelFiles<'static>> {
        let mut all = crate::skip::kernel_files();
        all.extend(crate::anchors::kernel_files());
        all.extend(crate::first_hits::kernel_files());
        all.extend(crate::gradient_map::kernel_files());
        all.extend(crate::warp::kernel_files());
        all
    }

    #[test]
    fn every_kernel_is_valid_wgsl() {
        let mut validator = naga::valid::Validator::new(
            naga::valid::ValidationFlags::all(),
            naga::valid::Capabilities::default() | naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32,
        );
        for files in all() {
            let source = compose(files.root, files.choices).unwrap();
            let module = naga::front::wgsl::parse_str(&source.text).unwrap_or_else(|error| {
                let line = error.location(&source.text).map_or(0, |l| l.line_number as usize);
                panic!("{files:?} {:?}: {}", source.origin(line), error.emit_to_string(&source.text))
            });
            validator.validate(&module).unwrap_or_else(|error| panic!("{files:?}: {error:?}"));
        }
    }

    #[test]
    fn every_pipeline_builds_on_the_noop_device() {
        build_on_noop_device(|device| {
            for files in all() {
                Kernel::new(device, &files).unwrap();
            }
        });
    }

    #[test]
    fn no_root_is_left_out() {
        let all = all();
        let is_of_cast = |path: &str| {
            CAST_ROOTS.contains(&path) || ["lib/", "stereo/", "warp/"].iter().any(|at| path.starts_with(at))
        };
        for (path, _) in FILES.iter().filter(|(path, _)| !is_of_cast(path)) {
            assert!(all.iter().any(|files| files.root == *path), "{path}");
        }
    }
}
