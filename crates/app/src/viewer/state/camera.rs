//! Where the eye is: on a sphere about a point that it looks at.

use super::within;
use glam::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use wheatstone_core::view::{Frustum, FrustumError, Orbit, Projection, View};

/// Nearest and furthest that the eye comes to what it looks at, metres.
const DISTANCES_M: [f64; 2] = [0.01, 100.0];

/// Furthest that the point looked at lies from the volume's centre, metres.
const MOST_TARGET_M: f64 = 1000.0;

/// The eye in the middle between both eyes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Camera {
    /// What it looks at, world space, metres.
    pub(crate) target_m: DVec3,
    /// Turn about the vertical axis, degrees.
    pub(crate) azimuth_deg: f64,
    /// Height above the horizon, degrees.
    pub(crate) elevation_deg: f64,
    /// From what it looks at, metres.
    pub(crate) distance_m: f64,
    /// Field of view of the picture's shorter side, degrees.
    #[serde(alias = "fov_y_deg")]
    pub(crate) fov_deg: f64,
}

/// A side of the volume to look at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Face {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
}

impl Face {
    pub(crate) const ALL: [Self; 6] =
        [Self::Front, Self::Back, Self::Left, Self::Right, Self::Top, Self::Bottom];

    /// Azimuth and elevation of an eye in front of it, degrees.
    fn direction_deg(self) -> [f64; 2] {
        match self {
            Self::Front => [0.0, 0.0],
            Self::Back => [180.0, 0.0],
            Self::Left => [-90.0, 0.0],
            Self::Right => [90.0, 0.0],
            Self::Top => [0.0, 90.0],
            Self::Bottom => [0.0, -90.0],
        }
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
        }
    }
}

impl Default for Camera {
    /// All of a box with sides of 1 m, which no volume exceeds, from a little to the right and above.
    fn default() -> Self {
        Self { target_m: DVec3::ZERO, azimuth_deg: 30.0, elevation_deg: 15.0, distance_m: 2.4, fov_deg: 40.0 }
    }
}

impl Camera {
    /// Circles what it looks at.
    pub(super) fn orbit(&mut self, right_deg: f64, up_deg: f64) {
        self.azimuth_deg = wrapped(self.azimuth_deg + right_deg);
        self.elevation_deg = (self.elevation_deg + up_deg).clamp(-90.0, 90.0);
    }

    /// The same, turned to the right about what it looks at.
    pub(crate) fn orbited(mut self, right_deg: f64) -> Self {
        self.orbit(right_deg, 0.0);
        self
    }

    /// Moves sideways by parts of what the picture's shorter side shows at the target.
    pub(super) fn pan(&mut self, right: f64, up: f64) {
        self.move_target(DVec3::new(right, up, 0.0) * self.shown_m());
    }

    /// Comes so many times as near.
    pub(super) fn zoom(&mut self, factor: f64) {
        self.distance_m = (self.distance_m / factor).clamp(DISTANCES_M[0], DISTANCES_M[1]);
    }

    /// Moves eye and target along the view's axes, metres.
    pub(super) fn fly(&mut self, right_m: f64, up_m: f64, forward_m: f64) {
        self.move_target(DVec3::new(right_m, up_m, -forward_m));
    }

    /// Turns about itself.
    pub(super) fn turn(&mut self, right_deg: f64, up_deg: f64) {
        let eye_m = self.eye_m();
        self.orbit(-right_deg, -up_deg);
        self.target_m += eye_m - self.eye_m();
    }

    /// Looks at a side of the volume.
    pub(super) fn face(&mut self, face: Face) {
        [self.azimuth_deg, self.elevation_deg] = face.direction_deg();
        self.target_m = DVec3::ZERO;
    }

    /// What the picture's shorter side shows at the target, metres.
    pub(super) fn shown_m(&self) -> f64 {
        2.0 * self.distance_m * (0.5 * self.fov_deg.to_radians()).tan()
    }

    /// The view of a picture of some size, pixels.
    pub(crate) fn view(&self, size: [u32; 2]) -> Result<View, FrustumError> {
        let frustum = Frustum::from_fov(self.fov_deg.to_radians(), size)?;
        let orbit = Orbit {
            azimuth_rad: self.azimuth_deg.to_radians(),
            elevation_rad: self.elevation_deg.to_radians(),
            distance_m: self.distance_m,
        };
        let about_origin = orbit.view(Projection::Perspective(frustum), size);
        let view_from_world = about_origin.view_from_world * DAffine3::from_translation(-self.target_m);
        Ok(View { view_from_world, ..about_origin })
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let furthest_m = self.target_m.abs().max_element();
        if !self.target_m.is_finite() {
            return Err("target_m must be finite".to_owned());
        }
        within("target_m", furthest_m, 0.0, MOST_TARGET_M)?;
        within("azimuth_deg", self.azimuth_deg, -360.0, 360.0)?;
        within("elevation_deg", self.elevation_deg, -90.0, 90.0)?;
        within("distance_m", self.distance_m, DISTANCES_M[0], DISTANCES_M[1])?;
        within("fov_deg", self.fov_deg, 1.0, 170.0)
    }

    fn move_target(&mut self, by_in_view: DVec3) {
        self.target_m += self.world_from_view() * by_in_view;
    }

    fn eye_m(&self) -> DVec3 {
        self.target_m + self.world_from_view() * DVec3::Z * self.distance_m
    }

    fn world_from_view(&self) -> DMat3 {
        let elevation_rad = self.elevation_deg.to_radians().clamp(-FRAC_PI_2, FRAC_PI_2);
        DMat3::from_rotation_y(self.azimuth_deg.to_radians()) * DMat3::from_rotation_x(-elevation_rad)
    }
}

/// The same angle within half a turn to either side.
fn wrapped(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::{Arrangement, Stereo};

    fn eye_of(camera: &Camera) -> DVec3 {
        camera.view([10, 10]).unwrap().view_from_world.inverse().translation
    }

    #[test]
    fn an_orbit_keeps_distance_and_target() {
        let mut camera = Camera { azimuth_deg: 0.0, elevation_deg: 0.0, ..Camera::default() };
        camera.orbit(90.0, 0.0);
        assert!((eye_of(&camera) - DVec3::X * camera.distance_m).length() < 1e-12);
        camera.orbit(0.0, 500.0);
        assert_eq!(camera.elevation_deg, 90.0);
        assert!((eye_of(&camera) - DVec3::Y * camera.distance_m).length() < 1e-12);
        camera.orbit(1000.0, 0.0);
        assert!(camera.check().is_ok());
    }

    #[test]
    fn a_pan_by_the_pictures_shorter_side_moves_the_target_from_edge_to_edge() {
        let mut camera = Camera::default();
        let before = camera;
        camera.pan(0.0, 1.0);
        let view = before.view([100, 100]).unwrap();
        let target = view.view_from_world.transform_point3(camera.target_m);
        let half = (0.5 * before.fov_deg.to_radians()).tan();
        assert!((target.y / -target.z - 2.0 * half).abs() < 1e-12 && target.x.abs() < 1e-12);
    }

    #[test]
    fn a_turn_keeps_the_eye_and_a_flight_keeps_the_direction() {
        let mut camera = Camera::default();
        let eye_m = eye_of(&camera);
        camera.turn(20.0, 5.0);
        assert!((eye_of(&camera) - eye_m).length() < 1e-12);
        let towards = (camera.target_m - eye_m).normalize_or_zero();
        camera.fly(0.0, 0.0, 0.5);
        assert!((eye_of(&camera) - (eye_m + 0.5 * towards)).length() < 1e-12);
    }

    #[test]
    fn a_turn_to_the_right_brings_what_was_right_to_the_middle() {
        let mut camera = Camera::default();
        let right_m = eye_of(&camera) + camera.world_from_view() * DVec3::new(0.1, 0.0, -1.0);
        camera.turn(0.1_f64.atan().to_degrees(), 0.0);
        let seen = camera.view([10, 10]).unwrap().view_from_world.transform_point3(right_m);
        assert!((seen.x / -seen.z).abs() < 0.01, "{seen}");
    }

    #[test]
    fn the_first_view_shows_all_of_a_box_in_pictures_of_any_shape_and_to_both_eyes() {
        let corners = [-0.5, 0.5].into_iter().flat_map(|x| {
            [-0.5, 0.5].into_iter().flat_map(move |y| [-0.5, 0.5].map(|z| DVec3::new(x, y, z)))
        });
        let camera = Camera::default();
        for size in [[970, 720], [485, 720], [100, 800], [800, 100], [64, 64]] {
            for arrangement in [Arrangement::Mono, Arrangement::SideBySide, Arrangement::Anaglyph] {
                let stereo = Stereo { arrangement, ..Stereo::default() };
                let eye_size = stereo.eye_size(size);
                for view in stereo.views(&camera.view(eye_size).unwrap(), camera.distance_m) {
                    for corner in corners.clone() {
                        let at = view.pixel_position(corner).unwrap();
                        let [width, height] = eye_size.map(f64::from);
                        let is_inside = (0.0..width).contains(&at.x) && (0.0..height).contains(&at.y);
                        assert!(is_inside, "{size:?} {arrangement:?} {corner}: {at}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_zoom_ends_before_the_target() {
        let mut camera = Camera::default();
        camera.zoom(1e12);
        assert_eq!(camera.distance_m, DISTANCES_M[0]);
        camera.zoom(0.0);
        assert_eq!(camera.distance_m, DISTANCES_M[1]);
    }
}
