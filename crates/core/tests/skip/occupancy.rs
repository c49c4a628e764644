//! Whatever a sample in an empty block is, it cannot be seen; and blocks that hold nothing visible are empty.

use crate::scene::{Scene, block_sizes, modes, scenes, share_of_block, transfers, windows};
use glam::Vec3;
use proptest::prelude::*;
use wheatstone_core::cast::{CastParameters, Classifier};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, Visibility};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::volume::{StorageKind, Voxels, Window};

/// Whether a ray that takes the first and then the second of these values within a block gains anything from the second.
fn contributes(parameters: &CastParameters, before: f32, value: f32, gradient: f32) -> bool {
    let is_in = |v: f32| v >= parameters.isovalue;
    match (parameters.mode, parameters.classifier) {
        (Mode::Isosurface { .. }, _) => is_in(before) != is_in(value),
        (Mode::Mean | Mode::XRay | Mode::Mip, _) => value > 0.0,
        (Mode::MinIp, _) => value < 1.0,
        (Mode::Composite, Classifier::PreIntegrated) => parameters.lut.at_2d(before, value)[3] < 0.0,
        (Mode::Composite, Classifier::ValueGradient) => parameters.lut.at_2d(value, gradient)[3] < 0.0,
        (Mode::Composite, _) => parameters.lut.at(value)[3] < 0.0,
    }
}

/// Whether a one-dimensional table shows a value in f64.
fn is_visible_f64(parameters: &CastParameters, value: f64) -> bool {
    let along = value * (parameters.lut.width() - 1) as f64;
    let log2 = |entry: f64| parameters.lut.entries()[entry as usize][3];
    (log2(along.floor()) < 0.0) || (along.fract() > 0.0 && log2(along.ceil()) < 0.0)
}

fn occupancy_of(scene: &Scene, parameters: &CastParameters, block_size: BlockSize) -> Occupancy {
    let ranges = BlockRanges::of_values(&scene.volume, scene.kind, block_size);
    let map = scene.encoding.normalised_from_stored(parameters.window);
    Occupancy::new(ranges.normalised(map), None, &Visibility::new(parameters))
}

fn cases() -> impl Strategy<Value = (Scene, Window, Settings)> {
    let settings = (transfers(), modes(), prop::bool::ANY);
    (scenes(), settings).prop_flat_map(|(scene, (transfer, mode, preintegrated))| {
        windows(&scene).prop_map(move |window| {
            let settings = Settings { mode, preintegrated, ..Settings::new(window, transfer.clone()) };
            (scene.clone(), window, settings)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn a_sample_that_contributes_is_in_an_occupied_block(
        (scene, window, settings) in cases(),
        block_size in block_sizes(),
        shares in prop::collection::vec((prop::array::uniform6(share_of_block()), 0.0_f32..=1.0), 4..40),
    ) {
        let parameters = scene.parameters(&settings);
        let occupancy = occupancy_of(&scene, &parameters, block_size);
        let grid = occupancy.grid();
        let [width, height, _] = grid.dims();
        for (index, &is_occupied) in occupancy.occupied().iter().enumerate().filter(|(_, o)| !**o) {
            let block = [index % width, index / width % height, index / (width * height)].map(|b| b as f32);
            let position = |x: f32, y: f32, z: f32| {
                (Vec3::from(block) + Vec3::new(x, y, z)) / grid.blocks_from_texture()
            };
            for &([x, y, z, x2, y2, z2], gradient) in &shares {
                let [before, sample] = [position(x, y, z), position(x2, y2, z2)];
                let value = scene.value_at(window, sample);
                let seen = contributes(&parameters, scene.value_at(window, before), value, gradient);
                prop_assert!(is_occupied || !seen, "block {:?} at {:?}: {}", block, sample, value);
                if parameters.mode == Mode::Composite && parameters.classifier == Classifier::Value {
                    let seen = is_visible_f64(&parameters, scene.value_at_f64(window, sample));
                    prop_assert!(!seen, "block {:?} at {:?}", block, sample);
                }
            }
        }
    }

    #[test]
    fn the_table_equals_a_search(
        (scene, _, settings) in cases(),
        value in prop::array::uniform2(share_of_block()),
        gradient in prop::array::uniform2(share_of_block()),
    ) {
        let parameters = scene.parameters(&settings);
        let ordered = |[a, b]: [f32; 2]| [a.min(b), a.max(b)];
        let ([lo, hi], gradient) = (ordered(value), ordered(gradient));
        let lut = &parameters.lut;
        let entries = |[lo, hi]: [f32; 2], count: usize| {
            let last = (count - 1) as f32;
            (lo * last).floor() as usize..=(hi * last).ceil() as usize
        };
        let any = |rows: std::ops::RangeInclusive<usize>| {
            rows.flat_map(|row| entries([lo, hi], lut.width()).map(move |column| row * lut.width() + column))
                .any(|entry| lut.entries()[entry][3] < 0.0)
        };
        let expected = match (parameters.mode, parameters.classifier) {
            (Mode::Isosurface { isovalue }, _) => lo < isovalue && hi >= isovalue,
            (Mode::Mean | Mode::XRay | Mode::Mip, _) => hi > 0.0,
            (Mode::MinIp, _) => lo < 1.0,
            (Mode::Composite, Classifier::PreIntegrated) => any(entries([lo, hi], lut.height())),
            (Mode::Composite, Classifier::ValueGradient) => any(entries(gradient, lut.height())),
            (Mode::Composite, _) => any(0..=0),
        };
        prop_assert_eq!(Visibility::new(&parameters).may_contribute([lo, hi], gradient), expected);
    }
}

#[test]
fn blocks_without_anything_visible_are_empty() {
    let dims = [16, 8, 8];
    let voxels = |i: usize| if i % 16 < 6 { 0 } else { 255 };
    let scene = Scene::new(dims, Voxels::U8((0..16 * 64).map(voxels).collect()));
    let fraction = |settings: Settings| {
        occupancy_of(&scene, &scene.parameters(&settings), BlockSize::cube(2).unwrap()).fraction()
    };
    let window = scene.volume.full_window();
    let shown = |transfer: TransferFunction| Settings::new(window, transfer);
    let ramp = |lo, hi| TransferFunction::ramp(lo, hi).unwrap();
    // Blocks 0 and 1 of 8 hold zeros and read zeros; block 2 reads voxel 6; blocks 4 and on are full.
    assert_eq!(fraction(shown(ramp(0.0, 1.0))), 6.0 / 8.0);
    assert_eq!(fraction(shown(ramp(2.0, 3.0))), 0.0);
    let preintegrated = Settings { preintegrated: true, ..shown(ramp(0.0, 1.0)) };
    assert_eq!(fraction(preintegrated), 6.0 / 8.0);
    let in_mode = |mode| Settings { mode, ..shown(ramp(0.0, 1.0)) };
    assert_eq!(fraction(in_mode(Mode::Isosurface { isovalue: 0.5 })), 2.0 / 8.0);
    assert_eq!(fraction(in_mode(Mode::Mip)), 6.0 / 8.0);
    assert_eq!(fraction(in_mode(Mode::MinIp)), 4.0 / 8.0);
}

#[test]
fn what_lies_between_two_clear_values_is_seen() {
    let dims = [4, 4, 4];
    let scene = Scene::new(dims, Voxels::U8((0..64).map(|i| if i % 4 < 2 { 0 } else { 255 }).collect()));
    let spike = [(0.4, 0.0), (0.5, 1.0), (0.6, 0.0)]
        .map(|(at, alpha)| wheatstone_core::transfer::OpacityPoint { at, alpha });
    let color = wheatstone_core::transfer::ColorPoint { at: 0.0, rgb: [1.0; 3] };
    let transfer = TransferFunction::new(vec![color], spike.to_vec()).unwrap();
    let parameters = scene.parameters(&Settings::new(scene.volume.full_window(), transfer));
    let occupancy = occupancy_of(&scene, &parameters, BlockSize::cube(4).unwrap());
    assert_eq!(occupancy.occupied(), [true]);
}

#[test]
fn most_of_a_phantom_is_empty() {
    let volume = Phantom::Beetle.volume([64, 64, 40]).unwrap();
    let settings = Settings::new(volume.full_window(), TransferFunction::ramp(0.086, 1.0).unwrap());
    let voxels = volume.voxels().clone();
    let scene = Scene::new([64, 64, 40], voxels);
    assert_eq!(scene.kind, StorageKind::U8);
    let occupancy = occupancy_of(&scene, &scene.parameters(&settings), BlockSize::cube(2).unwrap());
    assert!((0.01..0.5).contains(&occupancy.fraction()), "{}", occupancy.fraction());
}
