//! The eyes in the volume's own space.

use crate::viewer::state::EyeMethod;
use glam::{DAffine3, DVec3};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Stand};
use wheatstone_core::view::{Frustum, View};

/// How far what is seen may move in a picture before another one is cast, pixels: the warp takes care of less.
const UNSEEN_PX: f64 = 0.5;

/// From which depth on both eyes see all that is cast for one in their middle, metres.
const NEAREST_M: f64 = 0.25;

/// How many times as wide or high as an eye's picture one for both may be; those of eyes further apart are cast one by one.
const MOST_WIDENING: u32 = 4;

/// The views of the eyes, left one first, in the upright space of a volume that stands somewhere.
pub(crate) fn upright_views(eyes: &[Eye; 2], stand: &Stand, sizes: [[u32; 2]; 2]) -> [View; 2] {
    [0, 1].map(|eye: usize| upright_eye(&eyes[eye], stand).view(sizes[eye]))
}

/// What is cast for the eyes, in the upright space of a volume that stands somewhere, at no fewer pixels per angle than theirs: a view
/// for each, or one in the middle for both, if that is asked for, image planes are parallel, and it is not many times as large as theirs.
pub(crate) fn cast_views(
    method: EyeMethod,
    eyes: &[Eye; 2],
    stand: &Stand,
    sizes: [[u32; 2]; 2],
) -> (EyeMethod, Vec<View>) {
    let middle = match method {
        EyeMethod::OneCast => Eye::between(eyes, NEAREST_M),
        EyeMethod::TwoCasts => None,
    };
    let sized = middle.map(|middle| (middle, size_as_fine(&middle.frustum, eyes, sizes)));
    let [most, _] = largest(sizes).map(|size| size.map(|side| MOST_WIDENING.saturating_mul(side)));
    match sized.filter(|(_, size)| size[0] <= most[0] && size[1] <= most[1]) {
        Some((middle, size)) => (EyeMethod::OneCast, vec![upright_eye(&middle, stand).view(size)]),
        None => (EyeMethod::TwoCasts, upright_views(eyes, stand, largest(sizes)).to_vec()),
    }
}

/// One size for both eyes' casts.
fn largest([left, right]: [[u32; 2]; 2]) -> [[u32; 2]; 2] {
    [[left[0].max(right[0]), left[1].max(right[1])]; 2]
}

/// Width and height at which a frustum has at least as many pixels per angle as eyes with pictures of some sizes.
fn size_as_fine(frustum: &Frustum, eyes: &[Eye; 2], sizes: [[u32; 2]; 2]) -> [u32; 2] {
    let extents = |f: &Frustum| [f.right - f.left, f.up - f.down];
    [0, 1].map(|axis: usize| {
        let per_tangent = |eye: usize| f64::from(sizes[eye][axis]) / extents(&eyes[eye].frustum)[axis];
        let pixels = extents(frustum)[axis] * per_tangent(0).max(per_tangent(1));
        // A cast to an integer keeps within its bounds.
        (pixels - 1e-6).ceil() as u32
    })
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
            Frustum { left: -1.2, right: 0.9, down: -0.6, up: 1.05, near_m: 0.05, far_m: f64::INFINITY };
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

    #[test]
    fn one_cast_for_both_eyes_is_as_fine_as_theirs() {
        let [left, mut right] = [-0.03, 0.03].map(|x| eye(DVec3::new(x, 1.6, 0.0)));
        right.pose.position_m = left.pose.position_m + left.pose.orientation * (0.06 * DVec3::X);
        let sizes = [[420, 330]; 2];
        let (method, views) = cast_views(EyeMethod::OneCast, &[left, right], &stand(), sizes);
        assert_eq!((method, views.len()), (EyeMethod::OneCast, 1));
        // 200 pixels per tangent across, and 0.03 / 0.25 more on each side.
        assert_eq!(views[0].size, [420 + 48, 330]);
        let (method, views) = cast_views(EyeMethod::TwoCasts, &[left, right], &stand(), sizes);
        assert_eq!((method, views.len(), views[1].size), (EyeMethod::TwoCasts, 2, [420, 330]));
        right.pose.orientation *= DQuat::from_rotation_y(0.1);
        let (method, views) = cast_views(EyeMethod::OneCast, &[left, right], &stand(), sizes);
        assert_eq!((method, views.len()), (EyeMethod::TwoCasts, 2));
    }
}
