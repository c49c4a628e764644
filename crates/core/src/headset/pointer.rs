//! What a hand points at in the volume.

use crate::cast::{CastParameters, FIRST_HIT_ALPHA};
use crate::head::Pose;
use crate::reference::{Aids, Caster};
use crate::scene::{Mode, Settings, Shading};
use crate::view::{Frustum, Projection, View};
use glam::DVec3;

/// Half of the width of the pointer's ray, tangent: a micrometre a metre away.
const HALF_WIDTH: f64 = 1e-6;

/// What is under a pointer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pointed {
    /// Where it is, world space, metres.
    pub point_m: DVec3,
    /// From the pointer, metres.
    pub distance_m: f64,
    /// The volume's value there, in the file's unit.
    pub value: f64,
}

/// The value where a hand's aim meets what is visible: at the [depth](crate::image::Image::depth_m) that a picture from the hand
/// would have in the middle of its only pixel. That is the first hit of composites and isosurfaces, and the extreme of maximum and
/// minimum projections. `None` if the aim is none or meets nothing, and for means and X-rays, which see no place of their own.
///
/// It costs one ray of the reference caster, which takes the place of the volume: it holds the voxels itself. Parameters of
/// [`pointing_settings`] make that ray short.
pub fn value_under(aim: &Pose, caster: &Caster, parameters: &CastParameters) -> Option<Pointed> {
    if matches!(parameters.mode, Mode::Mean | Mode::XRay) {
        return None;
    }
    let aim = aim.normalized()?;
    let frustum = Frustum {
        left: -HALF_WIDTH,
        right: HALF_WIDTH,
        down: -HALF_WIDTH,
        up: HALF_WIDTH,
        near_m: 0.0,
        far_m: f64::INFINITY,
    };
    let view = View {
        view_from_world: aim.world_from_own().inverse(),
        projection: Projection::Perspective(frustum),
        size: [1, 1],
        shaded_from: None,
    };
    let cast = caster.cast_exactly(parameters, &Aids::default(), &[view]).pop()?;
    let distance_m = f64::from(*cast.image.depth_m.first()?);
    let point_m = aim.position_m + aim.orientation * DVec3::NEG_Z * distance_m;
    distance_m.is_finite().then(|| {
        let point_in_texture = parameters.texture_from_world.transform_point3(point_m);
        Pointed { point_m, distance_m, value: caster.value_at(point_in_texture) }
    })
}

/// The same settings but for what does not change where [`value_under`] meets something: nothing is lit, and rays end where it is met.
pub fn pointing_settings(settings: Settings) -> Settings {
    Settings { shading: Shading::None, early_termination: Some(FIRST_HIT_ALPHA), ..settings }
}
