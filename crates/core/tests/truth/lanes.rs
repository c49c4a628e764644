//! The sixteen f32 lanes against the one f64 lane, in every mode and shading.

use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::reference::{Aids, Cast, Caster, HeldGradientMap};
use wheatstone_core::scene::{Clip, ClipPlane, GradientMethod, Light, Mode, Placement, Settings, Shading};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{Rig, View};
use wheatstone_core::volume::{StorageKind, Volume};

/// Soft balls in a faint haze; sides that are no multiple of anything.
fn blobs() -> Volume {
    volume_of([23, 31, 27], [1.0, 0.8, 1.3], |p| {
        let ball = |centre: DVec3, width: f64| (-(p - centre).length_squared() / (width * width)).exp();
        let balls = ball(DVec3::new(8.0, 12.0, 9.0), 5.0).max(0.7 * ball(DVec3::new(15.0, 19.0, 17.0), 7.0));
        (balls + 0.06 * (1.0 + (0.5 * p.x).sin() * (0.4 * p.y).cos() * (0.6 * p.z).sin())).min(1.0)
    })
}

fn transfer() -> TransferFunction {
    let color = [(0.0, [0.1, 0.2, 0.6]), (0.5, [0.8, 0.3, 0.3]), (1.0, [1.0, 0.9, 0.5])];
    TransferFunction::new(
        color.map(|(at, rgb)| ColorPoint { at, rgb }).to_vec(),
        [(0.15, 0.0), (0.6, 0.3), (1.0, 0.6)].map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec(),
    )
    .unwrap()
}

fn transfer_2d() -> TransferFunction {
    let gradient = [(0.005, 0.0), (0.06, 1.0)].map(|(at, alpha)| OpacityPoint { at, alpha });
    transfer().with_gradient_opacity(gradient.to_vec()).unwrap()
}

/// A picture of an odd size from outside.
fn outside() -> View {
    let size = [61, 47];
    look(DVec3::new(0.4, 0.3, 0.5), DVec3::ZERO, DVec3::Y, perspective(0.7, size), size)
}

/// From within, where rays start between the voxels.
fn inside() -> View {
    let size = [33, 29];
    look(DVec3::new(0.02, 0.03, 0.01), DVec3::X, DVec3::Y, perspective(1.5, size), size)
}

/// The left eye of a pair, which is shaded from the middle.
fn left_eye() -> View {
    Rig::Stereo { eye_distance_m: 0.2, convergence_m: 0.7 }.views(&outside()).remove(0)
}

/// Along an axis.
fn straight() -> View {
    let size = [37, 30];
    look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.3, size), size)
}

fn both(
    volume: &Volume,
    kind: StorageKind,
    settings: &Settings,
    depth: Option<GradientDepth>,
    view: View,
) -> [Cast; 2] {
    let parameters = CastParameters::new(settings, &Placement::new(volume, world_from_patient()));
    let caster = Caster::with_storage(volume, kind);
    let gradient_map =
        depth.map(|depth| HeldGradientMap::new(&GradientMap::new(volume, kind, settings.gradient, depth)));
    let aids = Aids { gradient_map: gradient_map.as_ref(), ..Aids::default() };
    [caster.cast(&parameters, &aids, &[view]), caster.cast_exactly(&parameters, &aids, &[view])]
        .map(|mut casts| casts.remove(0))
}

fn assert_agree(volume: &Volume, kind: StorageKind, settings: &Settings, what: &str) {
    assert_agree_with(volume, kind, settings, None, what);
}

fn assert_agree_with(
    volume: &Volume,
    kind: StorageKind,
    settings: &Settings,
    depth: Option<GradientDepth>,
    what: &str,
) {
    let views =
        [("outside", outside()), ("the left", left_eye()), ("inside", inside()), ("straight", straight())];
    for (from, view) in views {
        let [fast, exact] = both(volume, kind, settings, depth, view);
        let exact_hits = exact.image.depth_m.iter().filter(|d| d.is_finite()).count();
        assert!(exact_hits > 100, "{what} from {from}: only {exact_hits} hits");
        let comparison = difference(&fast, &exact);
        assert!(comparison.dssim() < tolerance::LANES_DSSIM, "{what} from {from}: {comparison:?}");
        let off = |channels: (&[f32; 4], &[f32; 4])| {
            channels.0.iter().zip(channels.1).any(|(a, b)| f64::from((a - b).abs()) > tolerance::LANES_COLOR)
        };
        let pixels = fast.image.color.iter().zip(&exact.image.color);
        let far_off = pixels.filter(|&pair| off(pair)).count() as f64 / exact.image.color.len() as f64;
        assert!(
            far_off <= tolerance::LANES_OTHER_PIXELS,
            "{what} from {from}: {far_off} of the pixels are off"
        );
        let depths = fast.image.depth_m.iter().zip(&exact.image.depth_m);
        let is_other = |(a, b): &(&f32, &f32)| {
            a.is_finite() != b.is_finite() || f64::from(*a - *b).abs() > tolerance::LANES_DEPTH_M
        };
        let other = depths.filter(is_other).count() as f64 / exact_hits as f64;
        assert!(other <= tolerance::LANES_OTHER_PIXELS, "{what} from {from}: {other} of the depths are off");
        let samples = fast.samples.abs_diff(exact.samples) as f64 / exact.samples as f64;
        assert!(samples <= tolerance::LANES_OTHER_PIXELS, "{what} from {from}: samples {samples}");
    }
}

#[test]
fn every_mode_and_storage_agrees() {
    let volume = blobs();
    let modes =
        [Mode::Composite, Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay, Mode::Isosurface { isovalue: 0.4 }];
    for mode in modes {
        for kind in [StorageKind::U8, StorageKind::U16, StorageKind::F32] {
            let settings = Settings { mode, ..exact_settings(volume.full_window(), transfer()) };
            assert_agree(&volume, kind, &settings, &format!("{mode:?} of {kind:?}"));
        }
    }
}

#[test]
fn every_shading_and_classifier_agrees() {
    let volume = blobs();
    let shadings = [
        Shading::None,
        Shading::Phong,
        Shading::Shadow,
        Shading::Ambient,
        Shading::Directional { directions: 7 },
    ];
    let classifiers = [
        ("by value", Mode::Composite, transfer(), false),
        ("by gradient", Mode::Composite, transfer_2d(), false),
        ("pre-integrated", Mode::Composite, transfer(), true),
        ("isosurface", Mode::Isosurface { isovalue: 0.4 }, transfer(), false),
    ];
    for shading in shadings {
        for (name, mode, transfer, preintegrated) in &classifiers {
            for gradient in [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron] {
                let settings = Settings {
                    mode: *mode,
                    shading,
                    gradient,
                    preintegrated: *preintegrated,
                    ..exact_settings(volume.full_window(), transfer.clone())
                };
                assert_agree(
                    &volume,
                    StorageKind::F32,
                    &settings,
                    &format!("{name}, {shading:?}, {gradient:?}"),
                );
            }
        }
    }
}

#[test]
fn gradient_maps_agree() {
    let volume = blobs();
    let gradients = [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron];
    let depths = [GradientDepth::Bits8, GradientDepth::Bits16];
    for (gradient, depth) in gradients.into_iter().flat_map(|gradient| depths.map(|depth| (gradient, depth)))
    {
        for (kind, shading) in [(StorageKind::U8, Shading::Phong), (StorageKind::F32, Shading::Shadow)] {
            let settings =
                Settings { shading, gradient, ..exact_settings(volume.full_window(), transfer_2d()) };
            let what = format!("{gradient:?}, {depth:?}, {kind:?}, {shading:?}");
            assert_agree_with(&volume, kind, &settings, Some(depth), &what);
        }
    }
}

/// Magnitudes between voxels are interpolated ones, which are not those of interpolated gradients, but near them.
#[test]
fn a_gradient_map_shows_what_estimates_show() {
    let volume = blobs();
    let settings = exact_settings(volume.full_window(), transfer_2d());
    let of = |depth| both(&volume, StorageKind::F32, &settings, depth, outside())[1].clone();
    let [estimated, bits_8, bits_16] =
        [None, Some(GradientDepth::Bits8), Some(GradientDepth::Bits16)].map(of);
    assert!(difference(&bits_16, &estimated).dssim() < tolerance::GRADIENT_MAP_DSSIM);
    assert!(difference(&bits_8, &bits_16).dssim() < tolerance::GRADIENT_CODES_DSSIM);
    assert!(difference(&bits_16, &estimated).max_abs > 0.0, "the map is not read");
    assert!(difference(&bits_8, &bits_16).max_abs > 0.0, "the map's own codes are not read");
}

#[test]
fn clipping_early_termination_and_light_agree() {
    let volume = blobs();
    let settings = Settings {
        shading: Shading::Phong,
        light: Light::Directional(glam::Vec3::new(0.3, 1.0, 0.2)),
        early_termination: Some(0.9),
        sampling_factor: 1.7,
        clip: Clip {
            box_lo: DVec3::new(0.1, 0.0, 0.2),
            plane: Some(ClipPlane { normal: DVec3::new(1.0, 0.4, -0.3), offset_m: -0.05 }),
            ..Clip::default()
        },
        ..Settings::new(volume.full_window(), transfer())
    };
    assert_agree(&volume, StorageKind::F32, &settings, "clipped");
}
