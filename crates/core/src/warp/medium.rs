//! Homogeneous media: Beer–Lambert.

use crate::cast::SATURATED_ALPHA;
use glam::{DVec3, DVec4};

/// What a stretch of a ray passes through, as if it were the same all along.
///
/// The pair of VR Alg. 6 as printed is not its own inverse; here κ = −ln(1 − A) / d and c = C / A, and back A = 1 − e^(−κd) and
/// C = c·A.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Medium {
    /// Colour c that it emits where it absorbs, display-referred.
    pub rgb: [f32; 3],
    /// Absorption κ, 1/m.
    pub absorption_per_m: f32,
}

impl Medium {
    /// The medium that gives a length, metres, a premultiplied colour; clear if length or opacity are not above 0. Opacities
    /// are taken to be [`SATURATED_ALPHA`] at most.
    pub fn from_color(color: DVec4, length_m: f64) -> Self {
        if !(color.w > 0.0 && length_m > 0.0) {
            return Self::default();
        }
        Self {
            rgb: (color.truncate() / color.w).as_vec3().to_array(),
            absorption_per_m: (optical_depth(color.w) / length_m) as f32,
        }
    }

    /// The premultiplied colour of a length, metres.
    pub fn color(&self, length_m: f64) -> DVec4 {
        let alpha = opacity(f64::from(self.absorption_per_m) * length_m);
        (DVec3::from(self.rgb.map(f64::from)) * alpha).extend(alpha)
    }
}

/// κ·d of an opacity, of [`SATURATED_ALPHA`] at most.
pub(super) fn optical_depth(opacity: f64) -> f64 {
    -(-opacity.min(f64::from(SATURATED_ALPHA))).ln_1p()
}

/// The opacity of κ·d.
pub(super) fn opacity(optical_depth: f64) -> f64 {
    -(-optical_depth).exp_m1()
}
