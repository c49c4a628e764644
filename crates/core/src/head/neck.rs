//! What a head turns about.

use super::Pose;
use glam::DVec3;

/// Where the middle between the eyes is as seen from the pivot in the neck, metres: a head can only turn about its neck, so
/// that eyes move when it turns (Peek et al. 2014, as in VR §6.2; neither prints lengths).
///
/// By default 0.075 m above and 0.0805 m before it: `OVR_DEFAULT_NECK_TO_EYE_VERTICAL` and `_HORIZONTAL` of the Oculus SDK
/// (`OVR_CAPI_Keys.h`), averages over women and men of the survey ANSUR-88: gonion to ectoorbitale, and tragion to
/// infraorbitale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neck {
    /// Along the head's +Y.
    pub up_m: f64,
    /// Along the head's −Z.
    pub forward_m: f64,
}

impl Default for Neck {
    fn default() -> Self {
        Self { up_m: 0.075, forward_m: 0.0805 }
    }
}

impl Neck {
    /// The pose of the middle between the eyes over a pivot.
    pub fn eyes(&self, pivot: &Pose) -> Pose {
        Pose { position_m: pivot.position_m + pivot.orientation * self.eyes_from_pivot_m(), ..*pivot }
    }

    /// The pose of the pivot under the middle between the eyes.
    pub fn pivot(&self, eyes: &Pose) -> Pose {
        Pose { position_m: eyes.position_m - eyes.orientation * self.eyes_from_pivot_m(), ..*eyes }
    }

    fn eyes_from_pivot_m(&self) -> DVec3 {
        DVec3::new(0.0, self.up_m, -self.forward_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    #[test]
    fn eyes_are_above_and_before_the_pivot() {
        let left =
            Pose { position_m: DVec3::ONE, orientation: DQuat::from_rotation_y(0.5 * std::f64::consts::PI) };
        let eyes = Neck::default().eyes(&left);
        assert!((eyes.position_m - DVec3::new(1.0 - 0.0805, 1.075, 1.0)).length() < 1e-12);
        assert!(Neck::default().pivot(&eyes).distance_to_m(&left) < 1e-12);
    }
}
