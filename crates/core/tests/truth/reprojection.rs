//! The second eye from the first eye's rays: against its own cast, closed formulas, and itself.

use crate::scene::*;
use crate::skipping::{bits, gapped_transfers, map, sparse_volumes};
use crate::tolerance;
use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster, Leap, RayEnd, Reprojection, Splat};
use wheatstone_core::scene::{Clip, ClipPlane, Mode, Placement, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::stereo::{Epipolar, StereoError};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{Frustum, Orbit, Projection, Rig, View};
use wheatstone_core::volume::Volume;

const SIDE: usize = 40;
/// Divisible by nothing that packets, tiles or strips are made of.
const SIZE: [u32; 2] = [127, 61];

const EYE_DISTANCE_M: f64 = 0.065;

/// A volume, one metre long, with what its casts need.
struct Scene {
    volume: Volume,
    parameters: CastParameters,
}

impl Scene {
    fn new(volume: Volume, settings: &Settings) -> Self {
        let longest_mm = volume.grid().size_mm().max_element();
        let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1.0 / longest_mm)));
        let parameters = CastParameters::new(settings, &placement);
        Self { volume, parameters }
    }

    fn phantom(phantom: Phantom, settings: &Settings) -> Self {
        Self::new(phantom.cube(SIDE).unwrap(), settings)
    }

    fn pair(&self, epipolar: &Epipolar, reprojection: Reprojection) -> [Cast; 2] {
        let caster = Caster::new(&self.volume);
        caster.cast_pair(&self.parameters, &Aids::default(), epipolar, reprojection).unwrap()
    }

    /// Both eyes, each by its own rays.
    fn own(&self, epipolar: &Epipolar) -> [Cast; 2] {
        let views = [*epipolar.reference(), *epipolar.derived()];
        let casts = Caster::new(&self.volume).cast_exactly(&self.parameters, &Aids::default(), &views);
        casts.try_into().unwrap()
    }
}

fn eyes(rig: Rig, distance_m: f64, size: [u32; 2]) -> [View; 2] {
    let orbit = Orbit { azimuth_rad: 0.5, elevation_rad: 0.3, distance_m };
    rig.views(&orbit.view(perspective(1.0, size), size)).try_into().unwrap()
}

/// The right eye from the left one, at 1.3 m.
fn to_right(eye_distance_m: f64, convergence_m: f64, size: [u32; 2]) -> Epipolar {
    let [left, right] = eyes(Rig::Stereo { eye_distance_m, convergence_m }, 1.3, size);
    Epipolar::new(&left, &right).unwrap()
}

fn to_left(eye_distance_m: f64, convergence_m: f64, size: [u32; 2]) -> Epipolar {
    let [left, right] = eyes(Rig::Stereo { eye_distance_m, convergence_m }, 1.3, size);
    Epipolar::new(&right, &left).unwrap()
}

/// Skin and bone: a faint shell in one colour, a dense core in another.
fn tissue() -> TransferFunction {
    let color = |at, rgb| ColorPoint { at, rgb };
    let opacity = |at, alpha| OpacityPoint { at, alpha };
    TransferFunction::new(
        vec![color(0.1, [0.9, 0.5, 0.3]), color(0.5, [0.9, 0.9, 0.8]), color(1.0, [0.6, 0.8, 1.0])],
        vec![opacity(0.05, 0.0), opacity(0.3, 0.05), opacity(0.6, 0.1), opacity(1.0, 0.6)],
    )
    .unwrap()
}

fn tissue_settings(shading: Shading) -> Settings {
    Settings { shading, sampling_factor: 2.0, ..exact_settings(byte_window(), tissue()) }
}

const SHADINGS: [Shading; 5] = [
    Shading::None,
    Shading::Phong,
    Shading::Shadow,
    Shading::Ambient,
    Shading::Directional { directions: 3 },
];

fn splat(splat: Splat) -> Reprojection {
    Reprojection { splat, ray_end: RayEnd::Volume }
}

fn rows_of_pixels(cast: &Cast) -> impl Iterator<Item = (usize, [f32; 4])> + '_ {
    cast.image.color.iter().copied().enumerate()
}

#[test]
fn the_reference_eye_sees_what_it_casts_itself() {
    let mut all: Vec<Settings> = SHADINGS.map(tissue_settings).into();
    all.push(Settings { early_termination: Some(0.9), ..tissue_settings(Shading::None) });
    all.push(Settings { preintegrated: true, ..tissue_settings(Shading::None) });
    all.push(Settings { mode: Mode::XRay, ..tissue_settings(Shading::None) });
    let epipolar = to_left(0.1, 1.2, [37, 23]);
    for settings in all {
        let scene = Scene::phantom(Phantom::SheppLogan, &settings);
        let [own, _] = scene.own(&epipolar);
        for splat in [Splat::Nearest, Splat::Linear, Splat::Step] {
            for ray_end in [RayEnd::Volume, RayEnd::Reference, RayEnd::Joint] {
                let [reference, _] = scene.pair(&epipolar, Reprojection { splat, ray_end });
                assert_eq!(bits(&reference), bits(&own), "{splat:?} {ray_end:?} {settings:?}");
            }
        }
    }
}

#[test]
fn the_derived_eye_sees_nearly_what_it_casts_itself_however_it_is_lit() {
    for shading in SHADINGS {
        let scene = Scene::phantom(Phantom::Sphere, &tissue_settings(shading));
        let epipolar = to_right(EYE_DISTANCE_M, f64::INFINITY, SIZE);
        let [_, own] = scene.own(&epipolar);
        for splat in [Splat::Nearest, Splat::Step].map(splat) {
            let dssim = difference(&scene.pair(&epipolar, splat)[1], &own).dssim();
            assert!(dssim < tolerance::DERIVED_DSSIM, "{shading:?} {splat:?}: {dssim}");
        }
    }
}

#[test]
fn eyes_that_are_shaded_from_the_middle_agree_on_what_is_lit() {
    let scene = Scene::phantom(Phantom::Sphere, &tissue_settings(Shading::Phong));
    let rig = Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY };
    let views = eyes(rig, 0.9, SIZE);
    let [from_middle, from_own_eyes] =
        [views, views.map(|view| View { shaded_from: None, ..view })].map(|[left, right]| {
            let epipolar = Epipolar::new(&left, &right).unwrap();
            let [_, own] = scene.own(&epipolar);
            difference(&scene.pair(&epipolar, splat(Splat::Step))[1], &own).dssim()
        });
    assert!(
        from_middle < tolerance::DERIVED_DSSIM && from_middle < 0.2 * from_own_eyes,
        "{from_middle} {from_own_eyes}"
    );
}

#[test]
fn columns_that_share_samples_see_fine_structures() {
    let epipolar = to_right(EYE_DISTANCE_M, f64::INFINITY, [253, 191]);
    for phantom in [Phantom::SheppLogan, Phantom::SolidBox, Phantom::Beetle, Phantom::Present] {
        let scene = Scene::phantom(phantom, &tissue_settings(Shading::None));
        let [_, own] = scene.own(&epipolar);
        let [nearest, linear, step] = [Splat::Nearest, Splat::Linear, Splat::Step]
            .map(|columns| difference(&scene.pair(&epipolar, splat(columns))[1], &own).dssim());
        assert!(linear < 0.5 * tolerance::DERIVED_DSSIM, "{phantom}: {linear}");
        assert!(step < tolerance::DERIVED_DSSIM, "{phantom}: {step}");
        assert!(linear < step && step < nearest, "{phantom}: {linear} {step} {nearest}");
    }
}

/// A dark red shell, nearly opaque, around a bright core: a cube whose colour tells how deep an eye sees into it.
fn shell_around_core() -> Scene {
    let volume = volume_of([SIDE; 3], [1.0; 3], |p| {
        let within = 1.0..SIDE as f64 - 1.0;
        if p.to_array().iter().all(|at| within.contains(at)) { 1.0 } else { 0.5 }
    });
    let transfer = TransferFunction::new(
        vec![ColorPoint { at: 0.6, rgb: [0.4, 0.0, 0.0] }, ColorPoint { at: 0.9, rgb: [1.0; 3] }],
        vec![OpacityPoint { at: 0.5, alpha: 0.99 }],
    );
    Scene::new(volume, &Settings { sampling_factor: 2.0, ..exact_settings(unit_window(), transfer.unwrap()) })
}

#[test]
fn columns_that_share_samples_see_no_deeper_than_the_eye() {
    let scene = shell_around_core();
    // Faces at an angle: of their samples, columns have every share.
    let epipolar = to_right(EYE_DISTANCE_M, f64::INFINITY, SIZE);
    let [_, own] = scene.own(&epipolar);
    let [_, derived] = scene.pair(&epipolar, splat(Splat::Linear));
    let expected = &own.image.color;
    let opaque = |i: usize| expected[i][3] > 0.99;
    let mut faces = 0;
    for (i, color) in rows_of_pixels(&derived) {
        // Not at the edges, which may be a column off.
        if i < 2 || expected.len() <= i + 2 || !(i - 2..=i + 2).all(opaque) {
            continue;
        }
        faces += 1;
        let error = color.iter().zip(expected[i]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(error < tolerance::DERIVED_COLOR, "{i}: {color:?} {:?}", expected[i]);
    }
    assert!(faces > 1000, "{faces}");
}

#[test]
fn either_eye_and_any_convergence_will_do() {
    let scene = Scene::phantom(Phantom::Sphere, &tissue_settings(Shading::None));
    for convergence_m in [0.8, 1.3, 3.0, -2.0] {
        for epipolar in [to_right, to_left].map(|pair| pair(EYE_DISTANCE_M, convergence_m, SIZE)) {
            let [_, own] = scene.own(&epipolar);
            for splat in [Splat::Nearest, Splat::Linear, Splat::Step].map(splat) {
                let dssim = difference(&scene.pair(&epipolar, splat)[1], &own).dssim();
                assert!(dssim < tolerance::DERIVED_DSSIM, "{convergence_m} m {splat:?}: {dssim}");
            }
        }
    }
}

#[test]
fn mirrored_eyes_see_mirrored_pictures() {
    let scene = Scene::phantom(Phantom::Sphere, &tissue_settings(Shading::None));
    let rig = Rig::Stereo { eye_distance_m: 0.1, convergence_m: 1.0 };
    let middle = Orbit { distance_m: 1.3, ..Orbit::default() }.view(perspective(1.0, SIZE), SIZE);
    let [left, right]: [View; 2] = rig.views(&middle).try_into().unwrap();
    let derived = |from, to| {
        let epipolar = Epipolar::new(from, to).unwrap();
        scene.pair(&epipolar, splat(Splat::Nearest))[1].clone()
    };
    let (to_right, to_left) = (derived(&left, &right), derived(&right, &left));
    for (i, color) in rows_of_pixels(&to_right) {
        let width = SIZE[0] as usize;
        let mirrored = to_left.image.color[i / width * width + width - 1 - i % width];
        assert!(color.iter().zip(mirrored).all(|(a, b)| (a - b).abs() < 1e-5), "{i}: {color:?} {mirrored:?}");
    }
}

#[test]
fn a_box_is_as_opaque_as_the_derived_eye_s_way_through_it() {
    const ALPHA: f32 = 0.05;
    let settings = exact_settings(unit_window(), constant_transfer([1.0; 3], ALPHA));
    let scene = Scene::new(volume_of([SIDE; 3], [1.0; 3], |_| 0.5), &settings);
    let half = DVec3::splat(0.5);
    for convergence_m in [f64::INFINITY, 1.3] {
        let epipolar = to_right(EYE_DISTANCE_M, convergence_m, SIZE);
        let view = epipolar.derived();
        let expected = |x: u32, y| {
            let ray = world_ray(view, x, y);
            let (near, far) = depths_within(view, ray, &box_sides(-half, half));
            let voxel_lengths = (far - near) * ray.1.length() * SIDE as f64;
            1.0 - f64::from(1.0 - ALPHA).powf(voxel_lengths)
        };
        for (columns, most) in [
            (Splat::Nearest, tolerance::DERIVED_OPACITY_OF_WHOLE_SAMPLES),
            (Splat::Linear, tolerance::DERIVED_OPACITY),
            (Splat::Step, tolerance::DERIVED_OPACITY),
        ] {
            let [_, derived] = scene.pair(&epipolar, splat(columns));
            let (mut sum, mut worst) = (0.0, 0.0_f64);
            for (x, y) in pixels(view) {
                let at = expected(x, y);
                let error = (f64::from(color_at(&derived.image, x, y)[3]) - at).abs();
                // Samples are up to a column off.
                let beside = [x.saturating_sub(1), x + 1].map(|x| (expected(x, y) - at).abs());
                sum += error;
                worst = worst.max(error - beside[0].max(beside[1]));
            }
            let mean = sum / f64::from(SIZE[0] * SIZE[1]);
            assert!(mean < tolerance::DERIVED_MEAN_OPACITY, "{columns:?}: {mean}");
            assert!(worst < most, "{columns:?}: {worst}");
        }
    }
}

#[test]
fn eyes_too_close_together_to_differ_see_the_same_bits() {
    let scene = Scene::phantom(Phantom::SheppLogan, &tissue_settings(Shading::Phong));
    for eye_distance_m in [0.0, 1e-4] {
        let epipolar = to_right(eye_distance_m, f64::INFINITY, SIZE);
        assert_eq!(epipolar.slabs().between(0.4, f64::INFINITY).layers(), 1);
        for splat in [Splat::Nearest, Splat::Step].map(splat) {
            let [reference, derived] = scene.pair(&epipolar, splat);
            assert_eq!(bits(&reference), bits(&derived));
        }
    }
}

#[test]
fn eyes_in_the_volume_see_it_around_them() {
    let faint = white_transfer(&[(0.1, 0.0), (1.0, 0.05)]);
    let settings = Settings { sampling_factor: 2.0, ..exact_settings(byte_window(), faint) };
    let scene = Scene::phantom(Phantom::SheppLogan, &settings);
    let [left, right] =
        eyes(Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY }, 0.3, SIZE);
    let epipolar = Epipolar::new(&left, &right).unwrap();
    let [reference, own] = scene.own(&epipolar);
    let [nearest, step] = [Splat::Nearest, Splat::Step].map(|columns| {
        let [also_reference, derived] = scene.pair(&epipolar, splat(columns));
        assert_eq!(bits(&reference), bits(&also_reference));
        difference(&derived, &own).dssim()
    });
    // Near the eye, steps are longer than slabs: whole samples leave columns out.
    assert!(step < tolerance::INSIDE_DSSIM && step < 0.25 * nearest, "{step} {nearest}");
}

#[test]
fn x_rays_add_up() {
    for phantom in [Phantom::SheppLogan, Phantom::Sphere] {
        let settings = Settings { mode: Mode::XRay, ..exact_settings(byte_window(), grey_transfer()) };
        let scene = Scene::phantom(phantom, &settings);
        let epipolar = to_right(EYE_DISTANCE_M, 1.3, SIZE);
        let [_, own] = scene.own(&epipolar);
        for splat in [Splat::Nearest, Splat::Linear, Splat::Step].map(splat) {
            let dssim = difference(&scene.pair(&epipolar, splat)[1], &own).dssim();
            assert!(dssim < tolerance::DERIVED_DSSIM, "{phantom} {splat:?}: {dssim}");
        }
    }
}

/// A bright wall behind a dark opaque board: beside the board, each eye sees wall that the other does not.
fn board_before_wall() -> Scene {
    let volume = volume_of([SIDE; 3], [1.0; 3], |p| {
        let is_board = (30.0..33.0).contains(&p.z) && (15.0..25.0).contains(&p.x);
        if is_board {
            0.5
        } else if p.z < 6.0 {
            1.0
        } else {
            0.0
        }
    });
    let transfer = TransferFunction::new(
        vec![ColorPoint { at: 0.6, rgb: [0.2, 0.1, 0.1] }, ColorPoint { at: 0.9, rgb: [1.0; 3] }],
        vec![OpacityPoint { at: 0.3, alpha: 0.0 }, OpacityPoint { at: 0.5, alpha: 0.9 }],
    );
    let early_termination = Some(0.99);
    let settings = Settings {
        early_termination,
        sampling_factor: 2.0,
        ..exact_settings(unit_window(), transfer.unwrap())
    };
    Scene::new(volume, &settings)
}

#[test]
fn joint_ends_of_rays_fill_what_the_reference_eye_does_not_see() {
    let scene = board_before_wall();
    let rig = Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY };
    let middle = Orbit { distance_m: 1.0, ..Orbit::default() }.view(perspective(1.0, SIZE), SIZE);
    let [left, right]: [View; 2] = rig.views(&middle).try_into().unwrap();
    let epipolar = Epipolar::new(&left, &right).unwrap();
    let [_, own] = scene.own(&epipolar);
    let [volume, alone, joint] = [RayEnd::Volume, RayEnd::Reference, RayEnd::Joint]
        .map(|ray_end| scene.pair(&epipolar, Reprojection { ray_end, ..Reprojection::default() }));
    let opaque: Vec<bool> = own.image.color.iter().map(|c| c[3] > 0.9).collect();
    // Not at the edges of what is opaque, which may be a column off.
    let black = |pair: &[Cast; 2]| {
        let color = &pair[1].image.color;
        (1..color.len() - 1).filter(|&i| opaque[i - 1..=i + 1] == [true; 3] && color[i][3] < 0.5).count()
    };
    assert!(black(&alone) > 40, "{}", black(&alone));
    assert_eq!(black(&joint), 0);
    for eye in [0, 1] {
        assert_eq!(bits(&joint[eye]), bits(&volume[eye]));
    }
    let samples = |pair: &[Cast; 2]| pair[0].samples + pair[1].samples;
    assert!(samples(&alone) < samples(&joint) && samples(&joint) < samples(&volume));
}

#[test]
fn what_cannot_be_derived_is_refused() {
    let epipolar = to_right(EYE_DISTANCE_M, f64::INFINITY, [8, 8]);
    let settings = Settings { mode: Mode::Mip, ..tissue_settings(Shading::None) };
    let scene = Scene::phantom(Phantom::Sphere, &settings);
    let refused = |scene: &Scene, epipolar: &Epipolar| {
        let caster = Caster::new(&scene.volume);
        caster.cast_pair(&scene.parameters, &Aids::default(), epipolar, Reprojection::default()).err()
    };
    assert_eq!(refused(&scene, &epipolar), Some(StereoError::Mode(Mode::Mip)));

    let rig = Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY };
    let [left, right] = eyes(rig, 0.1, [8, 8]).map(|view| {
        let Projection::Perspective(frustum) = view.projection else { unreachable!() };
        View { projection: Projection::Perspective(Frustum { near_m: 0.0, ..frustum }), ..view }
    });
    let epipolar = Epipolar::new(&left, &right).unwrap();
    let scene = Scene::phantom(Phantom::Sphere, &tissue_settings(Shading::None));
    assert!(matches!(refused(&scene, &epipolar), Some(StereoError::Columns { .. })));
}

fn pairs() -> impl Strategy<Value = Epipolar> {
    let size = prop::array::uniform2(1_u32..30);
    let convergence_m = prop_oneof![Just(f64::INFINITY), 0.05..2.0_f64];
    let eye = prop::array::uniform3(-0.1..0.1_f64);
    let towards = prop::sample::select(vec![DVec3::NEG_Z, DVec3::X, DVec3::new(0.3, -0.4, 1.0)]);
    (eye, towards, prop_oneof![Just(0.0), 0.1..0.5_f64], 0.0..0.2_f64, convergence_m, prop::bool::ANY, size)
        .prop_map(|(eye, towards, distance, eye_distance_m, convergence_m, swaps, size)| {
            // In the volume, or before it.
            let eye = DVec3::from(eye) - distance * towards;
            let middle = look(eye, eye + towards, DVec3::Y, perspective(0.9, size), size);
            let [mut left, mut right]: [View; 2] =
                Rig::Stereo { eye_distance_m, convergence_m }.views(&middle).try_into().unwrap();
            for view in [&mut left, &mut right] {
                let Projection::Perspective(frustum) = &mut view.projection else { unreachable!() };
                frustum.near_m = 0.01;
            }
            if swaps { Epipolar::new(&right, &left) } else { Epipolar::new(&left, &right) }.unwrap()
        })
}

fn reprojections() -> impl Strategy<Value = Reprojection> {
    let splat = prop::sample::select(vec![Splat::Nearest, Splat::Linear, Splat::Step]);
    let ray_end = prop::sample::select(vec![RayEnd::Volume, RayEnd::Reference, RayEnd::Joint]);
    (splat, ray_end).prop_map(|(splat, ray_end)| Reprojection { splat, ray_end })
}

fn clips() -> impl Strategy<Value = Clip> {
    let corner = prop::array::uniform3(0.0..1.0_f64);
    let plane = (prop::array::uniform3(-1.0..1.0_f64), -0.05..0.05_f64);
    (corner, prop::option::of(plane), prop::bool::ANY).prop_map(|(lo, plane, is_whole)| Clip {
        box_lo: if is_whole { DVec3::ZERO } else { 0.5 * DVec3::from(lo) },
        box_hi: DVec3::ONE,
        plane: plane.map(|(normal, offset_m)| ClipPlane { normal: normal.into(), offset_m }),
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_reference_eye_leaping_and_joint_ends_change_nothing_whatever_the_pair(
        (volume, kind) in sparse_volumes(4..24_usize), transfer in gapped_transfers(), epipolar in pairs(), clip in clips(),
        reprojection in reprojections(), is_xray in prop::bool::weighted(0.2), preintegrated in any::<bool>(),
        early_termination in prop::option::of(0.5_f32..1.0),
        structure in prop::sample::select(vec![Structure::Distance, Structure::Anisotropic]),
    ) {
        let mode = if is_xray { Mode::XRay } else { Mode::Composite };
        let window = volume.full_window();
        let settings =
            Settings { mode, preintegrated, early_termination, clip, ..Settings::new(window, transfer) };
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
        let caster = Caster::with_storage(&volume, kind);
        let pair = |aids: &Aids<'_>, ray_end| {
            caster.cast_pair(&parameters, aids, &epipolar, Reprojection { ray_end, ..reprojection }).unwrap()
        };
        let [reference, derived] = pair(&Aids::default(), reprojection.ray_end);

        let own = caster.cast_exactly(&parameters, &Aids::default(), &[*epipolar.reference()]).remove(0);
        prop_assert_eq!(bits(&reference), bits(&own));
        for (color, depth_m) in derived.image.color.iter().zip(&derived.image.depth_m) {
            prop_assert!(color.iter().all(|c| c.is_finite() && *c >= 0.0) && color[3] <= 1.0, "{color:?}");
            prop_assert!(*depth_m >= 0.01 && (color[3] > 0.0 || depth_m.is_infinite()), "{color:?} {depth_m}");
        }

        let size = BlockSize::new([4; 3]).unwrap();
        let map = map(&volume, kind, &parameters, None, size, structure);
        let leaping = pair(&Leap::EmptyBlocks(&map).into(), reprojection.ray_end);
        prop_assert_eq!(bits(&leaping[0]), bits(&reference));
        prop_assert_eq!(bits(&leaping[1]), bits(&derived));

        let [volume, joint] = [RayEnd::Volume, RayEnd::Joint].map(|ray_end| pair(&Aids::default(), ray_end));
        prop_assert_eq!(&bits(&joint[1]).1, &bits(&volume[1]).1);
        prop_assert_eq!(bits(&joint[1]), bits(&volume[1]));
        prop_assert!(joint[0].samples <= volume[0].samples && joint[1].samples <= volume[1].samples);
    }
}
