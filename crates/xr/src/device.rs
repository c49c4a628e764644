//! The Vulkan device that the runtime and `wgpu` share.

use crate::error::{Called, Tried, XrError};
use crate::runtime::Runtime;
use ash::vk::{self, Handle as _};
use openxr as xr;
use std::ffi::CStr;
use std::sync::Arc;
use wgpu::hal::{api::Vulkan, vulkan};
use wheatstone_render::Gpu;
use wheatstone_render::gpu::{device_descriptor, instance_flags};

/// The newest version of Vulkan that `wgpu` asks for.
const NEWEST_VULKAN: u32 = vk::API_VERSION_1_3;

/// The device that the headset's pictures are made on, opened through the runtime.
///
/// The runtime submits to the same queue, so all submissions have to come from the thread that the [`Session`](crate::Session) is on.
pub struct Graphics {
    gpu: Arc<Gpu>,
    instance: wgpu::Instance,
    runtime: Runtime,
}

impl Graphics {
    /// The device, for all that renders.
    pub fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    /// The instance that it belongs to: a mirror window's surface has to be made by it.
    pub fn instance(&self) -> &wgpu::Instance {
        &self.instance
    }

    /// The runtime that it was opened through.
    pub fn runtime(&self) -> &Runtime {
        &self.runtime
    }
}

impl Runtime {
    /// Opens the device that the headset is connected to, with the features and limits that [`Gpu::open`] asks for. Layers named in
    /// `VK_INSTANCE_LAYERS`, such as `VK_LAYER_KHRONOS_validation`, are in force.
    ///
    /// # Errors
    /// [`XrError::Vulkan`] where there is none, or none that both can use.
    pub fn open_gpu(&self) -> Result<Graphics, XrError> {
        // SAFETY: a library of the Vulkan loader's name is the Vulkan loader, which keeps to its specification.
        let entry = unsafe { ash::Entry::load() }.tried("loading the Vulkan loader")?;
        let instance = self.vulkan_instance(&entry)?;
        let adapter = self.adapter(&instance)?;
        let descriptor = device_descriptor(&adapter);
        let opened = self.vulkan_device(&entry, &adapter, &descriptor)?;
        // SAFETY: the device was opened from this adapter, with the features of this descriptor.
        let (device, queue) =
            unsafe { adapter.create_device_from_hal(opened, &descriptor) }.tried("taking the device over")?;
        Ok(Graphics { gpu: Arc::new(Gpu::adopt(adapter, device, queue)), instance, runtime: self.clone() })
    }

    fn vulkan_instance(&self, entry: &ash::Entry) -> Result<wgpu::Instance, XrError> {
        let flags = instance_flags();
        let version = self.vulkan_version(entry)?;
        let extensions = vulkan::Instance::desired_extensions(entry, version, flags)
            .tried("listing the instance's extensions")?;
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let application = vk::ApplicationInfo::default()
            .application_name(c"wheatstone")
            .engine_name(c"wgpu-hal")
            .api_version(version);
        let info =
            vk::InstanceCreateInfo::default().application_info(&application).enabled_extension_names(&names);
        // SAFETY: requirements have been asked for (`vulkan_version`), and the description and all it points to outlive the call.
        let raw = unsafe {
            self.instance.create_vulkan_instance(
                self.system,
                instance_functions(entry),
                (&raw const info).cast(),
            )
        }
        .called("xrCreateVulkanInstanceKHR")?
        .map_err(vk::Result::from_raw)
        .tried("making the instance")?;
        // SAFETY: the handle is an instance that was just made through this entry.
        let raw = unsafe {
            ash::Instance::load(entry.static_fn(), vk::Instance::from_raw(raw.expose_provenance() as u64))
        };
        // SAFETY: made through this entry, with these extensions and this version. It is destroyed when nothing uses it any more, before
        // the libraries it came from are let go.
        let instance = unsafe {
            let (keep_raw, keep_entry, keep_runtime) = (raw.clone(), entry.clone(), self.instance.clone());
            let destroy = move || {
                keep_raw.destroy_instance(None);
                drop((keep_entry, keep_runtime));
            };
            vulkan::Instance::from_raw(
                entry.clone(),
                raw,
                version,
                0,
                None,
                extensions,
                flags,
                wgpu::MemoryBudgetThresholds::default(),
                false,
                Some(Box::new(destroy)),
            )
        }
        .tried("taking the instance over")?;
        // SAFETY: the instance is usable, and nothing else owns it.
        Ok(unsafe { wgpu::Instance::from_hal::<Vulkan>(instance) })
    }

    /// The version to ask for: the newest that the loader, the runtime and `wgpu` all know.
    fn vulkan_version(&self, entry: &ash::Entry) -> Result<u32, XrError> {
        let required = self
            .instance
            .graphics_requirements::<xr::Vulkan>(self.system)
            .called("xrGetVulkanGraphicsRequirements2KHR")?;
        // SAFETY: the entry is a loaded Vulkan loader.
        let loader = unsafe { entry.try_enumerate_instance_version() }
            .tried("asking for the loader's version")?
            .unwrap_or(vk::API_VERSION_1_0);
        let [least, most] = [required.min_api_version_supported, required.max_api_version_supported]
            .map(|version| vk::make_api_version(0, version.major().into(), version.minor().into(), 0));
        version_between(least, most, loader).ok_or_else(|| XrError::Vulkan {
            what: "choosing a version",
            reason: format!(
                "the runtime wants {} at least, the loader has {}",
                required.min_api_version_supported,
                shown(loader)
            ),
        })
    }

    fn adapter(&self, instance: &wgpu::Instance) -> Result<wgpu::Adapter, XrError> {
        // SAFETY: nothing of what is handed out is destroyed here.
        let hal =
            unsafe { instance.as_hal::<Vulkan>() }.ok_or("not of Vulkan").tried("using the instance")?;
        let raw = hal.shared_instance().raw_instance().handle();
        // SAFETY: the instance was made by `xrCreateVulkanInstanceKHR`.
        let physical = unsafe {
            self.instance
                .vulkan_graphics_device(self.system, std::ptr::with_exposed_provenance(raw.as_raw() as usize))
        }
        .called("xrGetVulkanGraphicsDevice2KHR")?;
        let physical = vk::PhysicalDevice::from_raw(physical.expose_provenance() as u64);
        let exposed = hal
            .expose_adapter(physical)
            .ok_or("it has less than is needed to compute")
            .tried("using the headset's GPU")?;
        // SAFETY: exposed by this very instance.
        Ok(unsafe { instance.create_adapter_from_hal(exposed) })
    }

    fn vulkan_device(
        &self,
        entry: &ash::Entry,
        adapter: &wgpu::Adapter,
        descriptor: &wgpu::DeviceDescriptor<'_>,
    ) -> Result<wgpu::hal::OpenDevice<Vulkan>, XrError> {
        // SAFETY: nothing of what is handed out is destroyed here.
        let hal = unsafe { adapter.as_hal::<Vulkan>() }.ok_or("not of Vulkan").tried("using the adapter")?;
        let instance = hal.shared_instance().raw_instance();
        let physical = hal.raw_physical_device();
        // SAFETY: the physical device is of this instance.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let needed = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
        let family = (0..)
            .zip(&families)
            .find_map(|(index, family)| family.queue_flags.contains(needed).then_some(index))
            .ok_or("no queue that both draws and computes")
            .tried("choosing a queue")?;
        let extensions: Vec<&CStr> = hal.required_device_extensions(descriptor.required_features);
        let mut features = hal.physical_device_features(&extensions, descriptor.required_features);
        let names: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        let info = features.add_to_device_create(
            vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_extension_names(&names),
        );
        // SAFETY: the physical device is the runtime's own choice; the description and all it points to outlive the call.
        let raw = unsafe {
            self.instance.create_vulkan_device(
                self.system,
                instance_functions(entry),
                std::ptr::with_exposed_provenance(physical.as_raw() as usize),
                (&raw const info).cast(),
            )
        }
        .called("xrCreateVulkanDeviceKHR")?
        .map_err(vk::Result::from_raw)
        .tried("making the device")?;
        // SAFETY: the handle is a device that was just made of this instance.
        let device = unsafe {
            ash::Device::load(instance.fp_v1_0(), vk::Device::from_raw(raw.expose_provenance() as u64))
        };
        // SAFETY: made of this adapter with these extensions, its features and this family. It is owned by `wgpu` from here on, which
        // keeps the instance until the device is destroyed.
        unsafe {
            hal.device_from_raw(
                device,
                None,
                &extensions,
                descriptor.required_features,
                &descriptor.required_limits,
                &descriptor.memory_hints,
                family,
                0,
            )
        }
        .tried("taking the device over")
    }
}

/// The session's device, as the runtime wants it described.
pub(crate) fn session_info(device: &wgpu::Device) -> Result<xr::vulkan::SessionCreateInfo, XrError> {
    // SAFETY: nothing of what is handed out is destroyed here.
    let hal = unsafe { device.as_hal::<Vulkan>() }.ok_or("not of Vulkan").tried("using the device")?;
    let pointer = |raw: u64| std::ptr::with_exposed_provenance(raw as usize);
    Ok(xr::vulkan::SessionCreateInfo {
        instance: pointer(hal.shared_instance().raw_instance().handle().as_raw()),
        physical_device: pointer(hal.raw_physical_device().as_raw()),
        device: pointer(hal.raw_device().handle().as_raw()),
        queue_family_index: hal.queue_family_index(),
        queue_index: hal.queue_index(),
    })
}

fn instance_functions(entry: &ash::Entry) -> xr::sys::platform::VkGetInstanceProcAddr {
    // SAFETY: both are `vkGetInstanceProcAddr`; its handle and the functions that it returns are pointers in either type.
    unsafe {
        std::mem::transmute::<vk::PFN_vkGetInstanceProcAddr, xr::sys::platform::VkGetInstanceProcAddr>(
            entry.static_fn().get_instance_proc_addr,
        )
    }
}

/// The newest version up to what the loader, the runtime and `wgpu` know, unless the runtime wants a newer one.
fn version_between(least: u32, most: u32, loader: u32) -> Option<u32> {
    let version = loader.min(most).min(NEWEST_VULKAN);
    (version >= least).then_some(version)
}

fn shown(version: u32) -> String {
    format!("{}.{}", vk::api_version_major(version), vk::api_version_minor(version))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ash::vk::{API_VERSION_1_0, API_VERSION_1_1, API_VERSION_1_2, API_VERSION_1_3, make_api_version};

    #[test]
    fn the_version_is_the_newest_that_all_know() {
        let loader = make_api_version(0, 1, 4, 309);
        let newest = make_api_version(0, 1023, 1023, 0);
        assert_eq!(version_between(API_VERSION_1_0, newest, loader), Some(API_VERSION_1_3));
        assert_eq!(version_between(API_VERSION_1_0, API_VERSION_1_2, loader), Some(API_VERSION_1_2));
        assert_eq!(version_between(API_VERSION_1_1, newest, API_VERSION_1_0), None);
    }
}
