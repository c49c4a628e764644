//! Layers seen from other poses.

use crate::scene::*;
use glam::{DAffine3, DMat3, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::Image;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::view::{Frustum, Projection, View};
use wheatstone_core::warp::{
    EmissionAbsorption, Layer, LayerThresholds, Medium, VolumetricSettings, WarpError, volumetric,
};

fn warped(layers: &EmissionAbsorption, wanted: &View) -> Image {
    volumetric(layers, &front(), wanted, &VolumetricSettings::default()).unwrap()
}

#[test]
fn the_same_pose_returns_the_picture() {
    for (phantom, settings) in translucent_and_opaque() {
        let (cast, layers) = Scene::new(phantom, &settings).layers(&front(), &LayerThresholds::default());
        let same = warped(&layers, &front());
        assert!(largest_difference(&same, &cast.image) < 1e-3);
        for (found_m, depth_m) in same.depth_m.iter().zip(&cast.image.depth_m) {
            assert!(found_m == depth_m || (found_m - depth_m).abs() < 0.12, "{found_m} {depth_m}");
        }
    }
}

#[test]
fn a_step_aside_is_nearer_to_the_truth() {
    for (phantom, settings) in translucent_and_opaque() {
        let scene = Scene::new(phantom, &settings);
        let (shown, layers) = scene.layers(&front(), &LayerThresholds::default());
        let is_translucent = settings == soft_settings();
        for step_m in [0.01, 0.03, 0.05] {
            let stepped = moved(&front(), DVec3::X * step_m, DMat3::IDENTITY);
            let truth = scene.cast(&stepped);
            let [none, volumetric] =
                [&shown.image, &warped(&layers, &stepped)].map(|image| dssim(image, &truth));
            let most = if is_translucent { 0.15 } else { 0.4 };
            assert!(volumetric < most * none, "{phantom} {step_m}: {none} {volumetric}");
        }
    }
}

#[test]
fn fewer_steps_are_further_from_the_truth_and_no_more_than_what_is_passed_are_taken() {
    let scene = Scene::new(Phantom::Sphere, &soft_settings());
    let (_, layers) = scene.layers(&front(), &LayerThresholds::default());
    let stepped = moved(&front(), DVec3::new(0.2, 0.1, 0.0), DMat3::IDENTITY);
    let truth = scene.cast(&stepped);
    let by =
        |most_steps| volumetric(&layers, &front(), &stepped, &VolumetricSettings { most_steps }).unwrap();
    let [one, four, all] = [1, 4, 32].map(|most_steps| dssim(&by(most_steps), &truth));
    assert!(all < four && four < one, "{one} {four} {all}");
    assert_eq!(by(256), by(4096));
}

#[test]
fn opaque_surfaces_stay_opaque() {
    for phantom in [Phantom::Sphere, Phantom::SolidBox] {
        let scene = Scene::new(phantom, &opaque_settings());
        let (_, layers) = scene.layers(&front(), &LayerThresholds::default());
        for step_m in [-0.05, -0.02, 0.02, 0.05] {
            let stepped = moved(&front(), DVec3::new(step_m, 0.5 * step_m, 0.0), DMat3::IDENTITY);
            let (truth, image) = (scene.cast(&stepped), warped(&layers, &stepped));
            let opaque = truth.color.iter().zip(&image.color).filter(|(truth, _)| truth[3] > 0.999);
            let (count, lost) =
                opaque.fold((0, 0.0), |(count, lost), (_, found)| (count + 1, lost + 1.0 - found[3]));
            // At the edges pixels are interpolated, or come into view.
            assert!(lost < 0.015 * count as f32, "{phantom} {step_m}: {lost} of {count}");
        }
    }
}

#[test]
fn a_turn_is_nearer_to_the_truth() {
    let turned = moved(&front(), DVec3::ZERO, DMat3::from_rotation_y(0.04) * DMat3::from_rotation_z(0.05));
    for (phantom, settings) in translucent_and_opaque() {
        let scene = Scene::new(phantom, &settings);
        let (shown, layers) = scene.layers(&front(), &LayerThresholds::default());
        let truth = scene.cast(&turned);
        let [none, volumetric] = [&shown.image, &warped(&layers, &turned)].map(|image| dssim(image, &truth));
        assert!(volumetric < 0.3 * none, "{phantom}: {none} {volumetric}");
    }
}

#[test]
fn an_eye_may_step_into_the_volume_and_look_back_at_it() {
    let (_, layers) =
        Scene::new(Phantom::Sphere, &soft_settings()).layers(&front(), &LayerThresholds::default());
    let inside = moved(&front(), DVec3::NEG_Z * 1.4, DMat3::IDENTITY);
    let behind = moved(&front(), DVec3::NEG_Z * 2.8, DMat3::from_rotation_y(std::f64::consts::PI));
    let [outer, inner, back] = [front(), inside, behind].map(|wanted| {
        let image = warped(&layers, &wanted);
        assert!(image.color.iter().flatten().all(|channel| (0.0..1.0001).contains(channel)));
        let [.., alpha] = image.color[image.color.len() / 2];
        -f64::from(1.0 - alpha).ln()
    });
    // From the middle of the sphere half of its optical depth is in front; from behind all of it is.
    assert!((inner / outer - 0.5).abs() < 0.05, "{inner} {outer}");
    assert!((back / outer - 1.0).abs() < 0.05, "{back} {outer}");
}

#[test]
fn rays_that_miss_are_transparent() {
    let (_, layers) =
        Scene::new(Phantom::Sphere, &soft_settings()).layers(&front(), &LayerThresholds::default());
    let nothing = Image::transparent(SIZE[0], SIZE[1]);
    let away = moved(&front(), DVec3::ZERO, DMat3::from_rotation_y(3.0));
    let aside = moved(&front(), DVec3::X * 30.0, DMat3::IDENTITY);
    assert_eq!(warped(&layers, &away), nothing);
    assert_eq!(warped(&layers, &aside), nothing);
    let empty = EmissionAbsorption::clear(SIZE, 3).unwrap();
    assert_eq!(warped(&empty, &front()), nothing);
}

#[test]
fn the_same_input_gives_the_same_picture_at_any_size() {
    let (_, layers) =
        Scene::new(Phantom::Present, &soft_settings()).layers(&front(), &LayerThresholds::default());
    let wanted = View { size: [17, 90], ..moved(&front(), DVec3::X * 0.04, DMat3::IDENTITY) };
    let first = warped(&layers, &wanted);
    assert_eq!([first.width, first.height], wanted.size);
    assert_eq!(first, warped(&layers, &wanted));
}

#[test]
fn settings_without_meaning_and_other_layers_are_refused() {
    let layers = EmissionAbsorption::clear(SIZE, 1).unwrap();
    let found = |settings| volumetric(&layers, &front(), &front(), &settings).unwrap_err();
    for most_steps in [0, u32::MAX] {
        let error = found(VolumetricSettings { most_steps });
        assert!(matches!(error, WarpError::Steps { .. }), "{error}");
    }
    let small = EmissionAbsorption::clear([3, 3], 1).unwrap();
    let error = volumetric(&small, &front(), &front(), &VolumetricSettings::default()).unwrap_err();
    assert_eq!(error, WarpError::Mismatch { image: [3, 3], view: SIZE });
}

proptest! {
    #[test]
    fn any_numbers_give_a_picture_or_an_error(
        pose in prop::array::uniform12(prop::num::f64::ANY), sides in prop::array::uniform4(prop::num::f64::ANY),
        span_m in prop::array::uniform2(prop::num::f32::ANY), color in prop::array::uniform4(prop::num::f32::ANY),
    ) {
        let [left, right, down, up] = sides;
        let frustum = Frustum { left, right, down, up, near_m: 0.01, far_m: f64::INFINITY };
        let size = [5, 4];
        let plain = View { size, ..front() };
        let posed = View { view_from_world: DAffine3::from_cols_array(&pose), ..plain };
        let seen_through = View { projection: Projection::Perspective(frustum), ..plain };
        let mut layers = EmissionAbsorption::clear(size, 2).unwrap();
        let [start_m, end_m] = span_m;
        let [r, g, b, absorption_per_m] = color;
        layers.layers_mut().fill(Layer { start_m, end_m, medium: Medium { rgb: [r, g, b], absorption_per_m } });
        for strange in [plain, posed, seen_through] {
            for (shown, wanted) in [(&strange, &plain), (&plain, &strange)] {
                let _ = volumetric(&layers, shown, wanted, &VolumetricSettings::default());
            }
        }
    }
}
