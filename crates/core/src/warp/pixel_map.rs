//! Where what one view shows lies in another view's picture.

use super::WarpError;
use super::error::LONGEST_SIDE;
use crate::view::{Frustum, PixelRect, Projection, View};
use glam::{DMat3, DVec2, DVec3};
use std::ops::Range;

/// From pixel and depth in one perspective view to pixel and depth in another.
///
/// A point at pixel (x, y), in pixels from the top left with centres at ½, and at inverse depth q (1/m; 0 is infinity) has
/// homogeneous pixel coordinates `h = matrix · (x, y, 1) + q · epipole` in the other view: pixel `h.xy / h.z`, inverse depth
/// `q / h.z`, not in front of the eye unless `h.z > 0`. Inverse depth is affine in the pixels of a plane, so triangles
/// interpolate it linearly and it can be a depth buffer's value as it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelMap {
    /// The map of points at infinity.
    pub matrix: DMat3,
    /// Homogeneous pixel of the first view's eye in the second view's picture, per metre.
    pub epipole: DVec3,
}

/// Where a point lands in the other picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landing {
    /// Pixels from the top left.
    pub position: DVec2,
    /// One over the depth along the other view's −Z, 1/m.
    pub inverse_depth: f64,
}

impl PixelMap {
    /// The map from the picture of the shown view to that of the wanted view.
    ///
    /// # Errors
    /// A parallel projection, numbers that are not finite, an empty window or picture.
    pub fn between(shown: &View, wanted: &View) -> Result<Self, WarpError> {
        let from = checked_window("shown", shown)?;
        let to = checked_window("wanted", wanted)?;
        let wanted_from_shown = wanted.view_from_world * shown.view_from_world.inverse();
        let tangents_from_pixel = DMat3::from_cols(
            DVec3::X * ((from.right - from.left) / f64::from(shown.size[0])),
            DVec3::Y * ((from.down - from.up) / f64::from(shown.size[1])),
            DVec3::new(from.left, from.up, -1.0),
        );
        let scale_x = f64::from(wanted.size[0]) / (to.right - to.left);
        let scale_y = f64::from(wanted.size[1]) / (to.down - to.up);
        let pixel_from_view = DMat3::from_cols(
            DVec3::X * scale_x,
            DVec3::Y * scale_y,
            DVec3::new(to.left * scale_x, to.up * scale_y, -1.0),
        );
        Ok(Self {
            matrix: pixel_from_view * wanted_from_shown.matrix3 * tangents_from_pixel,
            epipole: pixel_from_view * wanted_from_shown.translation,
        })
    }

    /// The map for what is on a plane across the other view at an inverse depth in it, 1/m, which is all of the first view's picture:
    /// what lands at s from infinity lands at `s + q · (epipole.xy − epipole.z · s)`.
    pub fn onto_plane(&self, inverse_depth: f64) -> Self {
        let q = self.plane_before_eye(inverse_depth);
        let from_infinity = DMat3::from_diagonal((DVec2::ONE - q * self.epipole.z).extend(1.0));
        let by_depth = DMat3::from_cols(DVec3::ZERO, DVec3::ZERO, q * self.epipole.truncate().extend(0.0));
        Self { matrix: (from_infinity + by_depth) * self.matrix, epipole: DVec3::ZERO }
    }

    /// Inverse depth of a plane across the other view, 1/m, or, if the first view's eye has come more than halfway to it, of the one
    /// twice as far as the eye is.
    pub fn plane_before_eye(&self, inverse_depth: f64) -> f64 {
        if inverse_depth * self.epipole.z > 0.5 { 0.5 / self.epipole.z } else { inverse_depth }
    }

    /// Where the point at a pixel position and an inverse depth lands; nowhere unless in front of the other eye.
    pub fn at(&self, position: DVec2, inverse_depth: f64) -> Option<Landing> {
        let h = self.matrix * position.extend(1.0) + inverse_depth * self.epipole;
        (h.z > 0.0).then(|| Landing { position: h.truncate() / h.z, inverse_depth: inverse_depth / h.z })
    }

    /// The pixels of the other view, of a size, that what is in some pixels and between two inverse depths can land in.
    pub fn covered(&self, pixels: &PixelRect, inverse_depths: Range<f64>, size: [u32; 2]) -> PixelRect {
        if pixels.is_empty() {
            return PixelRect { columns: 0..0, rows: 0..0 };
        }
        // A pixel more on each side, into which interpolation fades.
        let ends = |pixels: &Range<u32>| [f64::from(pixels.start) - 1.0, f64::from(pixels.end) + 1.0];
        let corners = ends(&pixels.columns).map(|x| ends(&pixels.rows).map(|y| DVec2::new(x, y)));
        let landings = corners.into_iter().flatten().flat_map(|corner| {
            [inverse_depths.start, inverse_depths.end].map(|inverse_depth| self.at(corner, inverse_depth))
        });
        PixelRect::of_positions(landings.map(|landing| Some(landing?.position)), size)
    }
}

fn checked_window(which: &'static str, view: &View) -> Result<Frustum, WarpError> {
    if view.size.iter().any(|side| !(1..=LONGEST_SIDE).contains(side)) {
        return Err(WarpError::Size { which, size: view.size });
    }
    let Projection::Perspective(frustum) = view.projection else {
        return Err(WarpError::Projection(which));
    };
    let Frustum { left, right, down, up, near_m, .. } = frustum;
    let determinant = view.view_from_world.matrix3.determinant();
    let is_sound = view.view_from_world.is_finite()
        && determinant.is_normal()
        && [left, right, down, up, near_m].iter().all(|number| number.is_finite())
        && right > left
        && up > down;
    if is_sound { Ok(frustum) } else { Err(WarpError::View(which)) }
}
