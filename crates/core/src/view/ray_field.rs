//! The rays of a view: affine in the pixel coordinates.

use super::{Projection, View};
use glam::{DAffine3, DVec2, DVec3, DVec4};

/// Rays of all pixels, in the space that `target_from_world` led to.
///
/// Pixel (x, y), counted from the top left with centres at ½, has
/// `origin + x·origin_dx + y·origin_dy` and `direction + x·direction_dx + y·direction_dy`. The ray parameter
/// is the **depth along view −Z in metres** for every projection, so it is also the depth that is written. Of light-field displays
/// both the origin, on the screen, and the direction depend on the pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RayField {
    /// Origin at the picture's top left corner.
    pub origin: DVec3,
    /// Change of the origin per pixel to the right.
    pub origin_dx: DVec3,
    /// Change of the origin per pixel down.
    pub origin_dy: DVec3,
    /// Direction at the picture's top left corner, per metre of depth.
    pub direction: DVec3,
    /// Change of the direction per pixel to the right.
    pub direction_dx: DVec3,
    /// Change of the direction per pixel down.
    pub direction_dy: DVec3,
    /// Nearest and furthest depth, metres.
    pub depth_range_m: (f64, f64),
    /// Where the rays of the picture's left edge are shaded from, in homogeneous coordinates: a point has w = 1, a direction w = 0.
    pub viewpoint: DVec4,
    /// Change of that per pixel to the right: rays of a projector of a light-field display go to eyes side by side.
    pub viewpoint_dx: DVec3,
}

impl RayField {
    /// The rays of a view in another space, such as texture space.
    pub fn new(view: &View, target_from_world: DAffine3) -> Self {
        let target_from_view = target_from_world * view.view_from_world.inverse();
        let vector = |v: DVec3| target_from_view.transform_vector3(v);
        let point = |p: DVec3| target_from_view.transform_point3(p);
        let (width, height) = (f64::from(view.size[0]), f64::from(view.size[1]));
        let depth_range_m = view.projection.depth_range_m();
        let viewpoint = view.viewpoint().homogeneous(target_from_world);
        let viewpoint_dx = DVec3::ZERO;
        match view.projection {
            Projection::Perspective(f) => Self {
                origin: point(DVec3::ZERO),
                origin_dx: DVec3::ZERO,
                origin_dy: DVec3::ZERO,
                direction: vector(DVec3::new(f.left, f.up, -1.0)),
                direction_dx: vector(DVec3::X * ((f.right - f.left) / width)),
                direction_dy: vector(DVec3::Y * ((f.down - f.up) / height)),
                depth_range_m,
                viewpoint,
                viewpoint_dx,
            },
            Projection::Orthographic(o) => Self {
                origin: point(DVec3::new(o.left_m, o.up_m, 0.0)),
                origin_dx: vector(DVec3::X * ((o.right_m - o.left_m) / width)),
                origin_dy: vector(DVec3::Y * ((o.down_m - o.up_m) / height)),
                direction: vector(DVec3::NEG_Z),
                direction_dx: DVec3::ZERO,
                direction_dy: DVec3::ZERO,
                depth_range_m,
                viewpoint,
                viewpoint_dx,
            },
            Projection::Mcop(m) => {
                let corner_m = DVec2::new(m.left_m, m.up_m);
                let (dx_m, dy_m) = ((m.right_m - m.left_m) / width, (m.down_m - m.up_m) / height);
                let middle_m = DVec2::new(m.left_m, 0.5 * (m.down_m + m.up_m));
                let (viewpoint, viewpoint_dx) = match view.shaded_from {
                    Some(_) => (viewpoint, viewpoint_dx),
                    None => (
                        point(m.eye_m(middle_m)).extend(1.0),
                        vector(DVec3::X * (dx_m * (1.0 - m.viewer_z_m / m.emitter_z_m))),
                    ),
                };
                Self {
                    origin: point(corner_m.extend(0.0)),
                    origin_dx: vector(DVec3::X * dx_m),
                    origin_dy: vector(DVec3::Y * dy_m),
                    direction: vector(m.direction(corner_m)),
                    direction_dx: vector(DVec3::X * (dx_m / m.emitter_z_m)),
                    direction_dy: vector(DVec3::Y * (dy_m / m.viewer_z_m)),
                    depth_range_m,
                    viewpoint,
                    viewpoint_dx,
                }
            }
        }
    }

    /// Origin and direction of the ray through a picture position, in pixels from the top left.
    pub fn at(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        (
            self.origin + x * self.origin_dx + y * self.origin_dy,
            self.direction + x * self.direction_dx + y * self.direction_dy,
        )
    }
}
