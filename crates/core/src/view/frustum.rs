//! Projections: a frustum of four tangents, an orthographic box, or a projector's picture.

use super::Mcop;
use std::ops::Range;
use thiserror::Error;

/// A perspective pyramid: tangents of the angles from −Z to its four sides, as `OpenXR` gives them.
///
/// Left and down are negative for an eye that looks through the middle of its window; any off-axis window is
/// as good.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frustum {
    /// x / −z at the left edge.
    pub left: f64,
    /// x / −z at the right edge.
    pub right: f64,
    /// y / −z at the bottom edge.
    pub down: f64,
    /// y / −z at the top edge.
    pub up: f64,
    /// Nearest visible depth along −Z, metres.
    pub near_m: f64,
    /// Furthest visible depth along −Z, metres; may be infinite.
    pub far_m: f64,
}

/// A parallel projection: the box of view space that is visible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrthographicBox {
    /// x at the left edge, metres.
    pub left_m: f64,
    /// x at the right edge, metres.
    pub right_m: f64,
    /// y at the bottom edge, metres.
    pub down_m: f64,
    /// y at the top edge, metres.
    pub up_m: f64,
    /// Nearest visible depth along −Z, metres; may be negative.
    pub near_m: f64,
    /// Furthest visible depth along −Z, metres; may be infinite.
    pub far_m: f64,
}

/// How view space maps to the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// All rays meet in the eye.
    Perspective(Frustum),
    /// All rays are parallel to −Z.
    Orthographic(OrthographicBox),
    /// Rays go through an emitter horizontally and through a virtual viewer vertically.
    Mcop(Mcop),
}

/// Why numbers do not make a frustum.
#[derive(Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FrustumError {
    /// A field of view outside (0, π).
    #[error("field of view {0} rad: must be above 0 and below pi")]
    FieldOfView(f64),
    /// A height of a parallel projection that is not above zero.
    #[error("height {0} m of a parallel projection: must be above 0 and finite")]
    Height(f64),
    /// A picture without area.
    #[error("picture of {0}x{1} pixels: both must be at least 1")]
    Size(u32, u32),
}

/// Nearest visible depth of the default frusta, metres.
const NEAR_M: f64 = 0.001;

impl Frustum {
    /// A symmetric frustum from the field of view of the picture's shorter side; the longer one's follows from square pixels. So what
    /// fits a square picture fits pictures of all shapes.
    ///
    /// # Errors
    /// A field of view outside (0, π) or an empty picture.
    pub fn from_fov(fov_rad: f64, size: [u32; 2]) -> Result<Self, FrustumError> {
        if !(fov_rad > 0.0 && fov_rad < std::f64::consts::PI) {
            return Err(FrustumError::FieldOfView(fov_rad));
        }
        if size.contains(&0) {
            return Err(FrustumError::Size(size[0], size[1]));
        }
        let shorter = f64::from(size[0].min(size[1]));
        let [right, up] = size.map(|side| (0.5 * fov_rad).tan() * f64::from(side) / shorter);
        Ok(Self { left: -right, right, down: -up, up, near_m: NEAR_M, far_m: f64::INFINITY })
    }

    /// The same frustum with its window moved sideways by a tangent.
    #[must_use]
    pub fn sheared(self, tangent: f64) -> Self {
        Self { left: self.left + tangent, right: self.right + tangent, ..self }
    }
}

impl OrthographicBox {
    /// A symmetric box of a given height in metres; the width follows from square pixels.
    ///
    /// # Errors
    /// An empty picture, or a height that is not positive and finite.
    pub fn from_height(height_m: f64, size: [u32; 2]) -> Result<Self, FrustumError> {
        if size.contains(&0) {
            return Err(FrustumError::Size(size[0], size[1]));
        }
        if !(height_m > 0.0 && height_m.is_finite()) {
            return Err(FrustumError::Height(height_m));
        }
        let up_m = 0.5 * height_m;
        let right_m = up_m * f64::from(size[0]) / f64::from(size[1]);
        Ok(Self {
            left_m: -right_m,
            right_m,
            down_m: -up_m,
            up_m,
            near_m: f64::NEG_INFINITY,
            far_m: f64::INFINITY,
        })
    }
}

impl Projection {
    /// Nearest and furthest visible depth along −Z, metres.
    pub fn depth_range_m(&self) -> (f64, f64) {
        match self {
            Self::Perspective(f) => (f.near_m, f.far_m),
            Self::Orthographic(o) => (o.near_m, o.far_m),
            Self::Mcop(m) => (m.near_m, m.far_m),
        }
    }

    /// The same with no other depths than some, metres.
    #[must_use]
    pub fn within(self, depths_m: &Range<f64>) -> Self {
        let (near_m, far_m) = self.depth_range_m();
        let (near_m, far_m) = (near_m.max(depths_m.start), far_m.min(depths_m.end));
        match self {
            Self::Perspective(f) => Self::Perspective(Frustum { near_m, far_m, ..f }),
            Self::Orthographic(o) => Self::Orthographic(OrthographicBox { near_m, far_m, ..o }),
            Self::Mcop(m) => Self::Mcop(Mcop { near_m, far_m, ..m }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_field_of_view_is_that_of_the_shorter_side() {
        let tangent = 0.5_f64.tan();
        for (size, right, up) in [
            ([40, 20], 2.0 * tangent, tangent),
            ([20, 40], tangent, 2.0 * tangent),
            ([7, 7], tangent, tangent),
        ] {
            let frustum = Frustum::from_fov(1.0, size).unwrap();
            assert!((frustum.right - right).abs() < 1e-12 && (frustum.up - up).abs() < 1e-12, "{size:?}");
            assert_eq!((frustum.left, frustum.down), (-frustum.right, -frustum.up));
        }
        assert_eq!(Frustum::from_fov(4.0, [1, 1]), Err(FrustumError::FieldOfView(4.0)));
        assert_eq!(Frustum::from_fov(1.0, [0, 1]), Err(FrustumError::Size(0, 1)));
    }
}
