//! How wide a pixel is at a depth.

use crate::view::{Projection, View};

/// Width of what a pixel shows at a depth: `at_eye_m + per_metre · depth`, metres.
///
/// What a light-field display resolves is [`crate::lightfield::Resolution`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// At depth 0, metres.
    pub at_eye_m: f64,
    /// Change per metre of depth.
    pub per_metre: f64,
}

impl Footprint {
    /// That of the shorter sides of a view's pixels; of a projector's picture, those on the screen.
    pub fn of(view: &View) -> Self {
        let shorter = |width: f64, height: f64| {
            let [columns, rows] = view.size.map(f64::from);
            (width.abs() / columns).min(height.abs() / rows)
        };
        match view.projection {
            Projection::Perspective(f) => {
                Self { at_eye_m: 0.0, per_metre: shorter(f.right - f.left, f.up - f.down) }
            }
            Projection::Orthographic(o) => {
                Self { at_eye_m: shorter(o.right_m - o.left_m, o.up_m - o.down_m), per_metre: 0.0 }
            }
            Projection::Mcop(m) => {
                Self { at_eye_m: shorter(m.right_m - m.left_m, m.up_m - m.down_m), per_metre: 0.0 }
            }
        }
    }

    /// The width at a depth, metres.
    pub fn width_m(&self, depth_m: f64) -> f64 {
        self.at_eye_m + self.per_metre * depth_m
    }

    /// The depth at which it has a width, metres; infinite if it has another one everywhere.
    pub fn depth_m(&self, width_m: f64) -> f64 {
        (width_m - self.at_eye_m) / self.per_metre
    }
}
