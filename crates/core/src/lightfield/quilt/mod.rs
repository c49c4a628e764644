//! Quilts: the views of a display behind lenses as tiles of one picture.

mod depth_range;
mod model;
mod name;
mod tiles;

pub use depth_range::DepthRange;
pub use model::{Model, UnknownModel};
pub use name::{NotAQuiltName, QuiltName};
pub use tiles::TileError;

use super::DisplayError;
use super::error::{check, check_length_m, check_size_px, from_object};
use crate::view::{Frustum, Projection, View};
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

/// A display that is fed with quilts.
///
/// View 0 is the tile at the bottom left and that of the leftmost camera; views go on to the right, then up. The cameras are side by
/// side at the focal distance from the screen, all of them look straight at it, and the screen is what all of them see in full.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct QuiltDisplay {
    /// Tiles beside each other.
    pub columns: u32,
    /// Tiles above each other.
    pub rows: u32,
    /// Width and height of the quilt, pixels. What no whole tile fills, at the right and at the top, stays black.
    pub quilt_size_px: [u32; 2],
    /// Width of the screen over its height.
    pub aspect: f64,
    /// Angle between the outermost directions in which there are views, degrees.
    pub view_cone_deg: f64,
    /// Distance from the screen at which each eye sees one view, and at which the cameras are, metres.
    pub focal_distance_m: f64,
    /// Height of the screen, metres.
    pub screen_height_m: f64,
}

/// Where in the view cone the cameras are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Camera i of N at (i + ½)/N of the cone: in the middle of the directions in which its view is seen.
    #[default]
    Middles,
    /// At i/(N − 1): from one end of the cone to the other.
    Ends,
}

/// Most views of a quilt.
const MOST_VIEWS: u64 = 1024;

impl Sampling {
    /// Where in the cone a camera is, from 0 (leftmost) to 1.
    pub fn share(self, index: u32, count: u32) -> f64 {
        match self {
            Self::Middles => (f64::from(index) + 0.5) / f64::from(count),
            Self::Ends if count == 1 => 0.5,
            Self::Ends => f64::from(index) / f64::from(count - 1),
        }
    }
}

impl QuiltDisplay {
    /// The same if it can be one.
    ///
    /// # Errors
    /// No tiles, tiles without pixels, an aspect or lengths that are not above 0, a cone that is none.
    pub fn checked(self) -> Result<Self, DisplayError> {
        check(self.columns > 0, "columns", f64::from(self.columns), "at least 1")?;
        check(self.rows > 0, "rows", f64::from(self.rows), "at least 1")?;
        let views = u64::from(self.columns) * u64::from(self.rows);
        if views > MOST_VIEWS {
            return Err(DisplayError::TooManyPixels {
                field: "the tiles of a quilt",
                count: views,
                most: MOST_VIEWS,
            });
        }
        check_size_px("quilt_size_px", self.quilt_size_px)?;
        for (axis, (side, tiles)) in self.quilt_size_px.into_iter().zip([self.columns, self.rows]).enumerate()
        {
            let field = format!("quilt_size_px[{axis}]");
            check(side >= tiles, field, f64::from(side), "at least a pixel for each tile")?;
        }
        check(self.aspect > 0.01 && self.aspect < 100.0, "aspect", self.aspect, "above 0.01 and below 100")?;
        let cone = self.view_cone_deg;
        check(cone > 0.0 && cone < 180.0, "view_cone_deg", cone, "above 0 and below 180")?;
        check_length_m("focal_distance_m", self.focal_distance_m)?;
        check_length_m("screen_height_m", self.screen_height_m)?;
        Ok(self)
    }

    /// Reads a description from JSON.
    ///
    /// # Errors
    /// What is no JSON, lacks a field or has an unknown one, or as of [`QuiltDisplay::checked`].
    pub fn from_json(text: &str) -> Result<Self, DisplayError> {
        from_object::<Self>(text)?.checked()
    }

    /// Views of a quilt.
    pub fn view_count(&self) -> u32 {
        self.columns * self.rows
    }

    /// Width and height of a tile, pixels.
    pub fn tile_size_px(&self) -> [u32; 2] {
        [self.quilt_size_px[0] / self.columns, self.quilt_size_px[1] / self.rows]
    }

    /// Width and height of the screen, metres.
    pub fn screen_size_m(&self) -> [f64; 2] {
        [self.screen_height_m * self.aspect, self.screen_height_m]
    }

    /// How far to the right of the middle the place is that is a share of the view cone from its left end, at the focal distance,
    /// metres. Equal shares are equal angles.
    pub fn camera_x_m(&self, share: f64) -> f64 {
        self.focal_distance_m * ((share - 0.5) * self.view_cone_deg.to_radians()).tan()
    }

    /// The share of the view cone of a place at the focal distance: the inverse of [`QuiltDisplay::camera_x_m`].
    pub fn share_of_camera(&self, x_m: f64) -> f64 {
        0.5 + (x_m / self.focal_distance_m).atan() / self.view_cone_deg.to_radians()
    }

    /// The views of a world in which the display stands, in order. Each is shaded from its own camera: highlights and what else depends
    /// on the eye go with it (LF §6).
    pub fn views(&self, sampling: Sampling, display_from_world: DAffine3) -> Vec<View> {
        let count = self.view_count();
        let camera = |index| self.camera_x_m(sampling.share(index, count));
        (0..count).map(|index| self.view_from(camera(index), display_from_world)).collect()
    }

    /// The view of a camera so far to the right of the middle: an off-axis frustum through the screen.
    fn view_from(&self, x_m: f64, display_from_world: DAffine3) -> View {
        let camera_m = DVec3::new(x_m, 0.0, self.focal_distance_m);
        screen_view(camera_m, self.screen_size_m(), self.tile_size_px(), display_from_world)
    }
}

/// What an eye in display space sees through the screen: an off-axis frustum whose picture is the screen.
pub(super) fn screen_view(
    eye_m: DVec3,
    [width_m, height_m]: [f64; 2],
    size: [u32; 2],
    display_from_world: DAffine3,
) -> View {
    let tangent = |edge_m: f64| edge_m / eye_m.z;
    let frustum = Frustum {
        left: tangent(-0.5 * width_m - eye_m.x),
        right: tangent(0.5 * width_m - eye_m.x),
        down: tangent(-0.5 * height_m - eye_m.y),
        up: tangent(0.5 * height_m - eye_m.y),
        near_m: NEAREST * eye_m.z,
        far_m: f64::INFINITY,
    };
    View {
        view_from_world: DAffine3::from_translation(-eye_m) * display_from_world,
        projection: Projection::Perspective(frustum),
        size,
        shaded_from: None,
    }
}

/// Nearest depth that is seen, as a part of the distance from the screen.
const NEAREST: f64 = 1e-3;
