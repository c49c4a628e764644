//! The test signal of Marschner and Lobb, "An evaluation of reconstruction filters for volume rendering", 1994.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

const FREQUENCY: f64 = 6.0;
const ALPHA: f64 = 0.25;

/// The signal over [−1, 1]³, within 0 and 1.
pub(super) fn value(point: DVec3) -> f64 {
    let p = 2.0 * point - 1.0;
    let ripple = (TAU * FREQUENCY * (FRAC_PI_2 * p.x.hypot(p.y)).cos()).cos();
    (1.0 - (FRAC_PI_2 * p.z).sin() + ALPHA * (1.0 + ripple)) / (2.0 * (1.0 + ALPHA))
}
