//! The device: which adapter, what it can do, and what went wrong.

mod capabilities;
mod error;

pub use capabilities::{Capabilities, Tier};
pub use error::GpuError;

use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Longest time that a submission may take before the device counts as hung.
pub(crate) const SUBMISSION_TIMEOUT: Duration = Duration::from_secs(120);

/// What an adapter says of itself.
#[derive(Debug, Clone, PartialEq)]
pub struct AdapterDescription {
    /// Device name.
    pub name: String,
    /// Driver name and version.
    pub driver: String,
    /// Graphics API, such as `vulkan`.
    pub backend: String,
    /// Whether it runs on the CPU.
    pub is_software: bool,
    /// What it offers.
    pub capabilities: Capabilities,
}

/// A GPU device and its queue.
///
/// Errors that `wgpu` reports late are kept and returned by the next [`Gpu::check`], which every operation of
/// this crate calls.
#[derive(Debug)]
pub struct Gpu {
    adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    description: AdapterDescription,
    fault: Arc<Mutex<Option<GpuError>>>,
}

/// Every adapter that could be used, the best first: discrete, integrated, virtual, other, software.
pub fn adapters() -> Vec<AdapterDescription> {
    ranked_adapters(&instance()).iter().map(describe).collect()
}

/// The graphics APIs that adapters are looked for in.
pub fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::PRIMARY,
        flags: instance_flags(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    })
}

/// What an instance checks. Arguments of indirect dispatches are not checked by a dispatch before each: kernels count them up to
/// what a picture holds.
pub fn instance_flags() -> wgpu::InstanceFlags {
    wgpu::InstanceFlags::default() - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL
}

/// How a device is to be opened: with the features that are of use and all that the adapter's limits allow.
pub fn device_descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
    wgpu::DeviceDescriptor {
        label: Some("wheatstone"),
        required_features: Capabilities::wanted_features() & adapter.features(),
        required_limits: adapter.limits(),
        memory_hints: memory_hints(adapter),
        ..Default::default()
    }
}

impl Gpu {
    /// Opens the best adapter, software included.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if there is none, [`GpuError::Device`] if it cannot be opened.
    pub fn open_best() -> Result<Self, GpuError> {
        Self::open(|_| true)
    }

    /// Opens the best hardware adapter.
    ///
    /// # Errors
    /// As [`Gpu::open_best`].
    pub fn open_hardware() -> Result<Self, GpuError> {
        Self::open(|adapter| !adapter.is_software)
    }

    /// Opens the best adapter that runs on the CPU, for tests that must not depend on a GPU.
    ///
    /// # Errors
    /// As [`Gpu::open_best`].
    pub fn open_software() -> Result<Self, GpuError> {
        Self::open(|adapter| adapter.is_software)
    }

    /// Opens the best of the adapters that a predicate accepts.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] if none is accepted, [`GpuError::Device`] if it cannot be opened.
    pub fn open(accept: impl Fn(&AdapterDescription) -> bool) -> Result<Self, GpuError> {
        Self::open_first(ranked_adapters(&instance()), |adapter| accept(&describe(adapter)))
    }

    /// Opens the best adapter that can show pictures on a surface of the instance.
    ///
    /// # Errors
    /// As [`Gpu::open_best`].
    pub fn open_for_surface(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
    ) -> Result<Self, GpuError> {
        Self::open_first(ranked_adapters(instance), |adapter| adapter.is_surface_supported(surface))
    }

    fn open_first(
        candidates: Vec<wgpu::Adapter>,
        accept: impl Fn(&wgpu::Adapter) -> bool,
    ) -> Result<Self, GpuError> {
        let found = candidates.len();
        let adapter = candidates.into_iter().find(accept).ok_or(GpuError::NoAdapter { found })?;
        let (device, queue) =
            pollster::block_on(adapter.request_device(&device_descriptor(&adapter))).map_err(|error| {
                GpuError::Device { adapter: adapter.get_info().name, reason: error.to_string() }
            })?;
        Ok(Self::adopt(adapter, device, queue))
    }

    /// Takes a device that was opened elsewhere as [`device_descriptor`] asks, such as by the runtime of a headset. From now on its
    /// errors, its loss included, are returned by [`Gpu::check`].
    pub fn adopt(adapter: wgpu::Adapter, device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let description = describe(&adapter);
        let fault = Arc::new(Mutex::new(None));
        let keep_first = |fault: &Mutex<Option<GpuError>>, error: GpuError| {
            fault.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
        };
        let on_error = Arc::clone(&fault);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            keep_first(&on_error, GpuError::from(error));
        }));
        let on_loss = Arc::clone(&fault);
        device.set_device_lost_callback(move |_, message| {
            keep_first(&on_loss, GpuError::Lost { reason: message });
        });
        Self { adapter, device, queue, description, fault }
    }

    /// The adapter, which knows the formats of a surface.
    pub fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// The device, for passes beside those of this crate.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// What was opened.
    pub fn description(&self) -> &AdapterDescription {
        &self.description
    }

    /// What the device offers.
    pub fn capabilities(&self) -> &Capabilities {
        &self.description.capabilities
    }

    /// Returns the first error reported since the last check; a lost device stays lost.
    ///
    /// # Errors
    /// Whatever the device reported.
    pub fn check(&self) -> Result<(), GpuError> {
        let mut fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner);
        match &*fault {
            Some(lost @ GpuError::Lost { .. }) => Err(lost.clone()),
            Some(_) => fault.take().map_or(Ok(()), Err),
            None => Ok(()),
        }
    }

    /// Lets work that is done report so, without waiting, then checks for errors.
    ///
    /// # Errors
    /// Whatever the device reported.
    pub fn poll(&self) -> Result<(), GpuError> {
        let polled = self.device.poll(wgpu::PollType::Poll);
        self.check()?;
        polled.map(drop).map_err(GpuError::refused)
    }

    /// All texels of a texture, row by row; waits until all submitted work is done.
    ///
    /// # Errors
    /// No memory, a lost or hung device.
    pub fn read_texture<T: bytemuck::Pod>(&self, texture: &wgpu::Texture) -> Result<Vec<T>, GpuError> {
        crate::readback::read_texture(self, texture)
    }

    /// Waits until a submission is done, then checks for errors.
    ///
    /// # Errors
    /// As [`Gpu::wait`].
    pub fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        self.wait_until(Some(submission))
    }

    /// Waits until all submitted work is done, then checks for errors.
    ///
    /// # Errors
    /// [`GpuError::Hung`] after two minutes, and whatever the device reported.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.wait_until(None)
    }

    fn wait_until(&self, submission_index: Option<wgpu::SubmissionIndex>) -> Result<(), GpuError> {
        let timeout = Some(SUBMISSION_TIMEOUT);
        let polled = self.device.poll(wgpu::PollType::Wait { submission_index, timeout });
        self.check()?;
        polled.map(drop).map_err(|error| match error {
            wgpu::PollError::Timeout => GpuError::Hung { seconds: SUBMISSION_TIMEOUT.as_secs() },
            other => GpuError::Refused { reason: other.to_string() },
        })
    }
}

/// On software the device's memory is the program's: blocks of it that are mostly empty are not worth the allocations they spare.
fn memory_hints(adapter: &wgpu::Adapter) -> wgpu::MemoryHints {
    if is_software(adapter) { wgpu::MemoryHints::MemoryUsage } else { wgpu::MemoryHints::Performance }
}

fn is_software(adapter: &wgpu::Adapter) -> bool {
    adapter.get_info().device_type == wgpu::DeviceType::Cpu
}

fn ranked_adapters(instance: &wgpu::Instance) -> Vec<wgpu::Adapter> {
    let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    adapters.sort_by_key(|adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    });
    adapters
}

fn describe(adapter: &wgpu::Adapter) -> AdapterDescription {
    let info = adapter.get_info();
    AdapterDescription {
        driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
        backend: info.backend.to_string(),
        is_software: is_software(adapter),
        capabilities: Capabilities::of(adapter),
        name: info.name,
    }
}
