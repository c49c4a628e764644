//! How large a thing may be to be seen whole.

use super::{ProjectorArray, QuiltDisplay};
use glam::{DVec2, DVec3};

/// The largest factor by which points about a centre may be scaled so that an eye in display space, metres, sees all of them on a
/// screen, if the centre is so far before the middle of the screen, metres; infinite if no factor is too large, 0 if not even the centre
/// is seen.
///
/// To the right, with the eye at e, D away: a point s p is seen at e + (s p − e) D/(D − z₀ − s z), which is within the edge w for
/// s (D p + (w − e) z) ≤ w (D − z₀) + e z₀; and so on for the other edges.
fn largest_scale(
    eye_m: DVec3,
    screen_size_m: [f64; 2],
    points: impl IntoIterator<Item = DVec3>,
    before_m: f64,
) -> f64 {
    let edges_m = 0.5 * DVec2::from(screen_size_m);
    let rest_m = eye_m.z - before_m;
    let scale = |edge_m: f64, eye_to_m: f64, to: f64, toward: f64| {
        let room = (edge_m * rest_m + eye_to_m * before_m).max(0.0);
        let growth = eye_m.z * to + (edge_m - eye_to_m) * toward;
        if growth > 0.0 { room / growth } else { f64::INFINITY }
    };
    let of_point = |p: DVec3| {
        let axes = [(edges_m.x, eye_m.x, p.x), (edges_m.y, eye_m.y, p.y)];
        let sides = axes.into_iter().flat_map(|(edge_m, eye_to_m, to)| {
            [scale(edge_m, eye_to_m, to, p.z), scale(edge_m, -eye_to_m, -to, p.z)]
        });
        sides.fold(f64::INFINITY, f64::min)
    };
    points.into_iter().map(of_point).fold(f64::INFINITY, f64::min)
}

impl QuiltDisplay {
    /// The largest factor by which points about a centre may be scaled so that the middle camera sees all of them on the screen, if the
    /// centre is so far before the middle of the screen, metres; infinite if no factor is too large.
    pub fn largest_scale(&self, points: impl IntoIterator<Item = DVec3>, before_m: f64) -> f64 {
        largest_scale(DVec3::Z * self.focal_distance_m, self.screen_size_m(), points, before_m)
    }
}

impl ProjectorArray {
    /// The same for the virtual viewer before the middle of the screen.
    pub fn largest_scale(&self, points: impl IntoIterator<Item = DVec3>, before_m: f64) -> f64 {
        largest_scale(self.virtual_viewer_m(), self.description().screen_size_m, points, before_m)
    }

    /// Where the virtual viewer is, before the middle of the screen: display space, metres.
    pub fn virtual_viewer_m(&self) -> DVec3 {
        let viewer = self.description().viewer;
        DVec3::new(0.0, viewer.height_m, viewer.distance_m)
    }
}
