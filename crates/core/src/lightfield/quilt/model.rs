//! Displays that people own.

use super::QuiltDisplay;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A display by Looking Glass Factory.
///
/// Columns, rows, sizes and aspects of quilts, and pixels, dots per inch and view cones of panels, are those of the maker's device
/// templates (`LKGDeviceTemplateSystem` of its Unity plugin; the quilts also in <https://docs.lookingglassfactory.com/keyconcepts/quilts>).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Model {
    /// Looking Glass Portrait.
    Portrait,
    /// Looking Glass Go.
    Go,
    /// Looking Glass 16", second generation.
    Inch16,
    /// Looking Glass 32", second generation.
    Inch32,
    /// Looking Glass 65".
    Inch65,
    /// Looking Glass 16" Light Field Display (Spatial Display), landscape.
    Inch16Landscape,
    /// Looking Glass 16" Light Field Display (Spatial Display), portrait.
    Inch16Portrait,
    /// Looking Glass 32" Light Field Display (Spatial Display), landscape.
    Inch32Landscape,
    /// Looking Glass 32" Light Field Display (Spatial Display), portrait.
    Inch32Portrait,
}

/// A name that no known display has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no display is called {0:?}; there are {names}", names = Model::names())]
pub struct UnknownModel(pub String);

/// What is known of a model.
struct Facts {
    name: &'static str,
    quilt: [u32; 2],
    quilt_size_px: [u32; 2],
    view_cone_deg: f64,
    panel_px: [u32; 2],
    dots_per_inch: f64,
}

const METRES_PER_INCH: f64 = 0.0254;

/// Distance of the cameras from the screen over its height. A field of view of 14° from the bottom to the top of the screen, the
/// default of the maker's software.
fn distance_per_height() -> f64 {
    0.5 / 7.0_f64.to_radians().tan()
}

impl Model {
    /// Every model.
    pub const ALL: &[Self] = &[
        Self::Portrait,
        Self::Go,
        Self::Inch16,
        Self::Inch32,
        Self::Inch65,
        Self::Inch16Landscape,
        Self::Inch16Portrait,
        Self::Inch32Landscape,
        Self::Inch32Portrait,
    ];

    fn facts(self) -> Facts {
        let facts = |name, quilt, quilt_size_px, view_cone_deg, panel_px, dots_per_inch| Facts {
            name,
            quilt,
            quilt_size_px,
            view_cone_deg,
            panel_px,
            dots_per_inch,
        };
        match self {
            Self::Portrait => facts("portrait", [8, 6], [3360, 3360], 40.0, [1536, 2048], 324.0),
            Self::Go => facts("go", [11, 6], [4092, 4092], 54.0, [1440, 2560], 491.0),
            Self::Inch16 => facts("16", [5, 9], [4096, 4096], 40.0, [3840, 2160], 283.0),
            Self::Inch32 => facts("32", [5, 9], [8192, 8192], 40.0, [7680, 4320], 280.0),
            Self::Inch65 => facts("65", [8, 9], [8192, 8192], 40.0, [7680, 4320], 136.0),
            Self::Inch16Landscape => facts("16-landscape", [7, 7], [5999, 5999], 50.0, [3840, 2160], 283.0),
            Self::Inch16Portrait => facts("16-portrait", [11, 6], [5995, 6000], 50.0, [2160, 3840], 283.0),
            Self::Inch32Landscape => facts("32-landscape", [7, 7], [8190, 8190], 50.0, [7680, 4320], 280.0),
            Self::Inch32Portrait => facts("32-portrait", [11, 6], [8184, 8184], 54.0, [4320, 7680], 280.0),
        }
    }

    /// Name as written on the command line.
    pub fn name(self) -> &'static str {
        self.facts().name
    }

    /// Width and height of the panel behind the lenses, pixels.
    pub fn panel_px(self) -> [u32; 2] {
        self.facts().panel_px
    }

    /// The display as it is fed with quilts.
    pub fn display(self) -> QuiltDisplay {
        let Facts { quilt: [columns, rows], quilt_size_px, view_cone_deg, panel_px, dots_per_inch, .. } =
            self.facts();
        let [width_px, height_px] = panel_px.map(f64::from);
        let screen_height_m = height_px / dots_per_inch * METRES_PER_INCH;
        QuiltDisplay {
            columns,
            rows,
            quilt_size_px,
            aspect: width_px / height_px,
            view_cone_deg,
            focal_distance_m: screen_height_m * distance_per_height(),
            screen_height_m,
        }
    }

    fn names() -> String {
        Self::ALL.iter().map(|model| model.name()).collect::<Vec<_>>().join(", ")
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Model {
    type Err = UnknownModel;

    fn from_str(name: &str) -> Result<Self, UnknownModel> {
        let named = Self::ALL.iter().copied().find(|model| model.name() == name);
        named.ok_or_else(|| UnknownModel(name.to_owned()))
    }
}
