//! Which way of making a stereo pair is likely to be fastest.
//!
//! Strips do a little work for each segment of a ray, that is for each slab of depth, and save the samples of the second cast. So
//! they pay if a segment has samples enough, or dear ones. Measured with strips, fast, at 768² on software Vulkan with skipping
//! (engine and bonsai, 1 rad): time of two casts over that of strips, by the samples per slab along a diagonal.
//!
//! | | 0.4–0.5 | 1.4–2.5 | 5–6 | 13 |
//! |---|---|---|---|---|
//! | unshaded | 0.92–1.04 | 1.1–1.2 | 1.3 | 1.2–1.5 |
//! | Phong | 1.1–1.2 | 1.4 | 1.5–1.6 | 1.3–1.5 |
//!
//! Tiles and layers are slower than strips there. Small pictures of small volumes gain less or nothing, but take milliseconds
//! either way.

use crate::pairing::FormName;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::Mode;
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::view::View;

/// Samples per slab, those of shading counted, from which on strips beat a second cast.
const LEAST_SAMPLES_PER_SLAB: f64 = 1.0;

/// The cheapest way to make a pair on a GPU of one cast; nothing if two casts are cheaper, or the only way.
pub(crate) fn cheapest(parameters: &CastParameters, views: &[View]) -> Option<FormName> {
    let pays = match parameters.mode {
        Mode::Composite | Mode::XRay => samples_per_slab(parameters, views)? >= LEAST_SAMPLES_PER_SLAB,
        _ => false,
    };
    pays.then_some(FormName::Strips)
}

/// Samples along a diagonal of the volume for each slab of depth that it is in; as if there were one slab where views cannot be
/// derived from each other or do not see the volume, which the cast finds out.
fn samples_per_slab(parameters: &CastParameters, views: &[View]) -> Option<f64> {
    let [left, right] = views else { return None };
    let slabs = Epipolar::new(left, right).ok().and_then(|epipolar| {
        let depths_m = epipolar.depths_m(&parameters.visible_corners_world())?;
        Some(epipolar.slabs().between(depths_m.start, depths_m.end).layers())
    });
    let samples = f64::from(parameters.most_samples_per_ray());
    Some(samples * f64::from(1 + parameters.shading_samples()) / f64::from(slabs.unwrap_or(1)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use wheatstone_core::phantom::Phantom;
    use wheatstone_core::scene::{Placement, Settings, Shading};
    use wheatstone_core::transfer::TransferFunction;
    use wheatstone_core::view::{AnatomicalDirection, Frustum, Orbit, Projection, Rig, world_from_patient};

    fn cheapest_at(distance_m: f64, mode: Mode, shading: Shading) -> Option<FormName> {
        let volume = Phantom::SolidBox.cube(32).unwrap();
        let transfer = TransferFunction::ramp(0.0, 1.0).unwrap();
        let world_from_patient = world_from_patient(volume.grid(), AnatomicalDirection::Superior);
        let settings = Settings { mode, shading, ..Settings::new(volume.full_window(), transfer) };
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient));
        let size = [768, 768];
        let frustum = Frustum::from_fov(1.0, size).unwrap();
        let orbit = Orbit { distance_m, ..Orbit::default() };
        let middle = orbit.view(Projection::Perspective(frustum), size);
        let rig = Rig::Stereo { eye_distance_m: 0.065, convergence_m: f64::INFINITY };
        cheapest(&parameters, &rig.views(&middle))
    }

    #[test]
    fn far_pairs_are_derived_and_near_ones_only_if_dearly_shaded() {
        assert_eq!(cheapest_at(1.7, Mode::Composite, Shading::None), Some(FormName::Strips));
        assert_eq!(cheapest_at(1.7, Mode::XRay, Shading::None), Some(FormName::Strips));
        assert_eq!(cheapest_at(0.6, Mode::Composite, Shading::None), None);
        assert_eq!(cheapest_at(0.6, Mode::Composite, Shading::Shadow), Some(FormName::Strips));
    }

    #[test]
    fn extremes_are_not_derived() {
        assert_eq!(cheapest_at(1.7, Mode::Mip, Shading::None), None);
    }
}
