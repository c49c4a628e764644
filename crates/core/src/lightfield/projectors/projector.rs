//! A projector and the image that it throws onto the screen.

use super::super::error::{check, check_length_m, check_place_m};
use super::DisplayError;
use crate::view::Mcop;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// For whom heights are right (LF §4): everything is exact at this height and distance, whatever the place to the side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VirtualViewer {
    /// Above the middle of the screen, metres.
    pub height_m: f64,
    /// In front of the screen, metres; above 0.
    pub distance_m: f64,
}

/// Where on the screen a projector's image is.
///
/// An image that is thrown by way of a mirror is reversed: its first column is further to the right, and `left_m` greater than
/// `right_m`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageRect {
    /// x of the left edge of the first column, metres.
    pub left_m: f64,
    /// x of the right edge of the last column, metres.
    pub right_m: f64,
    /// y of the bottom edge of the last row, metres; below `up_m`.
    pub down_m: f64,
    /// y of the top edge of the first row, metres.
    pub up_m: f64,
}

/// A projector, or what is seen of one in a side mirror: an idealised pinhole (LF §4).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Projector {
    /// Number by which the display knows it, from 0 to 16,777,214.
    pub id: u32,
    /// Place of the emitter in display space, metres; z is negative. Of a virtual projector, as seen in the mirror.
    pub emitter_m: [f64; 3],
    /// Its image.
    pub image: ImageRect,
}

/// Largest id: a colour of three bytes, of which the largest marks a free place.
pub(super) const LAST_ID: u32 = 0xFF_FFFE;

/// Least distance between an emitter and the screen, and least side of an image, metres.
const LEAST_M: f64 = 1e-6;

impl VirtualViewer {
    pub(super) fn check(self) -> Result<(), DisplayError> {
        check_place_m("viewer.height_m", self.height_m)?;
        check_length_m("viewer.distance_m", self.distance_m)
    }
}

impl Projector {
    pub(super) fn check(&self, index: usize) -> Result<(), DisplayError> {
        let field = |name: &str| format!("projectors[{index}].{name}");
        check(self.id <= LAST_ID, field("id"), f64::from(self.id), "at most 16777214")?;
        let [x_m, y_m, z_m] = self.emitter_m;
        check_place_m(field("emitter_m[0]"), x_m)?;
        check_place_m(field("emitter_m[1]"), y_m)?;
        check_place_m(field("emitter_m[2]"), z_m)?;
        check(
            z_m <= -LEAST_M,
            field("emitter_m[2]"),
            z_m,
            "at most -0.000001 m: emitters are behind the screen",
        )?;
        let ImageRect { left_m, right_m, down_m, up_m } = self.image;
        check_place_m(field("image.left_m"), left_m)?;
        check_place_m(field("image.right_m"), right_m)?;
        check_place_m(field("image.down_m"), down_m)?;
        check_place_m(field("image.up_m"), up_m)?;
        let is_wide = (right_m - left_m).abs() >= LEAST_M;
        check(
            is_wide,
            field("image.right_m"),
            right_m,
            "at least 0.000001 m from left_m: images have a width",
        )?;
        check(up_m - down_m >= LEAST_M, field("image.up_m"), up_m, "at least 0.000001 m above down_m")
    }

    /// The projection of its picture.
    pub fn mcop(&self, viewer: VirtualViewer) -> Mcop {
        let [emitter_x_m, _, emitter_z_m] = self.emitter_m;
        let ImageRect { left_m, right_m, down_m, up_m } = self.image;
        Mcop {
            emitter_x_m,
            emitter_z_m,
            viewer_y_m: viewer.height_m,
            viewer_z_m: viewer.distance_m,
            left_m,
            right_m,
            down_m,
            up_m,
            near_m: -viewer.distance_m,
            far_m: -emitter_z_m,
        }
    }

    /// What is seen of it in a mirror in the plane x = `mirror_x_m`, under another id.
    #[must_use]
    pub fn reflected(&self, mirror_x_m: f64, id: u32) -> Self {
        let reflected = |x_m: f64| 2.0 * mirror_x_m - x_m;
        let [x_m, y_m, z_m] = self.emitter_m;
        let ImageRect { left_m, right_m, .. } = self.image;
        Self {
            id,
            emitter_m: [reflected(x_m), y_m, z_m],
            image: ImageRect { left_m: reflected(left_m), right_m: reflected(right_m), ..self.image },
        }
    }

    /// The emitter as a point of display space, metres.
    pub fn emitter(&self) -> DVec3 {
        self.emitter_m.into()
    }

    /// The place on the screen of a position in its image, pixels from the top left.
    pub fn screen_m(&self, pixel: DVec2, image_size_px: [u32; 2]) -> DVec2 {
        let ImageRect { left_m, right_m, down_m, up_m } = self.image;
        let share = pixel / DVec2::from(image_size_px.map(f64::from));
        DVec2::new(left_m + (right_m - left_m) * share.x, up_m + (down_m - up_m) * share.y)
    }

    /// The position in its image of a place on the screen, pixels from the top left; beyond the edges if it is not in the image.
    pub fn pixel(&self, screen_m: DVec2, image_size_px: [u32; 2]) -> DVec2 {
        let ImageRect { left_m, right_m, down_m, up_m } = self.image;
        let share =
            DVec2::new((screen_m.x - left_m) / (right_m - left_m), (screen_m.y - up_m) / (down_m - up_m));
        share * DVec2::from(image_size_px.map(f64::from))
    }
}
