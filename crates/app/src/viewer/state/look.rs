//! How the volume is shown, besides its transfer function.

use super::within;
use crate::camera::Up;
use crate::look::ModeName;
use crate::spec;
use serde::{Deserialize, Serialize};
use wheatstone_core::scene::Shading;

/// Mode, light, sampling.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Look {
    pub(crate) mode: ModeName,
    #[serde(with = "shading_text")]
    pub(crate) shading: Shading,
    /// Value of the isosurface, 0 to 1 in the window.
    pub(crate) isovalue: f64,
    /// Samples per voxel length of a picture at rest.
    pub(crate) sampling_factor: f64,
    pub(crate) preintegrated: bool,
    /// Colour behind the volume.
    pub(crate) background: [f32; 3],
    /// Patient direction that points up.
    pub(crate) up: Up,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            mode: ModeName::Dvr,
            shading: Shading::Phong,
            isovalue: 0.4,
            sampling_factor: 1.0,
            preintegrated: false,
            background: [0.05, 0.06, 0.08],
            up: Up::S,
        }
    }
}

impl Look {
    /// What decides how long a sample takes.
    pub(crate) fn mode_and_shading(&self) -> (ModeName, Shading) {
        (self.mode, self.shading)
    }

    pub(super) fn check(&self) -> Result<(), String> {
        within("isovalue", self.isovalue, 0.0, 1.0)?;
        within("sampling_factor", self.sampling_factor, 0.1, 8.0)?;
        self.background.iter().try_for_each(|&channel| within("background", f64::from(channel), 0.0, 1.0))
    }
}

/// Shadings as on the command line.
pub(super) mod shading_text {
    use super::{Shading, spec};
    use serde::{Deserialize as _, Deserializer, Serializer, de::Error as _};

    pub(crate) fn serialize<S: Serializer>(shading: &Shading, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&spec::shading_name(*shading))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Shading, D::Error> {
        spec::shading(&String::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}
