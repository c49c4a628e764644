//! The eyes in the volume's own space.

use glam::{DAffine3, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Stand};
use wheatstone_core::view::{Frustum, View};

/// How far what is seen may move in a picture before another one is cast, pixels: the warp takes care of less.
const UNSEEN_PX: f64 = 0.5;

/// The views of the eyes, left one first, in the upright space of a volume that stands somewhere.
pub(crate) fn upright_views(eyes: &[Eye; 2], stand: &Stand, sizes: [[u32; 2]; 2]) -> [View; 2] {
    [0, 1].map(|eye: usize| upright_eye(&eyes[eye], stand).view(sizes[eye]))
}

fn upright_eye(eye: &Eye, stand: &Stand) -> Eye {
    let per_side = stand.longest_side_m.recip();
    let Frustum { near_m, far_m, .. } = eye.frustum;
    Eye {
        pose: upright_pose(&eye.pose, stand),
        frustum: Frustum { near_m: per_side * near_m, far_m: per_side * far_m, ..eye.frustum },
    }
}

/// A pose in the room as it is in the upright space of a volume that stands somewhere.
pub(crate) fn upright_pose(pose: &Pose, stand: &Stand) -> Pose {
    let upright_from_room = stand.pose.orientation.inverse();
    Pose {
        position_m: upright_from_room * (pose.position_m - stand.pose.position_m) / stand.longest_side_m,
        orientation: (upright_from_room * pose.orientation).normalize(),
    }
}

/// Whether views see a volume as others do, within less than a pixel.
pub(crate) fn see_alike(views: &[View], others: &[View], world_from_texture: DAffine3) -> bool {
    let corners = (0..8_u32).map(|bits| {
        world_from_texture.transform_point3(DVec3::from([0, 1, 2].map(|axis| f64::from(bits >> axis & 1))))
    });
    let corners: Vec<DVec3> = corners.collect();
    let alike = |(view, other): (&View, &View)| {
        view.size == other.size
            && corners.iter().all(|&corner| {
                match (view.pixel_position(corner), other.pixel_position(corner)) {
                    (Some(at), Some(before)) => at.distance(before) < UNSEEN_PX,
                    _ => false,
                }
            })
    };
    views.len() == others.len() && views.iter().zip(others).all(alike)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn eye(position_m: DVec3) -> Eye {
        let frustum =
            Frustum { left: -1.2, right: 0.9, down: -1.0, up: 1.1, near_m: 0.05, far_m: f64::INFINITY };
        Eye { pose: Pose { position_m, orientation: DQuat::from_rotation_y(0.2) }, frustum }
    }

    fn stand() -> Stand {
        let orientation = DQuat::from_rotation_z(0.7) * DQuat::from_rotation_x(0.3);
        Stand { pose: Pose { position_m: DVec3::new(0.2, 1.3, -0.6), orientation }, longest_side_m: 0.3 }
    }

    #[test]
    fn a_point_of_the_volume_is_seen_at_the_same_pixel_and_at_a_depth_to_scale() {
        let (eye, stand) = (eye(DVec3::new(0.0, 1.6, 0.0)), stand());
        let [upright, _] = upright_views(&[eye, eye], &stand, [[400, 300]; 2]);
        let room = eye.view([400, 300]);
        for point in [DVec3::ZERO, DVec3::new(0.5, -0.3, 0.2)] {
            let in_room = stand.world_from_upright().transform_point3(point);
            let (a, b) = (upright.pixel_position(point).unwrap(), room.pixel_position(in_room).unwrap());
            assert!(a.distance(b) < 1e-9, "{a} {b}");
            let (a, b) = (upright.depths_m(&[point]).0, room.depths_m(&[in_room]).0);
            assert!((a * stand.longest_side_m - b).abs() < 1e-12);
        }
    }

    #[test]
    fn what_moves_by_less_than_half_a_pixel_is_seen_alike() {
        let world_from_texture = DAffine3::from_translation(DVec3::splat(-0.5));
        let views = |x| upright_views(&[eye(DVec3::new(x, 1.6, 0.0)); 2], &stand(), [[400, 300]; 2]);
        assert!(see_alike(&views(0.0), &views(1e-4), world_from_texture));
        assert!(!see_alike(&views(0.0), &views(0.01), world_from_texture));
        assert!(!see_alike(&views(0.0)[..1], &views(0.0), world_from_texture));
    }
}
