//! Eyes, and pairs of pictures from one cast.

use crate::scene::{look, perspective};
use glam::DVec3;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::Cast;
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::{Rig, View};
use wheatstone_render::{Gpu, PairError, PairMethod, Prepared, Renderer, Target};

/// Makes a pair, reference eye first.
pub(crate) fn render_pair(
    gpu: &Gpu,
    renderer: &mut Renderer,
    prepared: &Prepared,
    epipolar: &Epipolar,
    method: PairMethod,
) -> Result<[Cast; 2], PairError> {
    let mut targets = [(); 2].map(|()| Target::new(gpu, epipolar.reference().size).unwrap());
    renderer.render_pair(gpu, prepared, epipolar, method, targets.each_mut())?;
    Ok(targets.map(|target| target.read(gpu).unwrap()))
}

/// The view between the eyes, towards the middle of the world.
pub(crate) fn middle(size: [u32; 2], eye: DVec3) -> View {
    look(eye, DVec3::ZERO, perspective(1.0, size), size)
}

/// Two eyes beside it, left first.
pub(crate) fn pair(middle: &View, eye_distance_m: f64, convergence_m: f64) -> [View; 2] {
    Rig::Stereo { eye_distance_m, convergence_m }.views(middle).try_into().unwrap()
}

/// Of pictures over black.
pub(crate) fn dssim(a: &Cast, b: &Cast) -> f64 {
    let [a, b] = [a, b].map(|cast| cast.image.over_background([0.0; 3]));
    compare(&a, &b).unwrap().dssim()
}
