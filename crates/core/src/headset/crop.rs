//! What part of the volume is shown, in spaces that go with the volume.

use super::Stand;
use super::stand::corners;
use crate::head::Pose;
use crate::scene::{Clip, ClipPlane};
use glam::{DAffine3, DVec3};

/// How near fingers are to what they drag, metres, ...
const NEAR_M: f64 = 0.03;

/// and of small volumes, in longest sides: fingers fit in between.
const NEAR_SIDES: f64 = 0.1;

/// What can be dragged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Handle {
    /// A face of the visible box, as [`Clip::face`] counts them.
    Face(usize),
    /// The plane that cuts the volume.
    Plane,
}

/// What a hand points at, or drags.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picked {
    /// What it is.
    pub handle: Handle,
    /// Where it has been picked, world space, metres.
    pub point_m: DVec3,
}

/// A visible box in texture space, and a plane in upright space: `normal · p ≥ offset` stays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Crop {
    /// The plane's normal has unit length, its offset counts longest sides of the volume.
    clip: Clip,
}

/// A ray in the spaces of the volume, by its parameter in metres.
pub(super) struct Ray {
    upright_origin: DVec3,
    upright_direction: DVec3,
    texture_origin: DVec3,
    texture_direction: DVec3,
}

impl Ray {
    /// Along the −Z of a pose in upright space, per metre.
    pub(super) fn new(aim: &Pose, stand: &Stand, upright_from_texture: DAffine3) -> Self {
        let upright_from_world = stand.world_from_upright().inverse();
        let texture_from_upright = upright_from_texture.inverse();
        let upright_origin = upright_from_world.transform_point3(aim.position_m);
        let upright_direction = upright_from_world.transform_vector3(aim.orientation * DVec3::NEG_Z);
        Self {
            upright_origin,
            upright_direction,
            texture_origin: texture_from_upright.transform_point3(upright_origin),
            texture_direction: texture_from_upright.transform_vector3(upright_direction),
        }
    }

    /// Where it is after so many metres, upright space.
    pub(super) fn at(&self, distance_m: f64) -> DVec3 {
        self.upright_origin + distance_m * self.upright_direction
    }

    /// The faces of a box in texture space: how far inside the origin is, and what is gained per metre.
    fn in_box(&self, lo: DVec3, hi: DVec3) -> impl Iterator<Item = (Handle, [f64; 2])> {
        let (origin, direction) = (self.texture_origin, self.texture_direction);
        (0..3).flat_map(move |axis| {
            [
                (Handle::Face(axis), [origin[axis] - lo[axis], direction[axis]]),
                (Handle::Face(axis + 3), [hi[axis] - origin[axis], -direction[axis]]),
            ]
        })
    }

    fn before_plane(&self, plane: ClipPlane) -> (Handle, [f64; 2]) {
        let inside = plane.normal.dot(self.upright_origin) - plane.offset_m;
        (Handle::Plane, [inside, plane.normal.dot(self.upright_direction)])
    }
}

impl Crop {
    /// What a clip shows of a volume that stands somewhere. A plane whose normal is none is left out.
    pub(super) fn new(clip: &Clip, stand: &Stand) -> Self {
        let plane = clip.plane.and_then(|plane| {
            let length = plane.normal.length();
            let normal = plane.normal.try_normalize()?;
            let from_middle_m = plane.offset_m / length - normal.dot(stand.pose.position_m);
            Some(ClipPlane {
                normal: stand.pose.orientation.inverse() * normal,
                offset_m: from_middle_m / stand.longest_side_m,
            })
        });
        Self { clip: Clip { plane, ..*clip } }
    }

    /// The same for casters, with the plane in upright space.
    pub(super) fn upright_clip(&self) -> Clip {
        self.clip
    }

    /// The same for casters, with the plane in world space.
    pub(super) fn clip(&self, stand: &Stand) -> Clip {
        let plane = self.clip.plane.map(|plane| {
            let normal = stand.pose.orientation * plane.normal;
            let offset_m = plane.offset_m * stand.longest_side_m + normal.dot(stand.pose.position_m);
            ClipPlane { normal, offset_m }
        });
        Clip { plane, ..self.clip }
    }

    /// What a ray meets first of the visible part of the volume, from outside or from within, and after how many metres: a
    /// face, or the plane where it cuts. A plane that the ray meets within the volume, but not where anything is visible, is met,
    /// too, if nothing else is.
    pub(super) fn pick(&self, ray: &Ray) -> Option<(Handle, f64)> {
        let plane = self.clip.plane.map(|plane| ray.before_plane(plane));
        let visible = ray.in_box(self.clip.box_lo, self.clip.box_hi).chain(plane);
        boundary(visible).or_else(|| {
            let (handle, [inside, gained]) = plane?;
            let distance_m = -inside / gained;
            let is_in_volume = ray
                .in_box(DVec3::ZERO, DVec3::ONE)
                .all(|(_, [inside, gained])| inside + distance_m * gained >= 0.0);
            (distance_m >= 0.0 && is_in_volume).then_some((handle, distance_m))
        })
    }

    /// What of the visible part's boundary is nearest to a point in world space that is near it, metres: a face, or the plane where it
    /// cuts.
    pub(super) fn near(
        &self,
        point_m: DVec3,
        stand: &Stand,
        upright_from_texture: DAffine3,
    ) -> Option<Handle> {
        let Clip { box_lo, box_hi, plane } = self.clip;
        let point = stand.world_from_upright().inverse().transform_point3(point_m);
        let texture_from_upright = upright_from_texture.inverse();
        let in_texture = texture_from_upright.transform_point3(point);
        let clamped = |at: DVec3| upright_from_texture.transform_point3(at.clamp(box_lo, box_hi));
        let faces = (0..6_usize).filter_map(|face| {
            let mut on_face = in_texture.clamp(box_lo, box_hi);
            on_face[face % 3] = self.clip.face(face);
            let nearest = upright_from_texture.transform_point3(on_face);
            let is_cut_away = plane.is_some_and(|plane| plane.normal.dot(nearest) < plane.offset_m);
            (!is_cut_away).then_some((Handle::Face(face), nearest))
        });
        let on_plane = plane.map(|plane| {
            let foot = point - plane.normal * (plane.normal.dot(point) - plane.offset_m);
            (Handle::Plane, clamped(texture_from_upright.transform_point3(foot)))
        });
        let near = (NEAR_M / stand.longest_side_m).min(NEAR_SIDES);
        let distances = faces.chain(on_plane).map(|(handle, nearest)| (handle, point.distance(nearest)));
        let (handle, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1))?;
        (distance <= near).then_some(handle)
    }

    /// The same with something taken from where it is in another crop, and moved rigidly in upright space together with a point of
    /// it. A face goes along its axis only, by as much as the point does; a plane goes with the motion, as long as it cuts the volume.
    pub(super) fn with_moved(
        mut self,
        handle: Handle,
        before: &Self,
        [from, to]: [DVec3; 2],
        motion: DAffine3,
        upright_from_texture: DAffine3,
    ) -> Self {
        match handle {
            Handle::Face(face) => {
                let by = upright_from_texture.inverse().transform_vector3(to - from)[face % 3];
                self.clip.move_face(face, before.clip.face(face) + by);
            }
            Handle::Plane => {
                self.clip.plane =
                    before.clip.plane.map(|plane| moved_plane(plane, motion, upright_from_texture));
            }
        }
        self
    }
}

/// Where a ray enters a convex body, by how far inside its sides it begins and what it gains per metre; or where it leaves the
/// body if it begins within.
fn boundary(sides: impl Iterator<Item = (Handle, [f64; 2])>) -> Option<(Handle, f64)> {
    let mut enter = (None, f64::NEG_INFINITY);
    let mut leave = (None, f64::INFINITY);
    for (handle, [inside, gained]) in sides {
        let distance_m = -inside / gained;
        if gained > 0.0 {
            if distance_m > enter.1 {
                enter = (Some(handle), distance_m);
            }
        } else if gained < 0.0 {
            if distance_m < leave.1 {
                leave = (Some(handle), distance_m);
            }
        } else if inside < 0.0 {
            return None;
        }
    }
    if enter.1 > leave.1 || leave.1 < 0.0 {
        return None;
    }
    let (handle, distance_m) = if enter.1 >= 0.0 { enter } else { leave };
    handle.map(|handle| (handle, distance_m)).filter(|_| distance_m.is_finite())
}

/// A plane moved rigidly, but not out of the volume.
fn moved_plane(plane: ClipPlane, motion: DAffine3, upright_from_texture: DAffine3) -> ClipPlane {
    if motion == DAffine3::IDENTITY {
        return plane;
    }
    let foot = motion.transform_point3(plane.normal * plane.offset_m);
    let normal = motion.transform_vector3(plane.normal).try_normalize().unwrap_or(plane.normal);
    let heights = corners(upright_from_texture).map(|corner| normal.dot(corner));
    let (lo, hi) =
        heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), height| (lo.min(height), hi.max(height)));
    let margin = Clip::THINNEST * (hi - lo);
    ClipPlane { normal, offset_m: normal.dot(foot).clamp(lo + margin, hi - margin) }
}
