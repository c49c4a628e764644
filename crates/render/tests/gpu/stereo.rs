//! Pairs from one cast: the reference eye is a mono cast, the derived eye is close to its own.

use crate::device::on_device;
use crate::pairs::{dssim, middle, pair, render_pair};
use crate::scene::*;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Light, Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::stereo::{Epipolar, StereoError};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Volume, VoxelType};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{
    Form, Gpu, GpuVolume, Leap, PairError, PairMethod, Prepared, Quality, Renderer, Sources, TexelFormat,
};

/// Largest difference of a channel of the reference eye from a mono cast: one level of an 8-bit picture.
const LARGEST_DIFFERENCE: f64 = 1.0 / 255.0;

/// DSSIM of the derived eye from its own cast; samples are up to half a pixel off.
const DERIVED_DSSIM: f64 = 0.01;

fn volume() -> Volume {
    blob_volume([40, 33, 37], spacing([1.0, 1.2, 1.1]), VoxelType::U8)
}

fn settings(volume: &Volume, shading: Shading) -> Settings {
    let mut settings = Settings::new(volume.full_window(), transfer(0.3));
    settings.shading = shading;
    settings
}

fn cast_pair(gpu: &Gpu, renderer: &mut Renderer, prepared: &Prepared, views: [View; 2]) -> [Cast; 2] {
    let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
    render_pair(gpu, renderer, prepared, &epipolar, PairMethod::default()).unwrap()
}

#[test]
fn the_reference_eye_is_a_mono_cast_and_the_derived_eye_close_to_its_own() {
    let volume = volume();
    let far = middle([131, 95], DVec3::new(0.5, 0.3, 1.4));
    let near = middle([131, 95], DVec3::new(0.3, 0.2, 0.75));
    let mut all = vec![
        ("far", Shading::None, far, 0.065, f64::INFINITY),
        ("converging", Shading::Phong, far, 0.065, 1.4),
        ("near", Shading::None, near, 0.065, f64::INFINITY),
        ("one column", Shading::None, far, 1e-4, f64::INFINITY),
        ("wider than a strip", Shading::None, middle([301, 40], DVec3::new(0.2, 0.1, 0.85)), 0.3, 0.85),
        ("shadow", Shading::Shadow, far, 0.065, 2.0),
    ];
    // Eyes swapped: the rays of the right eye, the picture of the left.
    all.extend(
        all.clone()
            .into_iter()
            .map(|(name, shading, view, e, convergence_m)| (name, shading, view, -e, convergence_m)),
    );
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut failures = Vec::new();
        for (name, shading, view, eye_distance_m, convergence_m) in all {
            let mut settings = settings(&volume, shading);
            settings.light = Light::Directional(glam::Vec3::new(0.3, 0.8, 0.2).normalize_or_zero());
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
            let views = pair(&view, eye_distance_m, convergence_m);
            let own = renderer.render_to_host(gpu, &prepared, &views).unwrap();
            let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
            for quality in [Quality::Fast, Quality::Repaired] {
                let method = PairMethod { quality, ..PairMethod::default() };
                let [reference, derived] = render_pair(gpu, renderer, &prepared, &epipolar, method).unwrap();
                let difference = largest_difference(&reference, &own[0]);
                if difference > LARGEST_DIFFERENCE {
                    failures.push(format!(
                        "{name} {eye_distance_m} {quality:?}: reference eye off by {difference}"
                    ));
                }
                let dssim = dssim(&derived, &own[1]);
                if dssim > DERIVED_DSSIM || dssim.is_nan() {
                    failures.push(format!("{name} {eye_distance_m} {quality:?}: derived eye DSSIM {dssim}"));
                }
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}

#[test]
fn leaping_changes_no_pair_and_a_frame_leaves_nothing_to_the_next() {
    let volume = volume();
    let views = pair(&middle([150, 70], DVec3::new(0.4, 0.3, 1.0)), 0.065, f64::INFINITY);
    on_device(|gpu, renderer| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let uploaded =
            GpuVolume::upload_as(gpu, &volume, TexelFormat::R16FloatOf8Bit, &mut |_, _| {}).unwrap();
        let block_size = BlockSize::cube(3).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
        let mut settings = settings(&volume, Shading::None);
        settings.early_termination = None;
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let map = builder.map(gpu, &parameters, Structure::Anisotropic).unwrap();
        let sources = |leap| Sources { leap, ..Sources::volume(&uploaded) };
        let all = renderer.prepare(gpu, &sources(Leap::Nothing), parameters.clone()).unwrap();
        let leaping = renderer.prepare(gpu, &sources(Leap::EmptyBlocks(&map)), parameters).unwrap();
        let every_sample = cast_pair(gpu, renderer, &all, views);
        let leapt = cast_pair(gpu, renderer, &leaping, views);
        let again = cast_pair(gpu, renderer, &leaping, views);
        for eye in 0..2 {
            let difference = largest_difference(&every_sample[eye], &leapt[eye]);
            assert!(difference <= LARGEST_DIFFERENCE, "{difference}");
            assert_eq!(largest_difference(&leapt[eye], &again[eye]), 0.0);
        }
        assert!(leapt[0].samples < every_sample[0].samples);
    });
}

#[test]
fn what_cannot_be_derived_is_said() {
    let volume = volume();
    let [left, right] = pair(&middle([40, 30], DVec3::new(0.0, 0.0, 1.5)), 0.065, f64::INFINITY);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut settings = settings(&volume, Shading::None);
        settings.mode = Mode::Mip;
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let epipolar = Epipolar::new(&left, &right).unwrap();
        let refused = render_pair(gpu, renderer, &prepared, &epipolar, PairMethod::default());
        assert!(matches!(refused, Err(PairError::Mode)));
    });
    let turned = View { view_from_world: DAffine3::from_rotation_y(0.1) * right.view_from_world, ..right };
    assert!(matches!(Epipolar::new(&left, &turned), Err(StereoError::Orientation { .. })));
}

#[test]
fn only_strips_are_repaired() {
    let volume = volume();
    let [left, right] = pair(&middle([40, 30], DVec3::new(0.0, 0.0, 1.5)), 0.065, f64::INFINITY);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let parameters = CastParameters::new(&settings(&volume, Shading::None), &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let epipolar = Epipolar::new(&left, &right).unwrap();
        let method = PairMethod { form: Form::Tiles, quality: Quality::Repaired };
        let refused = render_pair(gpu, renderer, &prepared, &epipolar, method);
        assert!(matches!(refused, Err(PairError::Unrepaired)));
    });
}
