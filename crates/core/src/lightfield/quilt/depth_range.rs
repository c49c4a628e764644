//! How far before and behind the screen things may be before neighbouring views no longer fuse.

use super::{QuiltDisplay, Sampling};

/// Distances from a screen between which things are seen without ghosts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthRange {
    /// In front of the screen, metres.
    pub before_m: f64,
    /// Behind it, metres; may be infinite.
    pub behind_m: f64,
}

impl QuiltDisplay {
    /// Where things move by at most so many pixels of a tile from view to view.
    ///
    /// From a camera to the next one, b to the right, a point at z in front of the screen moves on it by b z/(D − z), D being the focal
    /// distance. With p pixels of W/w metres, δ = p W/w, that is within ±δ from z = δD/(b + δ) before the screen to δD/(b − δ) behind
    /// it. Cameras are furthest apart at the ends of the cone, where angles are equal but distances are not.
    pub fn depth_range(&self, sampling: Sampling, most_px: f64) -> DepthRange {
        let count = self.view_count();
        let x_m = |index| self.camera_x_m(sampling.share(index, count));
        let apart_m = if count < 2 { 0.0 } else { x_m(1) - x_m(0) };
        let moves_m = most_px * self.screen_size_m()[0] / f64::from(self.tile_size_px()[0]);
        let far_m = moves_m * self.focal_distance_m;
        let behind_m = if apart_m > moves_m { far_m / (apart_m - moves_m) } else { f64::INFINITY };
        DepthRange { before_m: far_m / (apart_m + moves_m), behind_m }
    }

    /// How far a point moves from view to view at most, pixels of a tile: at a distance in front of the screen, metres, negative behind.
    pub fn disparity_px(&self, sampling: Sampling, before_m: f64) -> f64 {
        let count = self.view_count();
        let x_m = |index| self.camera_x_m(sampling.share(index, count));
        let apart_m = if count < 2 { 0.0 } else { x_m(1) - x_m(0) };
        let px_per_m = f64::from(self.tile_size_px()[0]) / self.screen_size_m()[0];
        apart_m * before_m / (self.focal_distance_m - before_m) * px_per_m
    }
}
