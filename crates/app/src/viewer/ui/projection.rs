//! From the world to the picture's area.

use egui::{Pos2, Rect, pos2};
use glam::DVec3;
use wheatstone_core::view::{Projection as Lens, View};

/// Points nearer to the eye than this have no place in the picture, metres.
const NEAREST_M: f64 = 1e-3;

/// Where world points are in an area of the window.
#[derive(Debug, Clone, Copy)]
pub(super) struct Projection {
    view: View,
    area: Rect,
}

impl Projection {
    pub(super) fn new(view: View, area: Rect) -> Self {
        Self { view, area }
    }

    pub(super) fn area(&self) -> Rect {
        self.area
    }

    /// Place of a world point, points; none behind the eye.
    pub(super) fn place(&self, world_m: DVec3) -> Option<Pos2> {
        let p = self.view.view_from_world.transform_point3(world_m);
        let Lens::Perspective(lens) = self.view.projection else { return None };
        if p.z > -NEAREST_M {
            return None;
        }
        let x = (p.x / -p.z - lens.left) / (lens.right - lens.left);
        let y = (lens.up - p.y / -p.z) / (lens.up - lens.down);
        Some(pos2(
            self.area.left() + x as f32 * self.area.width(),
            self.area.top() + y as f32 * self.area.height(),
        ))
    }

    /// How far a world point moves in the area when it moves along a world vector, points per length of the vector.
    pub(super) fn slope(&self, world_m: DVec3, along: DVec3) -> Option<egui::Vec2> {
        const STEP: f64 = 0.01;
        let (from, to) = (self.place(world_m)?, self.place(world_m + along * STEP)?);
        Some((to - from) / STEP as f32)
    }

    /// Vectors of the view in the world: right and up, of the length that one point of the area shows at a world point.
    pub(super) fn point_axes(&self, world_m: DVec3) -> Option<[DVec3; 2]> {
        let Lens::Perspective(lens) = self.view.projection else { return None };
        let depth_m = -self.view.view_from_world.transform_point3(world_m).z;
        let metres_per_point = depth_m.max(NEAREST_M) * (lens.up - lens.down) / f64::from(self.area.height());
        let world_from_view = self.view.view_from_world.matrix3.inverse();
        Some([world_from_view.x_axis * metres_per_point, world_from_view.y_axis * metres_per_point])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::Camera;
    use egui::vec2;

    #[test]
    fn the_target_is_in_the_middle_and_slopes_are_what_points_move_by() {
        let area = Rect::from_min_size(pos2(10.0, 20.0), vec2(400.0, 300.0));
        let camera = Camera::default();
        let projection = Projection::new(camera.view([400, 300]).unwrap(), area);
        assert!((projection.place(DVec3::ZERO).unwrap() - area.center()).length() < 1e-3);
        let [right, up] = projection.point_axes(DVec3::ZERO).unwrap();
        let moved = projection.place(right * 30.0 + up * 7.0).unwrap();
        assert!((moved - (area.center() + vec2(30.0, -7.0))).length() < 1e-2, "{moved:?}");
        let slope = projection.slope(DVec3::ZERO, right).unwrap();
        assert!((slope - vec2(1.0, 0.0)).length() < 1e-2, "{slope:?}");
        let behind = camera.view([400, 300]).unwrap().view_from_world.inverse().transform_point3(DVec3::Z);
        assert_eq!(projection.place(behind), None);
    }
}
