//! Where something is and how it is turned.

use crate::view::View;
use glam::{DAffine3, DQuat, DVec3};

/// Place and orientation in world space: right-handed, metres, looking along its own −Z with +Y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Where it is, world space, metres.
    pub position_m: DVec3,
    /// Turns its own axes into the world's; of unit length.
    pub orientation: DQuat,
}

impl Pose {
    /// The pose of a view's eye. A view is rigid; scale and shear are left out.
    pub fn of(view: &View) -> Self {
        let (_, orientation, position_m) = view.view_from_world.inverse().to_scale_rotation_translation();
        Self { position_m, orientation }
    }

    /// A view's picture from this pose, shaded from its own eye.
    pub fn view(&self, like: &View) -> View {
        View { view_from_world: self.world_from_own().inverse(), shaded_from: None, ..*like }
    }

    /// From its own space to the world's.
    pub fn world_from_own(&self) -> DAffine3 {
        DAffine3::from_rotation_translation(self.orientation, self.position_m)
    }

    /// The pose in the world of what has a pose in this one's own space.
    pub fn of_own(&self, own: &Self) -> Self {
        Self {
            position_m: self.position_m + self.orientation * own.position_m,
            orientation: self.orientation * own.orientation,
        }
    }

    /// Whether all coordinates are finite and the orientation has unit length.
    pub fn is_valid(&self) -> bool {
        self.position_m.is_finite() && self.orientation.is_finite() && self.orientation.is_normalized()
    }

    /// The same pose with an orientation of unit length to the last digit; `None` if it is not [valid](Self::is_valid).
    pub fn normalized(self) -> Option<Self> {
        self.is_valid().then(|| Self { orientation: self.orientation.normalize(), ..self })
    }

    /// The pose on the way to another, 0 to 1: straight on, turning evenly the shorter way. Both must be
    /// [valid](Self::is_valid).
    pub fn between(&self, other: &Self, share: f64) -> Self {
        Self {
            position_m: self.position_m.lerp(other.position_m, share),
            orientation: self.orientation.slerp(other.orientation, share).normalize(),
        }
    }

    /// Angle of the turn from this orientation to another, radians, 0 to π.
    pub fn angle_to_rad(&self, other: &Self) -> f64 {
        let between = self.orientation.inverse() * other.orientation;
        2.0 * between.xyz().length().atan2(between.w.abs())
    }

    /// Distance to another, metres.
    pub fn distance_to_m(&self, other: &Self) -> f64 {
        self.position_m.distance(other.position_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Frustum, Orbit, Projection, Rig};

    #[test]
    fn a_view_is_the_view_of_its_pose() {
        let frustum = Projection::Perspective(Frustum::from_fov(1.0, [40, 30]).unwrap());
        let orbit = Orbit { azimuth_rad: 0.7, elevation_rad: -0.4, distance_m: 2.0 };
        let view = orbit.view(frustum, [40, 30]);
        let pose = Pose::of(&view);
        assert!((pose.position_m.length() - 2.0).abs() < 1e-12);
        assert!((pose.orientation * DVec3::NEG_Z + pose.position_m / 2.0).length() < 1e-12);
        assert!(pose.view(&view).view_from_world.abs_diff_eq(view.view_from_world, 1e-12));
        let [left, _] =
            Rig::Stereo { eye_distance_m: 0.06, convergence_m: 1.0 }.views(&view).try_into().unwrap();
        assert!((Pose::of(&left).distance_to_m(&pose) - 0.03).abs() < 1e-12);
        assert_eq!(pose.view(&left).shaded_from, None);
    }

    #[test]
    fn angles_are_those_of_the_shorter_way() {
        let at = |angle_rad| Pose { position_m: DVec3::ZERO, orientation: DQuat::from_rotation_y(angle_rad) };
        for [a, b, between] in [[0.0, 1e-9, 1e-9], [1.0, -1.0, 2.0], [3.0, -3.0, std::f64::consts::TAU - 6.0]]
        {
            assert!((at(a).angle_to_rad(&at(b)) - between).abs() < 1e-12, "{a} {b}");
        }
    }

    #[test]
    fn what_goes_along_with_a_pose_is_where_its_space_puts_it() {
        let hand = Pose {
            position_m: DVec3::new(0.2, 1.1, -0.4),
            orientation: DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(-0.3),
        };
        let own =
            Pose { position_m: DVec3::new(0.0, 0.08, -0.06), orientation: DQuat::from_rotation_x(-0.8) };
        let held = hand.of_own(&own).world_from_own();
        let through_both = hand.world_from_own() * own.world_from_own();
        assert!(held.abs_diff_eq(through_both, 1e-12), "{held} {through_both}");
    }

    #[test]
    fn poses_that_are_none_are_told() {
        let valid = Pose { position_m: DVec3::ZERO, orientation: DQuat::IDENTITY };
        assert!(valid.is_valid());
        assert!(!Pose { position_m: DVec3::NAN, ..valid }.is_valid());
        assert!(!Pose { orientation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..valid }.is_valid());
    }
}
