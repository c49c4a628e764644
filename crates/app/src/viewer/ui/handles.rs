//! Handles of the clip box and the clip plane, in the picture.

use super::projection::Projection;
use super::theme::{ACCENT, LINE};
use super::{Asked, Beholder, Shown};
use crate::viewer::state::{Clip, Edit, Plane, State};
use egui::{Color32, Painter, Pos2, Rect, Response, Stroke, Ui, Vec2};
use glam::{DAffine3, DVec3};

/// How near the pointer must come, points.
const REACH: f32 = 12.0;

const RADIUS: f32 = 5.0;

/// From the plane's foot to the tip of its normal, metres.
const NORMAL_M: f64 = 0.25;

/// Half of the side of the square that shows the plane, metres.
const HALF_PLANE_M: f64 = 0.5;

/// The handle that is being dragged, and in which of the pictures.
#[derive(Debug, Default)]
pub(super) struct Grip(Option<(usize, Handle)>);

/// What can be dragged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Handle {
    /// A face of the box, as [`Edit::MoveFace`] counts them.
    Face(usize),
    /// The plane, along its normal.
    Foot,
    /// The plane's direction.
    Tip,
}

/// Shows the handles and moves one that is dragged, move by move (points); whether one is.
pub(super) fn show(
    grip: &mut Grip,
    ui: &Ui,
    area: Rect,
    shown: &Shown<'_>,
    picture: &Response,
    moves: &[Vec2],
    asked: &mut Asked,
) -> bool {
    let clip = &shown.state.clip;
    let projections = projections(shown.beholder, shown.state, area);
    let Some(placement) = shown.placement.filter(|_| clip.has_handles && !projections.is_empty()) else {
        grip.0 = None;
        return false;
    };
    let world_from_texture = placement.world_from_texture();
    let faces = [0, 1, 2, 3, 4, 5].map(|face| face_centre(clip.box_lo, clip.box_hi, face));
    let mut handles: Vec<(Handle, DVec3)> = faces
        .iter()
        .enumerate()
        .map(|(face, &centre)| (Handle::Face(face), world_from_texture.transform_point3(centre)))
        .collect();
    if let Some(plane) = clip.plane {
        let [foot, tip] = foot_and_tip(&plane);
        handles.extend([(Handle::Foot, foot), (Handle::Tip, tip)]);
    }
    let under = picture.hover_pos().and_then(|pointer| nearest(&projections, &handles, pointer));
    if picture.drag_started() {
        // By now the pointer may have moved on.
        let origin = ui.input(|input| input.pointer.press_origin());
        grip.0 = origin.and_then(|origin| nearest(&projections, &handles, origin));
    }
    if !picture.dragged() && !picture.drag_stopped() {
        grip.0 = None;
    }
    for (eye, projection) in projections.iter().enumerate() {
        let painter = ui.painter_at(projection.area());
        draw_box(&painter, projection, world_from_texture, [clip.box_lo, clip.box_hi]);
        if let Some(plane) = clip.plane {
            draw_plane(&painter, projection, &plane);
        }
        for &(handle, place_m) in &handles {
            if let Some(place) = projection.place(place_m) {
                let is_active = [grip.0, under].contains(&Some((eye, handle)));
                let fill = if is_active { ACCENT } else { Color32::from_black_alpha(160) };
                painter.circle(place, RADIUS, fill, Stroke::new(1.5, ACCENT));
            }
        }
    }
    let Some((eye, held)) = grip.0 else { return false };
    let mut state = shown.state.clone();
    for (projection, &by) in
        projections.get(eye).into_iter().flat_map(|eye| moves.iter().map(move |by| (eye, by)))
    {
        let moved = drag_handle(held, projection, world_from_texture, &state.clip, by);
        // Each move goes on from where the one before has led.
        if let Some(edit) = moved.filter(|edit| state.apply(edit).is_ok()) {
            asked.edit(edit);
        }
    }
    true
}

/// What shows the handles: the picture, or that of each eye side by side.
fn projections(beholder: &Beholder, state: &State, area: Rect) -> Vec<Projection> {
    beholder.seen(state, area).into_iter().map(|(view, area)| Projection::new(view, area)).collect()
}

/// The handle within reach of the pointer, and in which picture.
fn nearest(
    projections: &[Projection],
    handles: &[(Handle, DVec3)],
    pointer: Pos2,
) -> Option<(usize, Handle)> {
    let (eye, projection) =
        projections.iter().enumerate().find(|(_, projection)| projection.area().contains(pointer))?;
    handles
        .iter()
        .filter_map(|&(handle, place_m)| Some((handle, projection.place(place_m)?.distance(pointer))))
        .filter(|&(_, distance)| distance < REACH)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(handle, _)| (eye, handle))
}

/// The middle of a face, texture space.
fn face_centre(lo: DVec3, hi: DVec3, face: usize) -> DVec3 {
    let mut centre = 0.5 * (lo + hi);
    centre[face % 3] = if face < 3 { lo[face] } else { hi[face - 3] };
    centre
}

/// The plane's point nearest to the volume's centre, and the tip of the normal there, world space.
fn foot_and_tip(plane: &Plane) -> [DVec3; 2] {
    let length_squared = plane.normal.length_squared().max(f64::MIN_POSITIVE);
    let foot = plane.normal * (plane.offset_m / length_squared);
    [foot, foot + plane.normal.normalize_or_zero() * NORMAL_M]
}

fn drag_handle(
    handle: Handle,
    projection: &Projection,
    world_from_texture: DAffine3,
    clip: &Clip,
    by: Vec2,
) -> Option<Edit> {
    match handle {
        Handle::Face(face) => {
            let centre = face_centre(clip.box_lo, clip.box_hi, face);
            drag_face(projection, world_from_texture, centre, face, by)
        }
        Handle::Foot => drag_foot(projection, clip.plane?, by),
        Handle::Tip => drag_tip(projection, clip.plane?, by),
    }
}

/// How far along a direction in the picture a drag goes, in lengths of the direction.
fn along(by: Vec2, slope: Vec2) -> Option<f64> {
    let squared = slope.length_sq();
    (squared > 1e-6).then(|| f64::from(by.dot(slope) / squared))
}

fn drag_face(
    projection: &Projection,
    world_from_texture: DAffine3,
    centre: DVec3,
    face: usize,
    by: Vec2,
) -> Option<Edit> {
    let axis = world_from_texture.matrix3.col(face % 3);
    let slope = projection.slope(world_from_texture.transform_point3(centre), axis)?;
    Some(Edit::MoveFace { face, to: centre[face % 3] + along(by, slope)? })
}

fn drag_foot(projection: &Projection, plane: Plane, by: Vec2) -> Option<Edit> {
    let [foot, _] = foot_and_tip(&plane);
    let moved = along(by, projection.slope(foot, plane.normal)?)?;
    let offset_m = plane.offset_m + moved * plane.normal.length_squared();
    Some(Edit::ClipPlane(Some(Plane { offset_m, ..plane })))
}

fn drag_tip(projection: &Projection, plane: Plane, by: Vec2) -> Option<Edit> {
    let [foot, tip] = foot_and_tip(&plane);
    let [right, up] = projection.point_axes(tip)?;
    let moved = tip + right * f64::from(by.x) - up * f64::from(by.y);
    let normal = (moved - foot).try_normalize()?;
    Some(Edit::ClipPlane(Some(Plane { normal, offset_m: normal.dot(foot) })))
}

fn line(painter: &Painter, projection: &Projection, ends: [DVec3; 2], color: Color32) {
    if let [Some(a), Some(b)] = ends.map(|end| projection.place(end)) {
        painter.line_segment([a, b], Stroke::new(1.0, color));
    }
}

fn draw_box(painter: &Painter, projection: &Projection, world_from_texture: DAffine3, [lo, hi]: [DVec3; 2]) {
    let corner = |bits: usize| {
        let axis = |axis: usize| if bits >> axis & 1 == 1 { hi[axis] } else { lo[axis] };
        world_from_texture.transform_point3(DVec3::new(axis(0), axis(1), axis(2)))
    };
    for bits in 0..8 {
        for axis in (0..3).filter(|axis| bits >> axis & 1 == 0) {
            line(painter, projection, [corner(bits), corner(bits | 1 << axis)], LINE.gamma_multiply(0.6));
        }
    }
}

fn draw_plane(painter: &Painter, projection: &Projection, plane: &Plane) {
    let [foot, tip] = foot_and_tip(plane);
    let (a, b) = plane.normal.normalize_or_zero().any_orthonormal_pair();
    let corners = [a + b, a - b, -a - b, b - a].map(|corner| foot + corner * HALF_PLANE_M);
    for side in 0..4 {
        line(painter, projection, [corners[side], corners[(side + 1) % 4]], ACCENT.gamma_multiply(0.6));
    }
    line(painter, projection, [foot, tip], ACCENT);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::{Arrangement, Camera};
    use egui::{pos2, vec2};

    fn projection() -> Projection {
        let camera = Camera::default();
        let area = Rect::from_min_size(pos2(0.0, 0.0), vec2(400.0, 400.0));
        Projection::new(camera.view([400, 400]).unwrap(), area)
    }

    #[test]
    fn a_face_follows_the_pointer() {
        let (projection, world) = (projection(), DAffine3::from_translation(DVec3::splat(-0.5)));
        let centre = face_centre(DVec3::ZERO, DVec3::ONE, 4);
        let before = projection.place(world.transform_point3(centre)).unwrap();
        let Some(Edit::MoveFace { face: 4, to }) = drag_face(&projection, world, centre, 4, vec2(0.0, 40.0))
        else {
            panic!("the face stays");
        };
        let after = projection.place(world.transform_point3(DVec3 { y: to, ..centre })).unwrap();
        assert!(to < 1.0 && ((after - before).y - 40.0).abs() < 6.0, "{to} {before:?} {after:?}");
    }

    #[test]
    fn side_by_side_each_eye_has_handles_in_its_half() {
        let area = Rect::from_min_size(pos2(20.0, 10.0), vec2(600.0, 300.0));
        let mut state = State::default();
        assert_eq!(projections(&Beholder::Camera, &state, area).len(), 1);
        state.stereo.arrangement = Arrangement::SideBySide;
        let eyes = projections(&Beholder::Camera, &state, area);
        let handle = (Handle::Foot, DVec3::new(0.0, 0.0, 0.4));
        let places: Vec<Pos2> = eyes.iter().map(|eye| eye.place(handle.1).unwrap()).collect();
        let [left, right] = [places[0].x - 20.0, places[1].x - 320.0];
        assert!(0.0 < right && right + 1.0 < left && left < 300.0, "nearer than the target: {places:?}");
        for (eye, place) in places.into_iter().enumerate() {
            let beside = place + vec2(3.0, -3.0);
            assert_eq!(nearest(&eyes, &[handle], beside), Some((eye, Handle::Foot)));
        }
        assert_eq!(nearest(&eyes, &[handle], area.center()), None);
    }

    #[test]
    fn a_dragged_tip_turns_the_plane_about_its_foot() {
        let plane = Plane { normal: DVec3::X, offset_m: 0.1 };
        let Some(Edit::ClipPlane(Some(turned))) = drag_tip(&projection(), plane, vec2(0.0, -60.0)) else {
            panic!("the plane stays");
        };
        assert!(turned.normal.y > 0.1 && (turned.normal.length() - 1.0).abs() < 1e-12);
        assert!((turned.normal.dot(DVec3::X * 0.1) - turned.offset_m).abs() < 1e-12);
    }
}
