//! Layers of emission and absorption that the GPU keeps against those of the reference.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume, VoxelType};
use wheatstone_core::warp::{EmissionAbsorption, LayerError, LayerThresholds};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuVolume, LayersError, Leap, Renderer, Sources, Target};

fn volume() -> Volume {
    blob_volume([24, 20, 22], spacing([1.0; 3]), VoxelType::U8)
}

/// What a pixel's layers add to the picture, by depth: the premultiplied colour in front of some depths, metres.
fn gathered(layers: &EmissionAbsorption, pixel: usize, depth_m: f64) -> [f64; 4] {
    let count = layers.layer_count();
    let mut sum = [0.0; 4];
    let mut through = 1.0;
    for layer in &layers.layers()[pixel * count..][..count] {
        let (start_m, end_m) = (f64::from(layer.start_m), f64::from(layer.end_m));
        let length_m = (depth_m.min(end_m) - start_m).max(0.0);
        let color = layer.medium.color(length_m);
        for (sum, color) in sum.iter_mut().zip(color.to_array()) {
            *sum += through * color;
        }
        through *= 1.0 - color.w;
    }
    sum
}

/// Mean difference, over pixels and depths through the volume, of what is in front of them.
fn difference(a: &EmissionAbsorption, b: &EmissionAbsorption) -> f64 {
    let mut total = 0.0;
    let pixels = (a.size()[0] * a.size()[1]) as usize;
    let depths_m: Vec<f64> = (0..24).map(|i| 0.9 + 0.05 * f64::from(i)).collect();
    for pixel in 0..pixels {
        for &depth_m in &depths_m {
            let [a, b] = [a, b].map(|layers| gathered(layers, pixel, depth_m));
            total += a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        }
    }
    total / (pixels * depths_m.len()) as f64
}

fn cast(
    gpu: &Gpu,
    renderer: &mut Renderer,
    volume: &Volume,
    (parameters, leaps): (&CastParameters, bool),
    (view, thresholds): (&View, &LayerThresholds),
) -> (Target, Target) {
    let uploaded = GpuVolume::upload(gpu, volume, &mut |_, _| {}).unwrap();
    let kernels = SkipKernels::new(gpu).unwrap();
    let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(4).unwrap()).unwrap();
    let map = builder.map(gpu, parameters, Structure::Distance).unwrap();
    let leap = if leaps { Leap::EmptyBlocks(&map) } else { Leap::Nothing };
    let sources = Sources { volume: &uploaded, gradient_map: None, leap };
    let plain = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
    let layered = renderer.with_layers(gpu, &plain, thresholds).unwrap();
    let mut with = [Target::with_layers(gpu, view.size).unwrap()];
    let mut without = [Target::new(gpu, view.size).unwrap()];
    // Nothing may be left of another view.
    let other = look(DVec3::new(-0.9, 0.2, 1.2), DVec3::ZERO, view.projection, view.size);
    for view in [other, *view] {
        renderer.render(gpu, &layered, &[view], &mut with).unwrap();
        renderer.render(gpu, &plain, &[view], &mut without).unwrap();
    }
    let ([with], [without]) = (with, without);
    (with, without)
}

#[test]
fn they_are_those_of_the_reference() {
    let volume = volume();
    let view = outside();
    on_device(|gpu, renderer| {
        for (name, alpha, shading, sampling_factor, leaps) in [
            ("faint", 0.1, Shading::None, 1.0, true),
            ("dense", 0.9, Shading::None, 2.0, false),
            ("lit", 0.5, Shading::Phong, 1.0, true),
        ] {
            let settings =
                Settings { shading, sampling_factor, ..Settings::new(volume.full_window(), transfer(alpha)) };
            let parameters = CastParameters::new(&settings, &placement(&volume));
            for thresholds in [LayerThresholds::default(), LayerThresholds::new(&[0.3, 0.6]).unwrap()] {
                let (with, without) =
                    cast(gpu, renderer, &volume, (&parameters, leaps), (&view, &thresholds));
                let (with_cast, without_cast) = (with.read(gpu).unwrap(), without.read(gpu).unwrap());
                assert_eq!(with_cast.image, without_cast.image, "{name}");
                let found = with.read_layers(gpu, &view).unwrap().unwrap();
                let (_, twin) = Caster::with_storage(&volume, StorageKind::U8)
                    .cast_emission_absorption(&parameters, &Aids::default(), &view, &thresholds)
                    .unwrap();
                let difference = difference(&found, &twin);
                eprintln!("layers, {name}: {difference:.6}");
                assert!(difference < 5e-4, "{name} {thresholds:?}: {difference}");
                assert!(without.read_layers(gpu, &view).unwrap().is_none());
            }
        }
    });
}

/// Rays in several dispatches, each a part of the samples.
#[test]
fn rays_in_parts_have_the_layers_of_whole_rays() {
    let volume = blob_volume([16, 14, 12], spacing([1.0; 3]), VoxelType::U8);
    let view = look(DVec3::new(1.5, 0.3, 0.2), DVec3::ZERO, perspective(0.8, [9, 7]), [9, 7]);
    on_device(|gpu, renderer| {
        let settings = Settings {
            sampling_factor: 700.0,
            early_termination: None,
            ..Settings::new(volume.full_window(), transfer(0.2))
        };
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let thresholds = LayerThresholds::default();
        let (with, _) = cast(gpu, renderer, &volume, (&parameters, true), (&view, &thresholds));
        let found = with.read_layers(gpu, &view).unwrap().unwrap();
        let (_, twin) = Caster::with_storage(&volume, StorageKind::U8)
            .cast_emission_absorption(&parameters, &Aids::default(), &view, &thresholds)
            .unwrap();
        let difference = difference(&found, &twin);
        eprintln!("layers in parts: {difference:.6}");
        assert!(difference < 2e-3, "{difference}");
    });
}

#[test]
fn other_modes_and_too_many_layers_are_refused() {
    let volume = volume();
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let settings = Settings::new(volume.full_window(), transfer(0.3));
        let mut refusal = |mode, thresholds: &[f32]| {
            let parameters = CastParameters::new(&Settings { mode, ..settings.clone() }, &placement(&volume));
            let plain = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
            renderer.with_layers(gpu, &plain, &LayerThresholds::new(thresholds).unwrap()).unwrap_err()
        };
        assert_eq!(refusal(Mode::Mip, &[0.5]), LayersError::Layers(LayerError::Mode(Mode::Mip)));
        assert_eq!(refusal(Mode::Composite, &[0.1, 0.2, 0.3, 0.4, 0.5]), LayersError::Count(5));
    });
}
