//! A linear ramp.

use glam::DVec3;

pub(super) fn value(point: DVec3) -> f64 {
    point.x
}
