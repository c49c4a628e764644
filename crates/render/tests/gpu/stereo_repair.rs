//! Repair: what the reference eye does not see, and what half a column shows.

use crate::device::on_device;
use crate::pairs::{dssim, middle, pair, render_pair};
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::metrics::compare_where;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::Settings;
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::View;
use wheatstone_core::volume::{Grid, Volume, Voxels, Window};
use wheatstone_render::{Gpu, GpuVolume, PairMethod, Prepared, Quality, Renderer, Sources};

/// A cube of 8-bit voxels.
fn cube(side: usize, value: impl Fn(usize, usize, usize) -> u8) -> Volume {
    let index = |i: usize| value(i % side, i / side % side, i / (side * side));
    let voxels = (0..side.pow(3)).map(index).collect();
    Volume::new(Grid::centred([side; 3], [1.0; 3]).unwrap(), Voxels::U8(voxels)).unwrap()
}

/// A volume whose opaque rays end.
struct Opaque<'a> {
    gpu: &'a Gpu,
    renderer: &'a mut Renderer,
    prepared: Prepared,
}

impl<'a> Opaque<'a> {
    fn new(gpu: &'a Gpu, renderer: &'a mut Renderer, volume: &Volume, samples_per_voxel: f32) -> Self {
        let uploaded = GpuVolume::upload(gpu, volume, &mut |_, _| {}).unwrap();
        let mut settings =
            Settings::new(Window::new(0.0, 255.0).unwrap(), TransferFunction::ramp(0.0, 0.5).unwrap());
        settings.early_termination = Some(0.99);
        settings.sampling_factor = samples_per_voxel;
        let parameters = CastParameters::new(&settings, &placement(volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        Self { gpu, renderer, prepared }
    }

    fn own(&mut self, views: &[View; 2]) -> Vec<Cast> {
        self.renderer.render_to_host(self.gpu, &self.prepared, views).unwrap()
    }

    fn pair(&mut self, views: &[View; 2], quality: Quality) -> [Cast; 2] {
        let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
        let method = PairMethod { quality, ..PairMethod::default() };
        render_pair(self.gpu, self.renderer, &self.prepared, &epipolar, method).unwrap()
    }
}

/// Pixels where the derived picture has a hole in what is opaque, or something opaque where nothing is.
fn gaps(derived: &Cast, own: &Cast) -> usize {
    let pixels = derived.image.color.iter().zip(&own.image.color);
    let is_gap = |derived: f32, own: f32| own > 0.95 && derived < 0.5 || derived > 0.95 && own < 0.05;
    pixels.filter(|(derived, own)| is_gap(derived[3], own[3])).count()
}

/// An opaque plate before an opaque ball: what the reference eye does not see behind the plate's edge is missing.
fn plate_before_ball() -> Volume {
    cube(48, |x, y, z| {
        let [x, y, z] = [x, y, z].map(|i| i as f64 - 23.5);
        let is_plate = y > 15.0 && y < 19.0 && x < 2.0;
        let is_ball = x * x + (y + 8.0) * (y + 8.0) + z * z < 12.0 * 12.0;
        if is_plate || is_ball { 200 } else { 0 }
    })
}

#[test]
fn what_the_reference_eye_does_not_see_is_filled() {
    let volume = plate_before_ball();
    let views = pair(&middle([201, 131], DVec3::new(0.1, 0.05, -1.1)), -0.15, f64::INFINITY);
    on_device(|gpu, renderer| {
        let mut scene = Opaque::new(gpu, renderer, &volume, 1.0);
        let own = scene.own(&views);
        let [fast, repaired, again] =
            [Quality::Fast, Quality::Repaired, Quality::Repaired].map(|quality| scene.pair(&views, quality));
        assert!(gaps(&fast[1], &own[1]) >= 10, "{}", gaps(&fast[1], &own[1]));
        assert_eq!(gaps(&repaired[1], &own[1]), 0);
        let [of_fast, of_repaired] = [&fast, &repaired].map(|pair| dssim(&pair[1], &own[1]));
        assert!(of_repaired < 0.5 * of_fast, "{of_repaired} {of_fast}");
        assert!(largest_difference(&repaired[0], &own[0]) <= 1.0 / 255.0);
        assert_eq!(largest_difference(&repaired[1], &again[1]), 0.0);
    });
}

#[test]
fn faces_and_silhouettes_that_the_box_cuts_are_found() {
    // Rays leave through the sides of a block that fills its volume.
    let volume = cube(32, |x, y, z| if (x / 4 + y / 4 + z / 4).is_multiple_of(2) { 60 } else { 110 });
    let cases = [(0.4, 0.4), (-0.4, 0.4), (0.4, -0.4), (-0.4, -0.4), (0.6, 0.065), (-0.6, 0.065)];
    on_device(|gpu, renderer| {
        let mut scene = Opaque::new(gpu, renderer, &volume, 1.0);
        let of_case = |(x, eye_distance_m): (f64, f64)| {
            let views = pair(&middle([163, 121], DVec3::new(x, 0.1, 1.7)), eye_distance_m, f64::INFINITY);
            let [_, derived] = scene.pair(&views, Quality::Repaired);
            gaps(&derived, &scene.own(&views)[1])
        };
        assert_eq!(cases.map(of_case), [0; 6]);
    });
}

/// Grain as fine as the voxels.
fn grain() -> Volume {
    let mut state = 1_u32;
    let values: Vec<u8> = (0..40_usize.pow(3))
        .map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            if state >> 31 == 0 { 30 } else { 120 }
        })
        .collect();
    cube(40, |x, y, z| {
        let is_ball = [x, y, z].map(|i| (i as f64 - 19.5).powi(2)).iter().sum::<f64>() < 18.0 * 18.0;
        if is_ball { values[(z * 40 + y) * 40 + x] } else { 0 }
    })
}

/// Over the windows that the volume is in.
fn dssim_covered(derived: &Cast, own: &Cast) -> f64 {
    let [a, b] = [derived, own].map(|cast| cast.image.over_background([0.0; 3]));
    let is_covered: Vec<bool> = own.image.color.iter().map(|color| color[3] > 0.0).collect();
    compare_where(&a, &b, &is_covered).unwrap().dssim()
}

#[test]
fn as_much_is_cast_as_it_takes() {
    let smooth = cube(40, |x, y, z| {
        let radius = [x, y, z].map(|i| (i as f64 - 19.5).powi(2)).iter().sum::<f64>().sqrt();
        (20.0 - radius).clamp(0.0, 5.0) as u8
    });
    on_device(|gpu, renderer| {
        let views = pair(&middle([220, 160], DVec3::new(0.3, 0.2, 1.2)), 0.065, f64::INFINITY);
        for (volume, needs_repair) in [(grain(), true), (smooth, false)] {
            let mut scene = Opaque::new(gpu, renderer, &volume, 1.0);
            let own = &scene.own(&views)[1];
            let [fast, repaired] =
                [Quality::Fast, Quality::Repaired].map(|quality| scene.pair(&views, quality)[1].clone());
            let [of_fast, of_repaired] = [&fast, &repaired].map(|derived| dssim_covered(derived, own));
            if needs_repair {
                assert!(of_fast > 0.012 && of_repaired < 0.01, "{of_fast} {of_repaired}");
            } else {
                assert!(of_fast < 0.007, "{of_fast}");
                assert_eq!(largest_difference(&repaired, &fast), 0.0);
            }
        }
    });
}

#[test]
fn long_rays_are_repaired_in_parts() {
    let volume = plate_before_ball();
    on_device(|gpu, renderer| {
        let views = pair(&middle([61, 45], DVec3::new(0.1, 0.05, -1.1)), -0.15, f64::INFINITY);
        let mut scene = Opaque::new(gpu, renderer, &volume, 75.0);
        let own = &scene.own(&views)[1];
        let [fast, repaired] =
            [Quality::Fast, Quality::Repaired].map(|quality| scene.pair(&views, quality)[1].clone());
        let [in_fast, in_repaired] = [&fast, &repaired].map(|derived| gaps(derived, own));
        assert!(in_fast > 50 && in_repaired < in_fast / 20, "{in_fast} {in_repaired}");
        let [of_fast, of_repaired] = [&fast, &repaired].map(|derived| dssim_covered(derived, own));
        assert!(of_repaired < 0.3 * of_fast, "{of_repaired} {of_fast}");
    });
}
