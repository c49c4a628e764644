//! Level of detail: far fewer samples, and a picture near to that of many rays in each pixel.

use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::{LevelOfDetail, Slab};
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::compare;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::View;
use wheatstone_core::volume::Volume;

struct Levels {
    parameters: CastParameters,
    casters: Vec<Caster>,
}

impl Levels {
    fn of(volume: &Volume) -> Self {
        let settings = Settings::new(byte_window(), TransferFunction::ramp(0.1, 1.0).unwrap());
        let coarser = volume.coarser_levels();
        Self {
            parameters: CastParameters::new(&settings, &Placement::new(volume, world_from_patient())),
            casters: std::iter::once(volume).chain(&coarser).map(Caster::new).collect(),
        }
    }

    fn cast(&self, view: &View, slabs: &[Slab]) -> Cast {
        slabs.iter().fold(Cast::nothing(view.size), |front, slab| {
            let parameters = self.parameters.of_level(slab.level);
            let part = slab.part_of(view);
            self.casters[slab.level].cast_behind(&parameters, &Aids::default(), &part, front)
        })
    }

    fn cast_fully(&self, view: &View) -> Cast {
        self.cast(view, &[Slab { level: 0, depths_m: f64::NEG_INFINITY..f64::INFINITY }])
    }
}

/// Rays of a pixel of the truth along x and y.
const RAYS: u32 = 4;

/// Pixels that are about a 64th of the volume wide at 4 m, each cut into so many along x and y.
fn seen_from(distance_m: f64, cut: u32) -> View {
    let size = [96 * cut; 2];
    let eye = distance_m * DVec3::new(0.5, 0.35, 0.79).normalize_or_zero();
    look(eye, DVec3::ZERO, DVec3::Y, perspective(0.37, size), size)
}

fn over_black(cast: &Cast) -> RgbImage {
    cast.image.over_background([0.0; 3])
}

#[test]
fn what_is_near_is_cast_as_ever_and_what_is_far_by_a_fraction_of_the_samples() {
    let volume = Phantom::Sphere.cube(128).unwrap();
    let levels = Levels::of(&volume);
    let detail = LevelOfDetail::Pixels(1.0);
    let slabs_from = |view: &View| detail.slabs(view, &levels.parameters, levels.casters.len());

    let near = seen_from(1.2, 1);
    let cast = levels.cast(&near, &slabs_from(&near));
    assert_eq!(cast.image, levels.cast_fully(&near).image);

    for (distance_m, most_of_samples) in [(3.4, 0.97), (5.0, 0.55), (9.0, 0.3)] {
        let far = seen_from(distance_m, 1);
        let (cast, full) = (levels.cast(&far, &slabs_from(&far)), levels.cast_fully(&far));
        let of_samples = cast.samples as f64 / full.samples as f64;
        assert!(of_samples < most_of_samples, "{distance_m} m: {of_samples} of the samples");
        let truth = over_black(&levels.cast_fully(&seen_from(distance_m, RAYS))).averaged(RAYS);
        let dssim = compare(&over_black(&cast), &truth).unwrap().dssim();
        assert!(dssim < tolerance::DETAIL_DSSIM, "{distance_m} m: {dssim}");
    }
}

/// The slabs of a homogeneous body let through what the body does, however many there are.
#[test]
fn cutting_into_slabs_changes_no_opacity() {
    let volume = volume_of([16, 16, 16], [1.0; 3], |_| 0.5);
    let settings = Settings {
        early_termination: None,
        ..Settings::new(unit_window(), white_transfer(&[(0.0, 0.08), (1.0, 0.08)]))
    };
    let levels = Levels {
        parameters: CastParameters::new(&settings, &Placement::new(&volume, world_from_patient())),
        casters: std::iter::once(&volume).chain(&volume.coarser_levels()).map(Caster::new).collect(),
    };
    let view = seen_from(2.0, 1);
    let cuts = [f64::NEG_INFINITY, 1.7, 1.93, 2.2, f64::INFINITY];
    let slabs: Vec<Slab> = cuts
        .windows(2)
        .enumerate()
        .map(|(i, cut)| Slab { level: i % levels.casters.len(), depths_m: cut[0]..cut[1] })
        .collect();
    let (whole, cut) = (levels.cast_fully(&view), levels.cast(&view, &slabs));
    let pixels = whole.image.color.iter().zip(&cut.image.color);
    let difference = pixels.map(|(a, b)| (a[3] - b[3]).abs()).fold(0.0, f32::max);
    assert!(f64::from(difference) < 1e-5, "{difference}");
    assert!(whole.image.color.iter().any(|pixel| pixel[3] > 0.5));
}
