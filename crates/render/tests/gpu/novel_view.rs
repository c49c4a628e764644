//! Pairs by a volumetric warp against their twin: a cast in layers, warped on the CPU.

use crate::device::on_device;
use crate::pairs::{dssim, middle, pair, render_pair};
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::stereo::Epipolar;
use wheatstone_core::volume::VoxelType;
use wheatstone_core::warp::{LayerError, LayerThresholds, VolumetricSettings, volumetric};
use wheatstone_render::{Form, GpuVolume, LayersError, PairError, PairMethod, Quality, Sources, TexelFormat};

const METHOD: PairMethod = PairMethod { form: Form::Volumetric, quality: Quality::Fast };

/// What both casters hold exactly.
const FORMAT: TexelFormat = TexelFormat::R16FloatOf8Bit;

#[test]
fn they_are_those_of_the_twin() {
    let volume = blob_volume([40, 33, 37], spacing([1.0, 1.2, 1.1]), VoxelType::U8);
    let middle = middle([131, 95], DVec3::new(0.5, 0.3, 1.4));
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload_as(gpu, &volume, FORMAT, &mut |_, _| {}).unwrap();
        let caster = Caster::with_storage(&volume, storage_kind(FORMAT));
        for (alpha, eye_distance_m) in [(0.1, 0.065), (0.9, -0.065), (0.3, 0.1)] {
            let settings = Settings::new(volume.full_window(), transfer(alpha));
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let [left, right] = pair(&middle, eye_distance_m, f64::INFINITY);
            let epipolar = Epipolar::new(&left, &right).unwrap();
            let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters.clone()).unwrap();
            let own = renderer.render_to_host(gpu, &prepared, &[left, right]).unwrap();
            let [reference, derived] = render_pair(gpu, renderer, &prepared, &epipolar, METHOD).unwrap();
            assert!(largest_difference(&reference, &own[0]) < 1.0 / 255.0, "{alpha}");
            assert!(dssim(&derived, &own[1]) < 0.01, "{alpha}: {}", dssim(&derived, &own[1]));

            let thresholds = LayerThresholds::default();
            let (_, layers) =
                caster.cast_emission_absorption(&parameters, &Aids::default(), &left, &thresholds).unwrap();
            let twin = volumetric(&layers, &left, &right, &VolumetricSettings::default()).unwrap();
            let [found, twin] = [&derived.image, &twin].map(|image| image.over_background([0.0; 3]));
            let off = compare(&found, &twin).unwrap().dssim();
            assert!(off < 1e-4, "{alpha}: {off}");
        }
    });
}

#[test]
fn what_has_no_layers_is_refused() {
    let volume = blob_volume([12, 10, 11], spacing([1.0; 3]), VoxelType::U8);
    let [left, right] = pair(&middle([40, 30], DVec3::new(0.0, 0.0, 1.5)), 0.065, f64::INFINITY);
    let epipolar = Epipolar::new(&left, &right).unwrap();
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut settings = Settings::new(volume.full_window(), transfer(0.3));
        let mut refused = |settings: &Settings, method| {
            let parameters = CastParameters::new(settings, &placement(&volume));
            let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
            render_pair(gpu, renderer, &prepared, &epipolar, method).unwrap_err()
        };
        let nearest = PairMethod { quality: Quality::Nearest, ..METHOD };
        assert!(matches!(refused(&settings, nearest), PairError::Warped));
        settings.mode = Mode::XRay;
        let error = refused(&settings, METHOD);
        assert!(matches!(error, PairError::Unlayered(LayersError::Layers(LayerError::Mode(_)))), "{error}");
    });
}
