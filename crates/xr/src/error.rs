//! What can go wrong in a headset.

use openxr as xr;
use thiserror::Error;
use wheatstone_render::GpuError;

/// An error of the runtime, of the device shared with it, or of what is missing for either.
#[derive(Debug, Error, Clone, PartialEq)]
#[non_exhaustive]
pub enum XrError {
    /// The library through which programs find a runtime cannot be loaded.
    #[error(
        "no OpenXR loader ({reason}): install it (libopenxr-loader1, openxr-loader), or a headset's runtime that brings it"
    )]
    NoLoader {
        /// What the system said.
        reason: String,
    },
    /// No runtime is set up, or the one that is does not answer.
    #[error(
        "no OpenXR runtime answers ({reason}): start the headset's software, and set its runtime as the active one (or XR_RUNTIME_JSON to its manifest)"
    )]
    NoRuntime {
        /// What the loader or the runtime said.
        reason: String,
    },
    /// The runtime knows no headset.
    #[error("{runtime} finds no headset ({reason}): connect it and switch it on")]
    NoHeadset {
        /// Name of the runtime.
        runtime: String,
        /// What the runtime said.
        reason: String,
    },
    /// The headset does not have two eyes.
    #[error(
        "{runtime} shows no stereo pictures: a headset with a view for each eye is needed, it offers {offered}"
    )]
    NoStereo {
        /// Name of the runtime.
        runtime: String,
        /// The view configurations that it has.
        offered: String,
    },
    /// The runtime does not have an extension that nothing works without.
    #[error("{runtime} does not offer {extension}: use a runtime that takes pictures from Vulkan")]
    MissingExtension {
        /// Name of the runtime.
        runtime: String,
        /// Name of the extension.
        extension: &'static str,
    },
    /// Vulkan is missing, too old, or gave no device for the headset.
    #[error("no Vulkan device for the headset: {what}: {reason}")]
    Vulkan {
        /// What was tried.
        what: &'static str,
        /// What went wrong.
        reason: String,
    },
    /// The runtime takes no format that pictures can be written to unchanged.
    #[error("the runtime takes no pictures of 8 bits in sRGB, only Vulkan formats {offered}")]
    NoFormat {
        /// Numbers of the Vulkan formats that it takes.
        offered: String,
    },
    /// The runtime or its session is gone; what was made of it cannot be used any more.
    #[error(
        "the OpenXR runtime was lost in {call} ({reason}): it was closed or crashed; begin anew once it runs again"
    )]
    RuntimeLost {
        /// The call that told.
        call: &'static str,
        /// What it said.
        reason: String,
    },
    /// The runtime refused a call.
    #[error("the OpenXR runtime refused {call}: {reason}")]
    Refused {
        /// The call.
        call: &'static str,
        /// What the runtime said.
        reason: String,
    },
    /// An error of the device.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// Results of calls into the runtime.
pub(crate) trait Called<T> {
    /// Says which call an error came from.
    fn called(self, call: &'static str) -> Result<T, XrError>;
}

impl<T> Called<T> for xr::Result<T> {
    fn called(self, call: &'static str) -> Result<T, XrError> {
        self.map_err(|error| XrError::of(call, error))
    }
}

impl XrError {
    /// What an error of a call tells.
    pub(crate) fn of(call: &'static str, error: xr::sys::Result) -> Self {
        let reason = format!("{error:?}");
        match error {
            xr::sys::Result::ERROR_INSTANCE_LOST | xr::sys::Result::ERROR_SESSION_LOST => {
                Self::RuntimeLost { call, reason }
            }
            _ => Self::Refused { call, reason },
        }
    }
}

/// Results of calls into Vulkan and what wraps it.
pub(crate) trait Tried<T> {
    /// Says what was tried.
    fn tried(self, what: &'static str) -> Result<T, XrError>;
}

impl<T, E: std::fmt::Display> Tried<T> for Result<T, E> {
    fn tried(self, what: &'static str) -> Result<T, XrError> {
        self.map_err(|error| XrError::Vulkan { what, reason: error.to_string() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lost_runtimes_are_told_from_refused_calls() {
        let told = |error| XrError::of("xrEndFrame", error);
        for lost in [xr::sys::Result::ERROR_INSTANCE_LOST, xr::sys::Result::ERROR_SESSION_LOST] {
            assert!(matches!(told(lost), XrError::RuntimeLost { call: "xrEndFrame", .. }), "{lost:?}");
        }
        let refused = told(xr::sys::Result::ERROR_CALL_ORDER_INVALID);
        assert_eq!(refused.to_string(), "the OpenXR runtime refused xrEndFrame: ERROR_CALL_ORDER_INVALID");
    }
}
