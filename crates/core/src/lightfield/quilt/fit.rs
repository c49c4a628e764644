//! How large a thing may be to be seen whole.

use super::QuiltDisplay;
use glam::DVec3;

impl QuiltDisplay {
    /// The largest factor by which points about a centre may be scaled so that the middle camera sees all of them on the screen, if the
    /// centre is so far before the middle of the screen, metres; infinite if no factor is too large.
    ///
    /// A point (x, y, z) scaled by s is seen at s x D/(D − z₀ − s z): at the edge w for s = w (D − z₀)/(D |x| + w z).
    pub fn largest_scale(&self, points: impl IntoIterator<Item = DVec3>, before_m: f64) -> f64 {
        let distance_m = self.focal_distance_m;
        let edges_m = self.screen_size_m().map(|side| 0.5 * side);
        let scale = |from_middle: f64, toward: f64, edge_m: f64| {
            let growth = distance_m * from_middle.abs() + edge_m * toward;
            if growth > 0.0 { edge_m * (distance_m - before_m) / growth } else { f64::INFINITY }
        };
        let of_point = |p: DVec3| scale(p.x, p.z, edges_m[0]).min(scale(p.y, p.z, edges_m[1]));
        points.into_iter().map(of_point).fold(f64::INFINITY, f64::min)
    }
}
