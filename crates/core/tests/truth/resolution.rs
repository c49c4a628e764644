//! What must not change the picture: the step, early termination, the way of integrating, the kind of projection.

use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::metrics::compare;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Clip, Mode, Placement, Settings, Shading};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::View;
use wheatstone_core::volume::{Volume, Window};

fn view() -> View {
    let size = [96, 96];
    look(DVec3::new(0.5, 0.35, 0.7), DVec3::ZERO, DVec3::Y, perspective(0.5, size), size)
}

fn volumes() -> Vec<(Phantom, Volume, Window)> {
    [Phantom::Sphere, Phantom::SheppLogan, Phantom::MarschnerLobb, Phantom::Present]
        .into_iter()
        .map(|phantom| {
            let volume = phantom.cube(32).unwrap();
            let window = if phantom == Phantom::MarschnerLobb { unit_window() } else { byte_window() };
            (phantom, volume, window)
        })
        .collect()
}

fn transfers() -> Vec<(&'static str, TransferFunction)> {
    vec![
        ("ramp", TransferFunction::ramp(0.1, 1.0).unwrap()),
        ("faint", white_transfer(&[(0.05, 0.0), (1.0, 0.05)])),
        ("2d", TransferFunction::ramp_2d(0.05, 1.0, 0.01, 0.2).unwrap()),
    ]
}

const SHADINGS: [Shading; 5] = [
    Shading::None,
    Shading::Phong,
    Shading::Shadow,
    Shading::Ambient,
    Shading::Directional { directions: 4 },
];

/// Structures wider than a voxel: what is thinner, two samples per voxel do show better than one.
fn resolved_volumes() -> Vec<(&'static str, Volume, Window)> {
    let blobs = |p: DVec3| {
        let ball = |x: f64, y: f64, z: f64, width: f64| {
            (-(p - DVec3::new(x, y, z)).length_squared() / (width * width)).exp()
        };
        ball(10.0, 12.0, 9.0, 5.0)
            .max(0.7 * ball(22.0, 9.0, 16.0, 7.0))
            .max(0.4 * ball(15.0, 22.0, 20.0, 6.0))
    };
    // A period of 16 voxels.
    let gyroid = |p: DVec3| {
        let p = p * (std::f64::consts::TAU / 16.0);
        0.5 + (p.x.sin() * p.y.cos() + p.y.sin() * p.z.cos() + p.z.sin() * p.x.cos()) / 3.0
    };
    vec![
        ("sphere", Phantom::Sphere.cube(32).unwrap(), byte_window()),
        ("gyroid", volume_of([32, 32, 32], [1.0; 3], gyroid), unit_window()),
        ("blobs", volume_of([32, 30, 24], [1.0, 0.8, 1.6], blobs), unit_window()),
    ]
}

#[test]
fn one_and_two_samples_per_voxel_make_the_same_picture() {
    let mut worst = (0.0, String::new());
    let mut failures = Vec::new();
    for (phantom, volume, window) in resolved_volumes() {
        let mut cases: Vec<(String, Settings)> = Vec::new();
        for (name, transfer) in transfers() {
            for shading in SHADINGS {
                let settings = Settings { shading, ..Settings::new(window, transfer.clone()) };
                cases.push((format!("{phantom} {name} {shading:?}"), settings));
            }
        }
        for mode in [Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay, Mode::Isosurface { isovalue: 0.4 }] {
            let settings = Settings { mode, ..Settings::new(window, grey_transfer()) };
            cases.push((format!("{phantom} {mode:?}"), settings));
        }
        for (case, settings) in cases {
            let once = cast(&volume, &settings, &view());
            let twice = cast(&volume, &Settings { sampling_factor: 2.0, ..settings }, &view());
            let dssim = difference(&once, &twice).dssim();
            if dssim > worst.0 {
                worst = (dssim, case.clone());
            }
            if dssim > tolerance::STEP_DSSIM {
                failures.push(format!("{case}: DSSIM {dssim:.5}"));
            }
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(worst.0 > 1e-9, "pictures that do not depend on samples at all are no test: {worst:?}");
}

#[test]
fn early_termination_changes_nothing_beyond_its_threshold() {
    let mut samples = [0, 0];
    for (phantom, volume, window) in volumes() {
        for (name, transfer) in transfers() {
            let settings = Settings::new(window, transfer);
            let early = cast(&volume, &settings, &view());
            let full = cast(&volume, &Settings { early_termination: None, ..settings }, &view());
            let difference = largest_difference(&early, &full);
            assert!(difference <= tolerance::EARLY_TERMINATION, "{phantom} {name}: {difference}");
            assert!(early.samples <= full.samples, "{phantom} {name}");
            samples = [samples[0] + early.samples, samples[1] + full.samples];
        }
    }
    assert!((samples[0] as f64) < 0.98 * samples[1] as f64, "termination saves something: {samples:?}");
}

#[test]
fn saturated_rays_have_nothing_to_gain() {
    let mut samples = [0, 0];
    for (phantom, volume, window) in volumes() {
        for (name, transfer) in transfers() {
            let settings = Settings { early_termination: None, ..Settings::new(window, transfer) };
            let saturated = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
            let endless = CastParameters { termination_alpha: 2.0, ..saturated.clone() };
            let caster = Caster::new(&volume);
            let [saturated, endless] = [saturated, endless]
                .map(|parameters| caster.cast_exactly(&parameters, &Aids::default(), &[view()]).remove(0));
            let difference = largest_difference(&saturated, &endless);
            assert!(difference <= tolerance::SATURATION, "{phantom} {name}: {difference}");
            samples = [samples[0] + saturated.samples, samples[1] + endless.samples];
        }
    }
    assert!(samples[0] < samples[1], "some rays are saturated: {samples:?}");
}

fn root_mean_square(a: &Cast, b: &Cast) -> f64 {
    10.0_f64.powf(-0.05 * compare(&over_black(a), &over_black(b)).unwrap().psnr_db)
}

#[test]
fn preintegration_equals_post_classification_where_the_transfer_function_is_smooth() {
    for (phantom, volume, window) in volumes() {
        if phantom == Phantom::Present {
            continue; // Thin shells: even a smooth function of them is a spike along the ray.
        }
        let transfer = white_transfer(&[(0.0, 0.0), (1.0, 0.1)]);
        let post = Settings { sampling_factor: 2.0, ..exact_settings(window, transfer) };
        let pre = Settings { preintegrated: true, ..post.clone() };
        let (post, pre) = (cast(&volume, &post, &view()), cast(&volume, &pre, &view()));
        let found = difference(&post, &pre);
        assert!(found.dssim() < 1e-3 && found.max_abs < 0.02, "{phantom}: {found:?}");
    }
}

#[test]
fn preintegration_is_nearer_to_the_truth_at_half_a_sample_per_voxel() {
    // A shell that post-classification steps over: visible for a fiftieth of the value range.
    let spike = white_transfer(&[(0.48, 0.0), (0.5, 0.9), (0.52, 0.0)]);
    for phantom in [Phantom::Sphere, Phantom::MarschnerLobb] {
        let volume = phantom.cube(32).unwrap();
        let window = if phantom == Phantom::MarschnerLobb { unit_window() } else { byte_window() };
        let settings = |preintegrated, sampling_factor| Settings {
            preintegrated,
            sampling_factor,
            ..exact_settings(window, spike.clone())
        };
        let truth = cast(&volume, &settings(false, 16.0), &view());
        let pre = root_mean_square(&truth, &cast(&volume, &settings(true, 0.5), &view()));
        let post = root_mean_square(&truth, &cast(&volume, &settings(false, 0.5), &view()));
        assert!(pre < 0.7 * post, "{phantom}: pre-integrated {pre:.4}, post-classified {post:.4}");
        let fine = root_mean_square(&truth, &cast(&volume, &settings(true, 8.0), &view()));
        assert!(fine < 0.02, "{phantom}: pre-integration at 8 samples per voxel is {fine:.4} off");
    }
}

/// The opacity of one ray along x through a value that rises evenly from 1/64 to 63/64 over 62 voxels: the ends of the
/// volume, where the value does not rise, are cut away.
fn opacity_along_a_ramp(transfer: &TransferFunction, preintegrated: bool, sampling_factor: f32) -> f64 {
    let volume = volume_of([64, 4, 4], [1.0; 3], |p| p.x / 64.0);
    let size = [1, 1];
    // From the low end to the high one.
    let view = look(DVec3::NEG_X, DVec3::ZERO, DVec3::Y, orthographic(1e-3, size), size);
    let plain = exact_settings(unit_window(), transfer.clone());
    let clip = Clip {
        box_lo: DVec3::new(1.0 / 64.0, 0.0, 0.0),
        box_hi: DVec3::new(63.0 / 64.0, 1.0, 1.0),
        plane: None,
    };
    let settings = Settings { preintegrated, sampling_factor, clip, ..plain };
    f64::from(color_at(&cast(&volume, &settings, &view).image, 0, 0)[3])
}

#[test]
fn preintegration_takes_the_whole_ray_and_each_part_of_it_once() {
    // Functions that are seen at one end of the ray only, at both, or everywhere.
    let rising: [(&str, &[(f32, f32)]); 5] = [
        ("rising", &[(0.0, 0.0), (1.0, 0.02)]),
        ("falling", &[(0.0, 0.02), (1.0, 0.0)]),
        ("first twentieth", &[(0.0, 0.1), (0.05, 0.0)]),
        ("last twentieth", &[(0.95, 0.0), (1.0, 0.1)]),
        ("valley", &[(0.0, 0.03), (0.5, 0.0), (1.0, 0.03)]),
    ];
    for (name, opacity) in rising {
        let transfer = white_transfer(opacity);
        let truth = opacity_along_a_ramp(&transfer, false, 16.0);
        for sampling_factor in [0.25, 0.5, 1.0, 3.0] {
            let found = opacity_along_a_ramp(&transfer, true, sampling_factor);
            assert!(
                (found - truth).abs() <= tolerance::PREINTEGRATED_OPACITY,
                "{name} f={sampling_factor}: {found} is not {truth}"
            );
        }
    }
}

#[test]
fn preintegration_sees_what_lies_between_the_samples_of_a_ramp() {
    // A bump of 7 voxels, where four voxels are a step.
    let (mut worst_pre, mut worst_post) = (0.0_f64, 0.0_f64);
    for centre in [0.13, 0.29, 0.4, 0.52, 0.77, 0.91] {
        let transfer = white_transfer(&[(centre - 0.05, 0.0), (centre, 0.2), (centre + 0.05, 0.0)]);
        let truth = opacity_along_a_ramp(&transfer, false, 16.0);
        let error = |preintegrated| (opacity_along_a_ramp(&transfer, preintegrated, 0.25) - truth).abs();
        worst_pre = worst_pre.max(error(true));
        worst_post = worst_post.max(error(false));
    }
    assert!(worst_pre <= 0.05 * worst_post, "pre-integrated {worst_pre:.4}, post-classified {worst_post:.4}");
    assert!(worst_pre <= tolerance::PREINTEGRATED_OPACITY, "{worst_pre:.4}");
}

#[test]
fn a_perspective_from_afar_is_a_parallel_projection() {
    const DISTANCE_M: f64 = 20_000.0;
    const HEIGHT_M: f64 = 0.5;
    let size = [64, 48];
    // No ray from face to face has a whole number of steps, which rounding would make one more or less.
    let towards = DVec3::new(0.47, 0.31, 0.8).normalize_or_zero();
    let far = perspective(2.0 * (0.5 * HEIGHT_M / DISTANCE_M).atan(), size);
    let from_afar = look(towards * DISTANCE_M, DVec3::ZERO, DVec3::Y, far, size);
    let parallel = look(towards, DVec3::ZERO, DVec3::Y, orthographic(HEIGHT_M, size), size);
    for (phantom, volume, window) in volumes() {
        for shading in [Shading::None, Shading::Phong] {
            let transfer = white_transfer(&[(0.1, 0.0), (1.0, 0.3)]);
            let settings = Settings { shading, ..exact_settings(window, transfer) };
            let found =
                difference(&cast(&volume, &settings, &from_afar), &cast(&volume, &settings, &parallel));
            // The rays differ by up to 0.25 m / 20 km of their length: less than a thousandth of a voxel.
            assert!(found.dssim() < 1e-4 && found.max_abs < 0.03, "{phantom} {shading:?}: {found:?}");
        }
    }
}
