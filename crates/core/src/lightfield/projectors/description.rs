//! What is written of a display of projectors.

use super::super::error::{check, check_length_m, check_pixels, check_size_px, check_version, from_object};
use super::{DisplayError, Packing, Projector, VirtualViewer};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything about a display of projectors (LF §4, §6), as read from and written to JSON: `docs/displays.md` has an example.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Version of the form: 1.
    pub wheatstone_projector_array: u64,
    /// Width and height of the screen, metres.
    pub screen_size_m: [f64; 2],
    /// Size of a pixel on the screen, s₀ of LF Eq. 3, metres.
    pub pixel_size_m: f64,
    /// Angle within which a beam leaves the screen to the sides, Φ of LF Eq. 3, degrees.
    pub beam_angle_deg: f64,
    /// For whom heights are right.
    pub viewer: VirtualViewer,
    /// Width and height of each projector's image, pixels.
    pub image_size_px: [u32; 2],
    /// The projectors, those seen in mirrors with them.
    pub projectors: Vec<Projector>,
    /// How images are sent to the display.
    pub packing: Packing,
}

/// The version that is read and written.
pub(super) const VERSION: u64 = 1;

/// Most projectors of a display.
const MOST_PROJECTORS: usize = 4096;

impl Description {
    pub(super) fn parse(text: &str) -> Result<Self, DisplayError> {
        from_object(text)
    }

    pub(super) fn to_json(&self) -> String {
        serde_json::to_string_pretty(self).expect("numbers and lists can be written")
    }

    pub(super) fn check(&self) -> Result<(), DisplayError> {
        check_version(self.wheatstone_projector_array, VERSION)?;
        check_length_m("screen_size_m[0]", self.screen_size_m[0])?;
        check_length_m("screen_size_m[1]", self.screen_size_m[1])?;
        check_length_m("pixel_size_m", self.pixel_size_m)?;
        let beam_angle = self.beam_angle_deg;
        check(beam_angle > 0.0 && beam_angle < 90.0, "beam_angle_deg", beam_angle, "above 0 and below 90")?;
        self.viewer.check()?;
        check_size_px("image_size_px", self.image_size_px)?;
        let count = self.projectors.len();
        if !(1..=MOST_PROJECTORS).contains(&count) {
            return Err(DisplayError::Count { field: "projectors", count, expected: "from 1 to 4096" });
        }
        check_pixels("the pixels of all projectors", self.image_size_px, count)?;
        let mut indices = BTreeMap::new();
        for (second, projector) in self.projectors.iter().enumerate() {
            projector.check(second)?;
            if let Some(first) = indices.insert(projector.id, second) {
                return Err(DisplayError::RepeatedId { id: projector.id, first, second });
            }
        }
        self.packing.check(self.image_size_px)
    }
}
