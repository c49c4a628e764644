//! A stag beetle: a hollow body under wing cases, jaws, feelers and six jointed legs.
//!
//! The head looks along +y, the back is up (+z).

use super::shape::{ellipsoid_distance, filled, limb_distance, sheet};
use glam::DVec3;

/// The wing cases and what is under them are soft, with gradients below 0.1 per voxel at 256³; the rest is dense.
const SOFT: f64 = 0.36;
const SOFT_HALF_WIDTH: f64 = 0.0210;
const HARD: f64 = 0.80;
const HARD_HALF_WIDTH: f64 = 0.0135;

/// From joint to joint on the right side: (x, y, z) and radius.
type Joint = (DVec3, f64);
const fn joint(x: f64, y: f64, z: f64, radius: f64) -> Joint {
    (DVec3::new(x, y, z), radius)
}

const LIMBS: [&[Joint]; 6] = [
    &[
        joint(0.08, 0.17, -0.05, 0.022),
        joint(0.24, 0.26, 0.00, 0.018),
        joint(0.33, 0.34, -0.14, 0.012),
        joint(0.38, 0.42, -0.17, 0.006),
    ],
    &[
        joint(0.11, 0.05, -0.06, 0.022),
        joint(0.30, 0.05, 0.01, 0.018),
        joint(0.40, 0.02, -0.15, 0.012),
        joint(0.46, -0.03, -0.18, 0.006),
    ],
    &[
        joint(0.11, -0.10, -0.06, 0.024),
        joint(0.28, -0.18, 0.00, 0.020),
        joint(0.36, -0.32, -0.15, 0.012),
        joint(0.40, -0.43, -0.18, 0.006),
    ],
    &[
        joint(0.05, 0.30, 0.00, 0.024),
        joint(0.13, 0.38, 0.02, 0.020),
        joint(0.12, 0.44, 0.03, 0.015),
        joint(0.06, 0.48, 0.04, 0.005),
    ],
    &[joint(0.13, 0.40, 0.02, 0.012), joint(0.07, 0.41, 0.03, 0.005)],
    &[joint(0.07, 0.31, 0.03, 0.007), joint(0.20, 0.35, 0.07, 0.006), joint(0.26, 0.43, 0.06, 0.011)],
];

pub(super) fn value(point: DVec3) -> f64 {
    let centred = point - DVec3::new(0.5, 0.49, 0.5);
    let p = DVec3::new(centred.x.abs(), centred.y, centred.z);
    if p.z.abs() > 0.22 {
        return 0.0;
    }
    body(p).max(limbs(p))
}

fn body(p: DVec3) -> f64 {
    let shell = |centre_y: f64, radii: DVec3| ellipsoid_distance(p - DVec3::Y * centre_y, radii);
    let abdomen = shell(-0.14, DVec3::new(0.185, 0.27, 0.14));
    let wing_gap = if p.z > 0.0 { 1.0 - filled(p.x - 0.006, 0.006) } else { 1.0 };
    let wing_cases = SOFT * sheet(abdomen, SOFT_HALF_WIDTH) * wing_gap;
    let belly = SOFT * sheet(shell(-0.13, DVec3::new(0.145, 0.22, 0.095)), SOFT_HALF_WIDTH);
    let thorax = HARD * sheet(shell(0.17, DVec3::new(0.15, 0.085, 0.10)), HARD_HALF_WIDTH);
    let head = HARD * sheet(shell(0.275, DVec3::new(0.105, 0.055, 0.06)), HARD_HALF_WIDTH);
    let eye = 0.9 * filled((p - DVec3::new(0.095, 0.29, 0.02)).length() - 0.016, 0.008);
    wing_cases.max(belly).max(thorax).max(head).max(eye)
}

/// Hollow limbs: dense walls around empty bores.
fn limbs(p: DVec3) -> f64 {
    let mut distance = f64::INFINITY;
    for limb in LIMBS {
        for ends in limb.windows(2) {
            let ((a, radius_a), (b, radius_b)) = (ends[0], ends[1]);
            distance = distance.min(limb_distance(p, a, b, radius_a, radius_b));
        }
    }
    HARD * sheet(distance, HARD_HALF_WIDTH)
}
