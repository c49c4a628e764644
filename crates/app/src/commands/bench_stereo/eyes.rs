//! The papers' eyes: where they are and what they see.

use crate::failure::Failure;
use crate::spec;
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::{Frustum, Orbit, Projection, Rig, View};

const EYE_DISTANCE_M: f64 = 0.065;
const FOV_DEG: f64 = 110.0;

/// Two parallel eyes with pictures of a size in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Eyes {
    pub(super) size: [u32; 2],
}

impl Eyes {
    /// Views of the left and the right eye at a distance from the sphere around a cube of 1 m, turned about the vertical axis.
    pub(super) fn views(&self, distance_m: f64, azimuth_rad: f64) -> Result<[View; 2], Failure> {
        let frustum = Frustum::from_fov(FOV_DEG.to_radians(), self.size).map_err(Failure::input)?;
        let orbit = Orbit { azimuth_rad, elevation_rad: 0.0, distance_m: distance_m + radius_m() };
        let middle = orbit.view(Projection::Perspective(frustum), self.size);
        let eyes = Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY };
        let views = <[View; 2]>::try_from(eyes.views(&middle));
        views.map_err(|views| Failure::Internal(anyhow::anyhow!("{} views of two eyes", views.len())))
    }

    /// Distance from the sphere at which its picture takes so many layers (SP Eq. 9, VR Eq. 22), metres.
    pub(super) fn nearest_distance_m(&self, layers: u32) -> Result<f64, Failure> {
        let [left, right] = self.views(1.0, 0.0)?;
        let epipolar = Epipolar::new(&left, &right).map_err(Failure::input)?;
        Ok(epipolar.nearest_distance_m(radius_m(), f64::from(layers)))
    }
}

/// Radius of the sphere around a cube of 1 m.
fn radius_m() -> f64 {
    0.5 * 3.0_f64.sqrt()
}

/// How far the eyes are from that sphere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Distance {
    /// Where it takes a number of layers.
    Near,
    /// Metres.
    Metres(f64),
}

impl Distance {
    pub(super) fn metres(self, eyes: &Eyes, layers: u32) -> Result<f64, Failure> {
        match self {
            Self::Near => eyes.nearest_distance_m(layers),
            Self::Metres(metres) => Ok(metres),
        }
    }
}

/// `near`, or metres from 0 to 1000.
pub(super) fn distance(text: &str) -> Result<Distance, String> {
    if text == "near" {
        return Ok(Distance::Near);
    }
    let metres = spec::within(0.0..=1000.0)(text);
    metres.map(Distance::Metres).map_err(|error| format!("must be near or metres: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_is_the_papers() {
        let eyes = Eyes { size: [768; 2] };
        let near_m = distance("near").unwrap().metres(&eyes, 32).unwrap();
        assert!((near_m - 0.435).abs() < 2e-3, "{near_m}");
        assert_eq!(distance("1.2"), Ok(Distance::Metres(1.2)));
        assert!(distance("-1").is_err() && distance("far").is_err());
    }
}
