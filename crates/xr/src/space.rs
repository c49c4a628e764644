//! The space that stands for the world, and poses in it.

use crate::error::{Called, XrError};
use glam::{DQuat, DVec3};
use openxr as xr;
use wheatstone_core::head::Pose;

/// What height 0 of the world is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Floor {
    /// The floor of the room that was set up; the origin stays where it is in the room.
    Stage,
    /// The floor; the origin is where the person was when the space was last recentred.
    Local,
    /// Not known: height 0 is that of the eyes when the space was last recentred.
    Unknown,
}

impl Floor {
    /// The reference spaces, the most wanted first.
    const PREFERRED: [(xr::ReferenceSpaceType, Self); 3] = [
        (xr::ReferenceSpaceType::STAGE, Self::Stage),
        (xr::ReferenceSpaceType::LOCAL_FLOOR, Self::Local),
        (xr::ReferenceSpaceType::LOCAL, Self::Unknown),
    ];

    fn best(offered: &[xr::ReferenceSpaceType]) -> (xr::ReferenceSpaceType, Self) {
        let [.., always] = Self::PREFERRED;
        Self::PREFERRED.into_iter().find(|(kind, _)| offered.contains(kind)).unwrap_or(always)
    }
}

/// The reference space that stands for the world.
pub(crate) struct World {
    pub(crate) space: xr::Space,
    pub(crate) kind: xr::ReferenceSpaceType,
    pub(crate) floor: Floor,
}

impl World {
    pub(crate) fn new(session: &xr::Session<xr::Vulkan>) -> Result<Self, XrError> {
        let offered = session.enumerate_reference_spaces().called("xrEnumerateReferenceSpaces")?;
        let (kind, floor) = Floor::best(&offered);
        let space =
            session.create_reference_space(kind, xr::Posef::IDENTITY).called("xrCreateReferenceSpace")?;
        Ok(Self { space, kind, floor })
    }

    /// Where another space is at a time; none while that is not known.
    pub(crate) fn locate(&self, other: &xr::Space, time: xr::Time) -> Result<Option<Pose>, XrError> {
        let location = other.locate(&self.space, time).called("xrLocateSpace")?;
        Ok(known(location.location_flags, location.pose))
    }
}

/// A pose whose place and orientation are both known.
pub(crate) fn known(flags: xr::SpaceLocationFlags, pose: xr::Posef) -> Option<Pose> {
    let valid = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
    if flags.contains(valid) { pose_from_xr(pose) } else { None }
}

/// A pose with an orientation of unit length; none of coordinates that are not finite, or of a quaternion without length.
pub(crate) fn pose_from_xr(pose: xr::Posef) -> Option<Pose> {
    let (p, q) = (pose.position, pose.orientation);
    let position_m = DVec3::new(p.x.into(), p.y.into(), p.z.into());
    let orientation = DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into());
    // The specification lets lengths be off by 1 %.
    let pose = Pose { position_m, orientation: orientation.normalize() };
    (orientation.length() > 0.5 && pose.is_valid()).then_some(pose)
}

/// The same pose as the runtime takes it.
pub(crate) fn pose_to_xr(pose: &Pose) -> xr::Posef {
    let (p, q) = (pose.position_m.as_vec3(), pose.orientation.as_quat());
    xr::Posef {
        position: xr::Vector3f { x: p.x, y: p.y, z: p.z },
        orientation: xr::Quaternionf { x: q.x, y: q.y, z: q.z, w: q.w },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stage_is_wanted_most_and_the_local_space_is_always_there() {
        use xr::ReferenceSpaceType as R;
        assert_eq!(Floor::best(&[R::VIEW, R::LOCAL, R::LOCAL_FLOOR, R::STAGE]).1, Floor::Stage);
        assert_eq!(Floor::best(&[R::VIEW, R::LOCAL, R::LOCAL_FLOOR]).1, Floor::Local);
        assert_eq!(Floor::best(&[R::VIEW]), (R::LOCAL, Floor::Unknown));
    }

    #[test]
    fn poses_come_back_and_are_of_unit_length() {
        let orientation = DQuat::from_euler(glam::EulerRot::XYZ, 0.3, -1.2, 2.0);
        let pose = Pose { position_m: DVec3::new(1.0, -2.0, 0.5), orientation };
        let mut given = pose_to_xr(&pose);
        given.orientation.w *= 1.005;
        let back = pose_from_xr(given).unwrap();
        assert!(back.is_valid() && back.angle_to_rad(&pose) < 0.01, "{back:?}");
        assert_eq!(back.position_m, pose.position_m);
    }

    #[test]
    fn what_is_no_pose_is_none() {
        let nan = xr::Posef { position: xr::Vector3f { x: f32::NAN, y: 0.0, z: 0.0 }, ..xr::Posef::IDENTITY };
        assert_eq!(pose_from_xr(nan), None);
        let zero = xr::Quaternionf { x: 0.0, y: 0.0, z: 0.0, w: 0.0 };
        assert_eq!(pose_from_xr(xr::Posef { orientation: zero, ..xr::Posef::IDENTITY }), None);
        let whole = xr::SpaceLocationFlags::POSITION_VALID | xr::SpaceLocationFlags::ORIENTATION_VALID;
        assert!(known(whole, xr::Posef::IDENTITY).is_some());
        for part in [xr::SpaceLocationFlags::POSITION_VALID, xr::SpaceLocationFlags::ORIENTATION_VALID] {
            assert_eq!(known(part, xr::Posef::IDENTITY), None);
        }
    }
}
