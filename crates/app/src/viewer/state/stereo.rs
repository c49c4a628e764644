//! One eye or two.

use super::within;
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use wheatstone_core::view::{Rig, View};

/// How many eyes, and how their pictures are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stereo {
    pub(crate) arrangement: Arrangement,
    pub(crate) method: EyeMethod,
    /// Between the eyes, metres.
    pub(crate) eye_distance_m: f64,
}

/// How the eyes' pictures are arranged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Arrangement {
    /// One eye.
    Mono,
    /// Left eye on the left.
    SideBySide,
    /// Red for the left eye, cyan for the right one.
    Anaglyph,
    /// The views of a light-field display beside each other, as they are sent to it.
    Quilt,
    /// What an eye sees of a light-field display.
    LightField,
    /// The picture for the panel of a light-field display behind lenses, pixel by pixel.
    Panel,
}

/// Where the eyes' pictures come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum EyeMethod {
    /// Each is cast.
    #[default]
    TwoCasts,
    /// One is cast in the middle and warped to both.
    OneCast,
}

impl Arrangement {
    pub(crate) const ALL: [Self; 6] =
        [Self::Mono, Self::SideBySide, Self::Anaglyph, Self::Quilt, Self::LightField, Self::Panel];

    /// Whether it is of the views of a light-field display.
    pub(crate) fn is_of_display(self) -> bool {
        match self {
            Self::Quilt | Self::LightField | Self::Panel => true,
            Self::Mono | Self::SideBySide | Self::Anaglyph => false,
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Mono => "one eye",
            Self::SideBySide => "side by side",
            Self::Anaglyph => "anaglyph",
            Self::Quilt => "quilt",
            Self::LightField => "light field",
            Self::Panel => "panel, interlaced",
        }
    }
}

impl EyeMethod {
    pub(crate) const ALL: [Self; 2] = [Self::TwoCasts, Self::OneCast];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::TwoCasts => "cast both eyes",
            Self::OneCast => "cast one, warp to both",
        }
    }
}

impl Default for Stereo {
    fn default() -> Self {
        Self { arrangement: Arrangement::Mono, method: EyeMethod::TwoCasts, eye_distance_m: 0.065 }
    }
}

impl Stereo {
    /// Whether the picture is arranged for two eyes.
    pub(crate) fn has_two_eyes(&self) -> bool {
        matches!(self.arrangement, Arrangement::SideBySide | Arrangement::Anaglyph)
    }

    /// Whether two eyes are shown what is cast for one in their middle.
    pub(crate) fn shows_one_cast_to_two_eyes(&self) -> bool {
        self.has_two_eyes() && self.method == EyeMethod::OneCast
    }

    /// Size of each eye's picture within an area, pixels.
    pub(crate) fn eye_size(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        match self.arrangement {
            Arrangement::SideBySide => [(width / 2).max(1), height],
            Arrangement::Mono
            | Arrangement::Anaglyph
            | Arrangement::Quilt
            | Arrangement::LightField
            | Arrangement::Panel => [width, height],
        }
    }

    /// What the eyes see, left one first; both see what is `convergence_m` away at the same place.
    pub(crate) fn views(&self, middle: &View, convergence_m: f64) -> Vec<View> {
        let rig = if self.has_two_eyes() {
            Rig::Stereo { eye_distance_m: self.eye_distance_m, convergence_m }
        } else {
            Rig::Mono
        };
        rig.views(middle)
    }

    pub(super) fn check(&self) -> Result<(), String> {
        within("eye_distance_m", self.eye_distance_m, 0.0, 1.0)
    }
}
