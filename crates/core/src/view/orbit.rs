//! An eye that circles the world's origin.

use super::{Projection, View};
use glam::{DAffine3, DMat3, DVec3};

/// Where on its sphere an orbiting eye is. Azimuth 0 and elevation 0 look along −Z from +Z; azimuth turns the
/// eye about +Y towards +X, elevation lifts it towards +Y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Orbit {
    /// Turn about the vertical axis, radians.
    pub azimuth_rad: f64,
    /// Height above the horizon, radians.
    pub elevation_rad: f64,
    /// Distance of the eye from the origin, metres.
    pub distance_m: f64,
}

impl Default for Orbit {
    /// The DM test camera: at √3 m.
    fn default() -> Self {
        Self { azimuth_rad: 0.0, elevation_rad: 0.0, distance_m: 3.0_f64.sqrt() }
    }
}

impl Orbit {
    /// The view of an eye on the orbit, looking at the origin.
    pub fn view(&self, projection: Projection, size: [u32; 2]) -> View {
        View { view_from_world: self.view_from_world(), projection, size, shaded_from: None }
    }

    /// World to view space of that eye.
    pub fn view_from_world(&self) -> DAffine3 {
        let world_from_view = DAffine3::from_mat3(
            DMat3::from_rotation_y(self.azimuth_rad) * DMat3::from_rotation_x(-self.elevation_rad),
        ) * DAffine3::from_translation(DVec3::Z * self.distance_m);
        world_from_view.inverse()
    }
}
