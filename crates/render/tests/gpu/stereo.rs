//! Pairs from one cast: the reference eye is a mono cast, the derived eye is close to its own.

use crate::device::on_device;
use crate::scene::*;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Light, Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::stereo::{Epipolar, StereoError};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::{Rig, View};
use wheatstone_core::volume::{Volume, VoxelType, Window};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{
    Form, Gpu, GpuVolume, Leap, PairError, PairMethod, Prepared, Quality, Renderer, Sources, Target,
    TexelFormat,
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

fn pair(middle: &View, eye_distance_m: f64, convergence_m: f64) -> [View; 2] {
    Rig::Stereo { eye_distance_m, convergence_m }.views(middle).try_into().unwrap()
}

fn cast_pair(gpu: &Gpu, renderer: &mut Renderer, prepared: &Prepared, views: [View; 2]) -> [Cast; 2] {
    let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
    let targets = views.map(|view| Target::new(gpu, view.size).unwrap());
    renderer
        .render_pair(gpu, prepared, &epipolar, PairMethod::default(), [&targets[0], &targets[1]])
        .unwrap();
    targets.map(|target| target.read(gpu).unwrap())
}

fn middle(size: [u32; 2], eye: DVec3) -> View {
    look(eye, DVec3::ZERO, perspective(1.0, size), size)
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
            let [reference, derived] = cast_pair(gpu, renderer, &prepared, views);
            let difference = largest_difference(&reference, &own[0]);
            if difference > LARGEST_DIFFERENCE {
                failures.push(format!("{name} {eye_distance_m}: reference eye off by {difference}"));
            }
            let dssim = dssim(&derived, &own[1]);
            if dssim > DERIVED_DSSIM || dssim.is_nan() {
                failures.push(format!("{name} {eye_distance_m}: derived eye DSSIM {dssim}"));
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}

fn dssim(a: &Cast, b: &Cast) -> f64 {
    let [a, b] = [a, b].map(|cast| cast.image.over_background([0.0; 3]));
    compare(&a, &b).unwrap().dssim()
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
        let targets = [left, right].map(|view| Target::new(gpu, view.size).unwrap());
        let refused = renderer.render_pair(
            gpu,
            &prepared,
            &epipolar,
            PairMethod::default(),
            [&targets[0], &targets[1]],
        );
        assert!(matches!(refused, Err(PairError::Mode)), "{refused:?}");
    });
    let turned = View { view_from_world: DAffine3::from_rotation_y(0.1) * right.view_from_world, ..right };
    assert!(matches!(Epipolar::new(&left, &turned), Err(StereoError::Orientation { .. })));
}

/// An opaque plate before an opaque ball: what the reference eye does not see behind the plate's edge is missing.
fn plate_before_ball() -> Volume {
    let dims = [48, 48, 48];
    let value = |x: usize, y: usize, z: usize| {
        let [x, y, z] = [x, y, z].map(|i| i as f64 - 23.5);
        let is_plate = y > 15.0 && y < 19.0 && x < 2.0;
        let is_ball = x * x + (y + 8.0) * (y + 8.0) + z * z < 12.0 * 12.0;
        if is_plate || is_ball { 200 } else { 0 }
    };
    let voxels =
        (0..48).flat_map(|z| (0..48).flat_map(move |y| (0..48).map(move |x| value(x, y, z)))).collect();
    Volume::new(
        wheatstone_core::volume::Grid::centred(dims, [1.0; 3]).unwrap(),
        wheatstone_core::volume::Voxels::U8(voxels),
    )
    .unwrap()
}

#[test]
fn repair_fills_what_the_reference_eye_does_not_see() {
    let volume = plate_before_ball();
    let views = pair(&middle([201, 131], DVec3::new(0.1, 0.05, -1.1)), -0.15, f64::INFINITY);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut settings = settings(&volume, Shading::None);
        settings.early_termination = Some(0.99);
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let own = renderer.render_to_host(gpu, &prepared, &views).unwrap();
        let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
        let mut of = |quality| {
            let targets = views.map(|view| Target::new(gpu, view.size).unwrap());
            let method = PairMethod { quality, ..PairMethod::default() };
            renderer.render_pair(gpu, &prepared, &epipolar, method, [&targets[0], &targets[1]]).unwrap();
            targets.map(|target| target.read(gpu).unwrap())
        };
        let [fast, repaired, again] = [Quality::Fast, Quality::Repaired, Quality::Repaired].map(&mut of);
        let missing = |derived: &Cast| {
            let alphas = |cast: &Cast| cast.image.color.iter().map(|c| c[3]).collect::<Vec<_>>();
            alphas(derived).iter().zip(alphas(&own[1])).filter(|(a, b)| *a + 0.5 < *b).count()
        };
        assert!(missing(&fast[1]) >= 10, "{}", missing(&fast[1]));
        assert_eq!(missing(&repaired[1]), 0);
        let [of_fast, of_repaired] = [&fast, &repaired].map(|pair| dssim(&pair[1], &own[1]));
        assert!(of_repaired < 0.5 * of_fast, "{of_repaired} {of_fast}");
        assert!(largest_difference(&repaired[0], &own[0]) <= LARGEST_DIFFERENCE);
        assert_eq!(largest_difference(&repaired[1], &again[1]), 0.0);
    });
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
        let targets = [left, right].map(|view| Target::new(gpu, view.size).unwrap());
        let method = PairMethod { form: Form::Tiles, quality: Quality::Repaired };
        let refused = renderer.render_pair(gpu, &prepared, &epipolar, method, [&targets[0], &targets[1]]);
        assert!(matches!(refused, Err(PairError::Unrepaired)), "{refused:?}");
    });
}

/// An opaque chequered block that fills its volume: rays leave through its sides.
fn chequered_block() -> Volume {
    let dims = [32, 32, 32];
    let value =
        |x: usize, y: usize, z: usize| if (x / 4 + y / 4 + z / 4).is_multiple_of(2) { 60 } else { 110 };
    let voxels =
        (0..32).flat_map(|z| (0..32).flat_map(move |y| (0..32).map(move |x| value(x, y, z)))).collect();
    Volume::new(
        wheatstone_core::volume::Grid::centred(dims, [1.0; 3]).unwrap(),
        wheatstone_core::volume::Voxels::U8(voxels),
    )
    .unwrap()
}

#[test]
fn repair_finds_faces_and_silhouettes_that_the_box_cuts() {
    let volume = chequered_block();
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut settings = Settings::new(volume.full_window(), transfer(0.9));
        settings.transfer = TransferFunction::ramp(0.0, 0.5).unwrap();
        settings.window = Window::new(0.0, 255.0).unwrap();
        settings.early_termination = Some(0.99);
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let mut failures = Vec::new();
        for (x, eye_distance_m) in
            [(0.4, 0.4), (-0.4, 0.4), (0.4, -0.4), (-0.4, -0.4), (0.6, 0.065), (-0.6, 0.065)]
        {
            let views = pair(&middle([163, 121], DVec3::new(x, 0.1, 1.7)), eye_distance_m, f64::INFINITY);
            let own = renderer.render_to_host(gpu, &prepared, &views).unwrap();
            let epipolar = Epipolar::new(&views[0], &views[1]).unwrap();
            let targets = views.map(|view| Target::new(gpu, view.size).unwrap());
            let method = PairMethod { quality: Quality::Repaired, ..PairMethod::default() };
            renderer.render_pair(gpu, &prepared, &epipolar, method, [&targets[0], &targets[1]]).unwrap();
            let derived = targets[1].read(gpu).unwrap();
            let pixels = derived.image.color.iter().zip(&own[1].image.color);
            let far = pixels.filter(|(a, b)| (a[3] - b[3]).abs() > 0.5).count();
            if far > 0 {
                failures.push(format!("{x} {eye_distance_m}: {far} pixels"));
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}
