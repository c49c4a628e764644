//! What part of the volume is shown.

use super::within;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use wheatstone_core::scene::{Clip as SceneClip, ClipPlane};

/// A box, and a plane that may cut it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Clip {
    /// Low corner, texture space.
    pub(crate) box_lo: DVec3,
    /// High corner, texture space.
    pub(crate) box_hi: DVec3,
    pub(crate) plane: Option<Plane>,
    /// Whether the picture shows the handles of box and plane.
    pub(crate) has_handles: bool,
}

/// World points with `normal · p ≥ offset_m` stay.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plane {
    /// Unit vector towards what stays, world space.
    pub(crate) normal: DVec3,
    /// From the world's origin, metres.
    pub(crate) offset_m: f64,
}

impl Default for Plane {
    /// Through the middle; cuts the side away that faces the first view.
    fn default() -> Self {
        Self { normal: DVec3::new(-0.5, 0.0, -0.75_f64.sqrt()), offset_m: 0.0 }
    }
}

impl Default for Clip {
    /// Everything is shown.
    fn default() -> Self {
        Self { box_lo: DVec3::ZERO, box_hi: DVec3::ONE, plane: None, has_handles: false }
    }
}

impl Clip {
    /// Moves one face of the box (0–2: low x, y, z; 3–5: high) as far as the volume and the opposite face allow.
    pub(super) fn move_face(&mut self, face: usize, to: f64) -> Result<(), String> {
        if face >= 6 {
            return Err(format!("face is {face}: must be from 0 to 5"));
        }
        let mut clip = self.scene();
        clip.move_face(face, to);
        (self.box_lo, self.box_hi) = (clip.box_lo, clip.box_hi);
        Ok(())
    }

    /// What the casters take.
    pub(crate) fn scene(&self) -> SceneClip {
        SceneClip {
            box_lo: self.box_lo,
            box_hi: self.box_hi,
            plane: self.plane.map(|plane| ClipPlane { normal: plane.normal, offset_m: plane.offset_m }),
        }
    }

    pub(super) fn check(&self) -> Result<(), String> {
        for axis in 0..3 {
            within("box_lo", self.box_lo[axis], 0.0, 1.0)?;
            within("box_hi", self.box_hi[axis], 0.0, 1.0)?;
            if self.box_lo[axis] >= self.box_hi[axis] {
                return Err("box_lo must be below box_hi".to_owned());
            }
        }
        if let Some(plane) = self.plane {
            within("length of the plane's normal", plane.normal.length(), 1e-6, 1e6)?;
            within("offset_m", plane.offset_m, -1000.0, 1000.0)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_stop_at_each_other_and_at_the_volume() {
        let mut clip = Clip::default();
        clip.move_face(4, 0.3).unwrap();
        assert_eq!(clip.box_hi, DVec3::new(1.0, 0.3, 1.0));
        clip.move_face(1, 0.9).unwrap();
        assert_eq!(clip.box_lo.y, 0.3 - SceneClip::THINNEST);
        clip.move_face(1, -5.0).unwrap();
        clip.move_face(4, 7.0).unwrap();
        assert_eq!(clip, Clip::default());
        assert!(clip.check().is_ok());
    }

    #[test]
    fn a_face_pushed_into_the_last_slice_stops_there() {
        let mut clip = Clip::default();
        clip.move_face(3, -1.0).unwrap();
        clip.move_face(0, 1.0).unwrap();
        assert!(clip.check().is_ok(), "{clip:?}");
    }
}
