//! Whatever a sample in an empty block is, it cannot be seen; and blocks that hold nothing visible are empty.

use crate::scene::{
    Scene, block_sizes, depths, methods, modes, numbers, scenes, share_of_block, transfers, trilinear,
    windows,
};
use glam::Vec3;
use proptest::prelude::*;
use wheatstone_core::cast::{CastParameters, Classifier};
use wheatstone_core::gradient_map::GradientMap;
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

/// A number in [0, 1] at one of some entries of a table, or so many entries and so many ulps beside it.
#[derive(Debug, Clone)]
struct NearEntry {
    entry: prop::sample::Index,
    entries_beside: f32,
    ulps_beside: i32,
}

impl NearEntry {
    fn value(&self, entries: &[usize], count: usize) -> f32 {
        let entry = if entries.is_empty() { self.entry.index(count) } else { *self.entry.get(entries) };
        let value = (entry as f32 + self.entries_beside) / (count.max(2) - 1) as f32;
        f32::from_bits(value.max(1e-6).to_bits().saturating_add_signed(self.ulps_beside)).clamp(0.0, 1.0)
    }
}

fn near_an_entry() -> impl Strategy<Value = NearEntry> {
    let beside = prop_oneof![2 => Just(0.0_f32), 1 => Just(-1.0), 1 => Just(1.0), 2 => -2.0_f32..2.0];
    (any::<prop::sample::Index>(), beside, -1..=1)
        .prop_map(|(entry, entries_beside, ulps_beside)| NearEntry { entry, entries_beside, ulps_beside })
}

/// Low corner of a block, block units.
fn block_of(occupancy: &Occupancy, index: usize) -> Vec3 {
    let [width, height, _] = occupancy.grid().dims();
    Vec3::from([index % width, index / width % height, index / (width * height)].map(|b| b as f32))
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
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn with_a_gradient_map_too(
        (scene, window, settings) in cases(),
        block_size in block_sizes(),
        (method, depth) in (methods(), depths()),
        shares in prop::collection::vec(prop::array::uniform3(share_of_block()), 4..40),
    ) {
        let parameters = scene.parameters(&Settings { mode: Mode::Composite, preintegrated: false, ..settings });
        let map = GradientMap::new(&scene.volume, scene.kind, method, depth);
        let values = BlockRanges::of_values(&scene.volume, scene.kind, block_size);
        let gradients = BlockRanges::of_gradients(&map, block_size);
        let (scale, offset) = scene.encoding.normalised_from_stored(window);
        let gradient_map = map.normalised_from_code(scale);
        let occupancy = Occupancy::new(
            values.normalised((scale, offset)),
            Some(gradients.normalised(gradient_map)),
            &Visibility::new(&parameters),
        );
        let by_value = occupancy_of(&scene, &parameters, block_size);
        let magnitudes = numbers(map.codes());
        for index in (0..occupancy.occupied().len()).filter(|&index| !occupancy.occupied()[index]) {
            let block = block_of(&occupancy, index);
            for &share in &shares {
                let position = (block + Vec3::from(share)) / occupancy.grid().blocks_from_texture();
                let value = scene.value_at(window, position);
                let code = trilinear(scene.dims(), &magnitudes, position);
                let magnitude = (code * gradient_map.0 as f32).min(1.0);
                let seen = contributes(&parameters, value, value, magnitude);
                prop_assert!(!seen, "block {} at {:?}: {} {}", index, position, value, magnitude);
            }
        }
        for (both, value) in occupancy.occupied().iter().zip(by_value.occupied()) {
            prop_assert!(value >= both, "gradients only empty blocks");
        }
    }

    #[test]
    fn a_sample_that_contributes_is_in_an_occupied_block(
        (scene, window, settings) in cases(),
        block_size in block_sizes(),
        shares in prop::collection::vec((prop::array::uniform6(share_of_block()), 0.0_f32..=1.0), 4..40),
    ) {
        let parameters = scene.parameters(&settings);
        let occupancy = occupancy_of(&scene, &parameters, block_size);
        for index in (0..occupancy.occupied().len()).filter(|&index| !occupancy.occupied()[index]) {
            let block = block_of(&occupancy, index);
            let position = |x: f32, y: f32, z: f32| {
                (block + Vec3::new(x, y, z)) / occupancy.grid().blocks_from_texture()
            };
            for &([x, y, z, x2, y2, z2], gradient) in &shares {
                let [before, sample] = [position(x, y, z), position(x2, y2, z2)];
                let value = scene.value_at(window, sample);
                let seen = contributes(&parameters, scene.value_at(window, before), value, gradient);
                prop_assert!(!seen, "block {:?} at {:?}: {}", block, sample, value);
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
        ends in prop::array::uniform4(near_an_entry()),
    ) {
        let parameters = scene.parameters(&settings);
        let lut = &parameters.lut;
        let is_visible = |column: usize, row: usize| lut.entries()[row * lut.width() + column][3] < 0.0;
        // Entries beside which visible ones begin or end, where it matters how an interval is rounded.
        let (middle_column, middle_row) = lut
            .entries()
            .iter()
            .position(|entry| entry[3] < 0.0)
            .map_or((0, 0), |first| (first % lut.width(), first / lut.width()));
        let columns: Vec<usize> =
            (1..lut.width()).filter(|&c| is_visible(c, middle_row) != is_visible(c - 1, middle_row)).collect();
        let rows: Vec<usize> =
            (1..lut.height()).filter(|&r| is_visible(middle_column, r) != is_visible(middle_column, r - 1)).collect();
        let interval = |edges: &[usize], count: usize, a: &NearEntry, b: &NearEntry| {
            let (a, b) = (a.value(edges, count), b.value(edges, count));
            [a.min(b), a.max(b)]
        };
        let value = interval(&columns, lut.width(), &ends[0], &ends[1]);
        let gradient = interval(&rows, lut.height(), &ends[2], &ends[3]);
        let [lo, hi] = value;
        let entries = |[lo, hi]: [f32; 2], count: usize| {
            let last = (count - 1) as f64;
            (f64::from(lo) * last).floor() as usize..=(f64::from(hi) * last).ceil() as usize
        };
        let any = |mut rows: std::ops::RangeInclusive<usize>| {
            rows.any(|row| entries(value, lut.width()).any(|column| is_visible(column, row)))
        };
        let expected = match (parameters.mode, parameters.classifier) {
            (Mode::Isosurface { isovalue }, _) => lo < isovalue && hi >= isovalue,
            (Mode::Mean | Mode::XRay | Mode::Mip, _) => hi > 0.0,
            (Mode::MinIp, _) => lo < 1.0,
            (Mode::Composite, Classifier::PreIntegrated) => any(entries(value, lut.height())),
            (Mode::Composite, Classifier::ValueGradient) => any(entries(gradient, lut.height())),
            (Mode::Composite, _) => any(0..=0),
        };
        prop_assert_eq!(Visibility::new(&parameters).may_contribute(value, gradient), expected);
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
