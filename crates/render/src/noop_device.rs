//! Pipelines on a device that does nothing.

/// Runs what builds pipelines on `wgpu`'s noop device and fails with what validation says against it.
pub(crate) fn build_on_noop_device(build: impl FnOnce(&wgpu::Device)) {
    let (device, _) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    build(&device);
    if let Some(error) = pollster::block_on(scope.pop()) {
        panic!("{error}");
    }
}
