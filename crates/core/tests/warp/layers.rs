//! Layers of emission and absorption against the picture that they are of.

use crate::scene::*;
use glam::{DAffine3, DVec3, DVec4};
use wheatstone_core::reference::Aids;
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::view::View;
use wheatstone_core::warp::{EmissionAbsorption, LayerError, LayerThresholds, MOST_LAYERS};
use wheatstone_core::{phantom::Phantom, view::RayField};

/// The picture that layers composite to.
fn composited(layers: &EmissionAbsorption, view: &View) -> Vec<[f32; 4]> {
    let rays = RayField::new(view, DAffine3::IDENTITY);
    let of_pixel = |(pixel, layers): (usize, &[wheatstone_core::warp::Layer])| {
        let (x, y) = (pixel % view.size[0] as usize, pixel / view.size[0] as usize);
        let metres_per_depth = rays.at(x as f64 + 0.5, y as f64 + 0.5).1.length();
        let over = |front: DVec4, layer: &wheatstone_core::warp::Layer| {
            front + (1.0 - front.w) * layer.color(metres_per_depth)
        };
        layers.iter().fold(DVec4::ZERO, over).as_vec4().to_array()
    };
    layers.layers().chunks(layers.layer_count()).enumerate().map(of_pixel).collect()
}

#[test]
fn they_composite_to_the_cast() {
    let inside = moved(&front(), DVec3::NEG_Z * 1.2, glam::DMat3::IDENTITY);
    for (phantom, settings) in translucent_and_opaque() {
        let scene = Scene::new(phantom, &settings);
        for (view, thresholds) in [
            (front(), LayerThresholds::default()),
            (front(), LayerThresholds::new(&[0.3]).unwrap()),
            (front(), LayerThresholds::new(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8]).unwrap()),
            (inside, LayerThresholds::default()),
        ] {
            let (cast, layers) = scene.layers(&view, &thresholds);
            let exact = scene.caster.cast_exactly(&scene.parameters, &Aids::default(), &[view]).remove(0);
            assert_eq!(cast.image, exact.image);
            assert_eq!(cast.reads, exact.reads);
            let composited = composited(&layers, &view);
            let differences = composited.iter().flatten().zip(exact.image.color.iter().flatten());
            let largest = differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(largest < 1e-4, "{phantom} {thresholds:?} {largest}");
        }
    }
}

#[test]
fn they_follow_each_other_and_begin_with_what_is_visible() {
    let scene = Scene::new(Phantom::Sphere, &soft_settings());
    let (cast, layers) = scene.layers(&front(), &LayerThresholds::default());
    for (color, layers) in cast.image.color.iter().zip(layers.layers().chunks(4)) {
        let filled: Vec<_> = layers.iter().filter(|layer| !layer.is_clear()).collect();
        assert_eq!(filled.is_empty(), color[3] == 0.0);
        assert!(filled.iter().all(|layer| layer.start_m < layer.end_m));
        assert!(filled.windows(2).all(|pair| pair[0].end_m <= pair[1].start_m));
        // The sphere's radius is below 0.5 m: the corners of the volume are empty.
        assert!(filled.first().is_none_or(|layer| layer.start_m > 0.85), "{layers:?}");
    }
}

#[test]
fn other_thresholds_sizes_and_modes_are_refused() {
    let threshold = |opacities: &[f32]| LayerThresholds::new(opacities).unwrap_err();
    assert_eq!(threshold(&[]), LayerError::Count(0));
    assert_eq!(threshold(&[0.5; MOST_LAYERS + 1]), LayerError::Count(MOST_LAYERS + 1));
    for bad in [[0.5, 0.5], [0.5, 0.4], [0.0, 0.5], [-0.1, 0.5], [0.5, 1.1], [f32::NAN, 0.5], [0.5, f32::NAN]]
    {
        assert!(matches!(threshold(&bad), LayerError::Threshold { .. }), "{bad:?}");
    }
    for size in [[0, 4], [4, 0], [u32::MAX, u32::MAX]] {
        let found = EmissionAbsorption::clear(size, 4).unwrap_err();
        assert_eq!(found, LayerError::Size { size, layer_count: 4 });
    }
    assert_eq!(EmissionAbsorption::clear([4, 4], 0).unwrap_err(), LayerError::Count(0));
    assert_eq!(EmissionAbsorption::clear([5, 4], 3).unwrap().memory_bytes(), 5 * 4 * 3 * 24);

    let scene = Scene::new(Phantom::Sphere, &Settings { mode: Mode::Mip, ..soft_settings() });
    let thresholds = LayerThresholds::default();
    let found =
        scene.caster.cast_emission_absorption(&scene.parameters, &Aids::default(), &front(), &thresholds);
    assert_eq!(found.unwrap_err(), LayerError::Mode(Mode::Mip));
}
