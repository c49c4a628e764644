//! Pictures between their pixels.

use crate::image::RgbImage;
use glam::DVec2;

impl RgbImage {
    /// The colour at a position in pixels from the top left, interpolated between the middles of pixels; nothing beyond the edges.
    pub fn sample(&self, at: DVec2) -> Option<[f32; 3]> {
        let size = DVec2::new(f64::from(self.width), f64::from(self.height));
        if !(at.cmpge(DVec2::ZERO).all() && at.cmple(size).all() && size.min_element() > 0.0) {
            return None;
        }
        let from_middle = (at - 0.5).clamp(DVec2::ZERO, size - 1.0);
        let lower = from_middle.floor();
        let part = (from_middle - lower).as_vec2();
        let column = |x: f64| x.min(size.x - 1.0) as usize;
        let row = |y: f64| y.min(size.y - 1.0) as usize * self.width as usize;
        let at = |x: f64, y: f64| self.rgb[row(y) + column(x)];
        let mix = |a: [f32; 3], b: [f32; 3], t: f32| [0, 1, 2].map(|c| a[c] + (b[c] - a[c]) * t);
        let above = mix(at(lower.x, lower.y), at(lower.x + 1.0, lower.y), part.x);
        let below = mix(at(lower.x, lower.y + 1.0), at(lower.x + 1.0, lower.y + 1.0), part.x);
        Some(mix(above, below, part.y))
    }
}
