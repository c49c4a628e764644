//! Where pictures are shaded from.

use super::{Projection, View};
use glam::{DAffine3, DVec2, DVec3, DVec4};

/// Where the viewer is for shading: what a headlight shines from and highlights are reflected to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Viewpoint {
    /// A point, world space, metres.
    At(DVec3),
    /// Infinitely far away; the vector points there, in world space, and need not have unit length.
    Towards(DVec3),
}

impl Viewpoint {
    /// In homogeneous coordinates of another space, such as texture space: a point has w = 1, a direction w = 0.
    pub(super) fn homogeneous(self, target_from_world: DAffine3) -> DVec4 {
        match self {
            Self::At(point) => target_from_world.transform_point3(point).extend(1.0),
            Self::Towards(direction) => target_from_world.transform_vector3(direction).extend(0.0),
        }
    }
}

impl View {
    /// Where the picture is shaded from: [`View::shaded_from`], or else its own eye, which is infinitely far away in a
    /// parallel projection, and of a projector of a light-field display the one that sees the middle of its picture.
    pub fn viewpoint(&self) -> Viewpoint {
        self.shaded_from.unwrap_or_else(|| {
            let world_from_view = self.view_from_world.inverse();
            match self.projection {
                Projection::Perspective(_) => Viewpoint::At(world_from_view.translation),
                Projection::Orthographic(_) => {
                    Viewpoint::Towards(world_from_view.transform_vector3(DVec3::Z))
                }
                Projection::Mcop(m) => {
                    let middle_m = 0.5 * DVec2::new(m.left_m + m.right_m, m.down_m + m.up_m);
                    Viewpoint::At(world_from_view.transform_point3(m.eye_m(middle_m)))
                }
            }
        })
    }
}
