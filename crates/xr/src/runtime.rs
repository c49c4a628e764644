//! Finding a runtime and a headset, and what they offer.

use crate::error::{Called, XrError};
use openxr as xr;
use std::error::Error as _;
use std::path::Path;

/// The two eyes' views.
pub(crate) const STEREO: xr::ViewConfigurationType = xr::ViewConfigurationType::PRIMARY_STEREO;

#[cfg(target_os = "windows")]
const LOADER: &str = "openxr_loader.dll";
#[cfg(not(target_os = "windows"))]
const LOADER: &str = "libopenxr_loader.so.1";

/// A connection to the runtime, and the headset that it has found. Clones share the connection, which ends with the last of them
/// and of what was made of them.
#[derive(Clone)]
pub struct Runtime {
    pub(crate) instance: xr::Instance,
    pub(crate) system: xr::SystemId,
    description: RuntimeDescription,
}

/// What a runtime says of itself and of the headset.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeDescription {
    /// Name of the runtime.
    pub name: String,
    /// Its version.
    pub version: String,
    /// Name of the headset.
    pub headset: String,
    /// Recommended width and height of the left and the right eye's pictures, pixels.
    pub eye_sizes: [[u32; 2]; 2],
    /// Largest width and height of the left and the right eye's pictures, pixels.
    pub largest_eye_sizes: [[u32; 2]; 2],
    /// Whether the head's position is tracked, not only its orientation.
    pub tracks_position: bool,
    /// Whether depths may be given along with pictures (`XR_KHR_composition_layer_depth`).
    pub has_depth_layers: bool,
    /// Whether the refresh rate can be read and chosen (`XR_FB_display_refresh_rate`).
    pub has_refresh_rates: bool,
    /// Whether it tells which pixels the lenses hide (`XR_KHR_visibility_mask`).
    pub has_visibility_masks: bool,
    /// Whether bare hands are tracked (`XR_EXT_hand_tracking`).
    pub has_hand_tracking: bool,
}

impl RuntimeDescription {
    /// Width and height of the left and the right eye's pictures that are scaled from what is recommended, pixels.
    pub(crate) fn image_sizes(&self, scale: f64) -> [[u32; 2]; 2] {
        std::array::from_fn(|eye| {
            std::array::from_fn(|axis| {
                let scaled = (scale * f64::from(self.eye_sizes[eye][axis])).round() as u32;
                scaled.clamp(1, self.largest_eye_sizes[eye][axis].max(1))
            })
        })
    }
}

impl Runtime {
    /// Connects to the active runtime in the name of a program (of 127 bytes at most, the rest is left out). Most loaders let a program
    /// have one connection at a time.
    ///
    /// # Errors
    /// [`XrError::NoLoader`], [`XrError::NoRuntime`], [`XrError::NoHeadset`], [`XrError::NoStereo`] or [`XrError::MissingExtension`],
    /// by what is missing.
    pub fn connect(program: &str) -> Result<Self, XrError> {
        Self::connect_through(Path::new(LOADER), program)
    }

    fn connect_through(loader: &Path, program: &str) -> Result<Self, XrError> {
        // SAFETY: a library of the loader's name is the loader, which keeps to the specification.
        let entry = unsafe { xr::Entry::load_from(loader, &()) }.map_err(|error| match error {
            xr::EntryError::Load(error) => {
                let reason = error.source().map_or_else(|| error.to_string(), ToString::to_string);
                XrError::NoLoader { reason }
            }
            xr::EntryError::Xr(error) => XrError::NoLoader { reason: format!("{error:?}") },
        })?;
        let offered = entry
            .enumerate_extensions()
            .map_err(|error| no_runtime("xrEnumerateInstanceExtensionProperties", error))?;
        if !offered.khr_vulkan_enable2 {
            return Err(XrError::MissingExtension {
                runtime: "the active OpenXR runtime".to_owned(),
                extension: "XR_KHR_vulkan_enable2",
            });
        }
        let application = xr::ApplicationInfo {
            application_name: clipped(program, xr::sys::MAX_APPLICATION_NAME_SIZE - 1),
            engine_name: "Wheatstone",
            api_version: xr::Version::new(1, 0, 0),
            ..Default::default()
        };
        let instance = entry
            .create_instance(&application, &wanted(&offered), &[], &())
            .map_err(|error| no_runtime("xrCreateInstance", error))?;
        let name = instance.properties().called("xrGetInstanceProperties")?;
        let system = instance
            .system(xr::FormFactor::HEAD_MOUNTED_DISPLAY)
            .map_err(|error| no_headset(&name.runtime_name, error))?;
        let description = describe(&instance, system, name)?;
        Ok(Self { instance, system, description })
    }

    /// What was found.
    pub fn description(&self) -> &RuntimeDescription {
        &self.description
    }
}

/// Which of the offered extensions are used.
fn wanted(offered: &xr::ExtensionSet) -> xr::ExtensionSet {
    let mut wanted = xr::ExtensionSet::default();
    wanted.khr_vulkan_enable2 = true;
    wanted.khr_composition_layer_depth = offered.khr_composition_layer_depth;
    wanted.khr_visibility_mask = offered.khr_visibility_mask;
    wanted.fb_display_refresh_rate = offered.fb_display_refresh_rate;
    wanted.ext_hand_tracking = offered.ext_hand_tracking;
    wanted.ext_local_floor = offered.ext_local_floor;
    #[cfg(windows)]
    {
        wanted.khr_win32_convert_performance_counter_time =
            offered.khr_win32_convert_performance_counter_time;
    }
    #[cfg(not(windows))]
    {
        wanted.khr_convert_timespec_time = offered.khr_convert_timespec_time;
    }
    wanted
}

fn no_runtime(call: &'static str, error: xr::sys::Result) -> XrError {
    use xr::sys::Result as R;
    match error {
        R::ERROR_RUNTIME_UNAVAILABLE | R::ERROR_RUNTIME_FAILURE | R::ERROR_INITIALIZATION_FAILED => {
            XrError::NoRuntime { reason: format!("{error:?}") }
        }
        other => XrError::of(call, other),
    }
}

fn no_headset(runtime: &str, error: xr::sys::Result) -> XrError {
    match error {
        xr::sys::Result::ERROR_FORM_FACTOR_UNAVAILABLE | xr::sys::Result::ERROR_FORM_FACTOR_UNSUPPORTED => {
            XrError::NoHeadset { runtime: runtime.to_owned(), reason: format!("{error:?}") }
        }
        other => XrError::of("xrGetSystem", other),
    }
}

fn describe(
    instance: &xr::Instance,
    system: xr::SystemId,
    name: xr::InstanceProperties,
) -> Result<RuntimeDescription, XrError> {
    let configurations =
        instance.enumerate_view_configurations(system).called("xrEnumerateViewConfigurations")?;
    let views = if configurations.contains(&STEREO) {
        instance
            .enumerate_view_configuration_views(system, STEREO)
            .called("xrEnumerateViewConfigurationViews")?
    } else {
        Vec::new()
    };
    let [left, right] = views[..] else {
        let offered = format!("{configurations:?}");
        return Err(XrError::NoStereo { runtime: name.runtime_name, offered });
    };
    let properties = instance.system_properties(system).called("xrGetSystemProperties")?;
    let extensions = instance.exts();
    Ok(RuntimeDescription {
        name: name.runtime_name,
        version: name.runtime_version.to_string(),
        headset: properties.system_name,
        eye_sizes: [left, right]
            .map(|view| [view.recommended_image_rect_width, view.recommended_image_rect_height]),
        largest_eye_sizes: [left, right].map(|view| [view.max_image_rect_width, view.max_image_rect_height]),
        tracks_position: properties.tracking_properties.position_tracking,
        has_depth_layers: extensions.khr_composition_layer_depth.is_some(),
        has_refresh_rates: extensions.fb_display_refresh_rate.is_some(),
        has_visibility_masks: extensions.khr_visibility_mask.is_some(),
        has_hand_tracking: extensions.ext_hand_tracking.is_some()
            && instance.supports_hand_tracking(system).called("xrGetSystemProperties")?,
    })
}

/// As much of a text as fits into so many bytes.
fn clipped(text: &str, bytes: usize) -> &str {
    &text[..text.floor_char_boundary(bytes)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_loader_is_told() {
        let loader = Path::new("/nowhere/libopenxr_loader.so.1");
        let error = Runtime::connect_through(loader, "test").map(drop).unwrap_err();
        assert!(matches!(&error, XrError::NoLoader { reason } if reason.contains("/nowhere/")), "{error:?}");
        assert!(error.to_string().contains("install"), "{error}");
    }

    #[test]
    fn a_missing_headset_is_told_from_other_refusals() {
        for missing in
            [xr::sys::Result::ERROR_FORM_FACTOR_UNAVAILABLE, xr::sys::Result::ERROR_FORM_FACTOR_UNSUPPORTED]
        {
            let error = no_headset("Monado", missing);
            assert!(error.to_string().starts_with("Monado finds no headset"), "{error}");
        }
        let lost = no_headset("Monado", xr::sys::Result::ERROR_INSTANCE_LOST);
        assert!(matches!(lost, XrError::RuntimeLost { .. }), "{lost:?}");
    }

    #[test]
    fn a_second_connection_is_no_missing_runtime() {
        let told = no_runtime("xrCreateInstance", xr::sys::Result::ERROR_LIMIT_REACHED);
        assert!(matches!(told, XrError::Refused { call: "xrCreateInstance", .. }), "{told:?}");
        let missing = no_runtime("xrCreateInstance", xr::sys::Result::ERROR_RUNTIME_UNAVAILABLE);
        assert!(matches!(missing, XrError::NoRuntime { .. }), "{missing:?}");
    }

    #[test]
    fn long_names_are_cut_between_characters() {
        assert_eq!(clipped("Wheatstone", 127), "Wheatstone");
        assert_eq!(clipped("aé", 2), "a");
    }
}
