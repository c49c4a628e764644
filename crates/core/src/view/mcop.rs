//! Multiple centres of projection: the picture of a projector behind a screen that scatters light vertically.

use glam::{DVec2, DVec3};

/// What a projector of a light-field display with horizontal parallax shows (LF §4): horizontally all rays go through its emitter
/// behind the screen, vertically through a virtual viewer in front of it.
///
/// View space is the display's: the screen is the plane z = 0 around the origin, +X right, +Y up, +Z towards the viewers, metres.
/// Depth along −Z is 0 on the screen and negative in front of it. Of a projector that is seen in a side mirror `left_m` is greater
/// than `right_m`: its picture is reversed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mcop {
    /// x of the emitter, metres.
    pub emitter_x_m: f64,
    /// z of the emitter, metres; negative.
    pub emitter_z_m: f64,
    /// Height of the virtual viewer above the middle of the screen, metres.
    pub viewer_y_m: f64,
    /// Distance of the virtual viewer from the screen, metres.
    pub viewer_z_m: f64,
    /// x on the screen at the left edge of the picture, metres.
    pub left_m: f64,
    /// x on the screen at the right edge of the picture, metres.
    pub right_m: f64,
    /// y on the screen at the bottom edge of the picture, metres.
    pub down_m: f64,
    /// y on the screen at the top edge of the picture, metres.
    pub up_m: f64,
    /// Nearest visible depth along −Z, metres; not below −`viewer_z_m`, where rays meet.
    pub near_m: f64,
    /// Furthest visible depth along −Z, metres; not above −`emitter_z_m`, where rays meet.
    pub far_m: f64,
}

impl Mcop {
    /// Where on the screen a point is shown (LF Eq. 1); nowhere if it is not between the emitter's and the viewer's planes.
    pub fn screen_m(&self, point: DVec3) -> Option<DVec2> {
        let (behind_m, before_m) = (point.z - self.emitter_z_m, self.viewer_z_m - point.z);
        if behind_m < f64::MIN_POSITIVE || before_m < f64::MIN_POSITIVE {
            return None;
        }
        let x_m = self.emitter_x_m + self.emitter_z_m * (self.emitter_x_m - point.x) / behind_m;
        let y_m = self.viewer_y_m - self.viewer_z_m * (self.viewer_y_m - point.y) / before_m;
        Some(DVec2::new(x_m, y_m))
    }

    /// From a place on the screen along its ray, per metre of depth (LF Eq. 4).
    pub fn direction(&self, screen_m: DVec2) -> DVec3 {
        DVec3::new(
            (screen_m.x - self.emitter_x_m) / self.emitter_z_m,
            (screen_m.y - self.viewer_y_m) / self.viewer_z_m,
            -1.0,
        )
    }

    /// Where the eye is that sees a place on the screen lit by the projector, at the distance and height of the virtual viewer.
    pub fn eye_m(&self, screen_m: DVec2) -> DVec3 {
        screen_m.extend(0.0) - self.viewer_z_m * self.direction(screen_m)
    }
}
