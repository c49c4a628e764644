//! LF's experiment: a deep cake of random dots is told from a flat one with two eyes, and not with one still eye.

use crate::scene::display;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::observer::Observer;
use wheatstone_core::lightfield::simulator::Eye;
use wheatstone_core::phantom::WeddingCake;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{Placement, Settings};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};

const SIZE: [u32; 2] = [40, 30];
const DIMS: [usize; 3] = [60, 45, 48];
const EYE_DISTANCE_M: f64 = 0.6;
const HALF_EYE_DISTANCE_M: f64 = 0.0325;
const TRIALS: u64 = 100;

/// Opaque layers, black with white dots.
fn cake_settings() -> Settings {
    let color = vec![ColorPoint { at: 0.49, rgb: [0.0; 3] }, ColorPoint { at: 0.51, rgb: [1.0; 3] }];
    let opacity = [(0.3, 0.95), (0.4, 0.0), (0.6, 0.0), (0.7, 0.95)]
        .map(|(at, alpha)| OpacityPoint { at, alpha })
        .to_vec();
    Settings::new(crate::scene::byte_window(), TransferFunction::new(color, opacity).unwrap())
}

fn cake(seed: u64, half_depth_m: f64) -> WeddingCake {
    WeddingCake {
        seed,
        size_m: [0.3, 0.225, 0.22],
        half_depth_m,
        eye_distance_m: EYE_DISTANCE_M,
        dot_m: 0.01,
    }
}

/// What the display shows of a cake.
fn shown(array: &ProjectorArray, cake: &WeddingCake) -> Vec<RgbImage> {
    let volume = cake.volume(DIMS).unwrap();
    let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1e-3)));
    let parameters = CastParameters::new(&cake_settings(), &placement);
    let views = array.views(DAffine3::IDENTITY);
    let casts = Caster::new(&volume).cast(&parameters, &Aids::default(), &views);
    casts.iter().map(|cast| cast.image.over_background([0.0; 3])).collect()
}

fn seen(array: &ProjectorArray, images: &[RgbImage], x_m: f64) -> RgbImage {
    let viewer = array.description().viewer;
    array
        .seen_from(&Eye::new(DVec3::new(x_m, viewer.height_m, EYE_DISTANCE_M), SIZE).unwrap(), images)
        .unwrap()
}

/// A glance: what is seen, with noise of its own, a fiftieth of white.
fn glance(picture: &RgbImage, seed: u64) -> RgbImage {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut noise = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 40) as f32 / (1 << 24) as f32 - 0.5) * 0.04
    };
    RgbImage { rgb: picture.rgb.iter().map(|rgb| rgb.map(|level| level + noise())).collect(), ..*picture }
}

fn coin(trial: u64) -> bool {
    trial.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 37 & 1 == 1
}

/// How deep a cake looks with two eyes, and with one that is still.
fn depths_px(array: &ProjectorArray, observer: Observer, seed: u64, half_depth_m: f64) -> [i32; 2] {
    let images = shown(array, &cake(seed, half_depth_m));
    let at = |x_m: f64| seen(array, &images, x_m);
    let depth = |left: &RgbImage, right: &RgbImage| {
        observer.depth_px(&glance(left, 2 * seed), &glance(right, 2 * seed + 1)).unwrap()
    };
    let still = at(0.0);
    [depth(&at(-HALF_EYE_DISTANCE_M), &at(HALF_EYE_DISTANCE_M)), depth(&still, &still)]
}

#[test]
fn two_eyes_tell_a_deep_cake_from_a_flat_one_and_a_still_one_does_not() {
    let array = display(20, 2.6, SIZE);
    let observer = Observer { block_px: 7, reach_px: 8 };
    let mut right = [0; 2];
    for trial in 0..TRIALS {
        let deep = depths_px(&array, observer, 2 * trial, 0.1);
        let flat = depths_px(&array, observer, 2 * trial + 1, 0.01);
        for eyes in 0..2 {
            // Where both look alike, a coin decides.
            let is_right = if deep[eyes] == flat[eyes] { coin(trial) } else { deep[eyes] > flat[eyes] };
            right[eyes] += u64::from(is_right);
        }
    }
    assert_eq!(right[0], TRIALS);
    // Of 100 fair coins fewer than 36 or more than 64 show heads once in 300 times.
    assert!((36..=64).contains(&right[1]), "{} of {TRIALS} with one eye", right[1]);
}

#[test]
fn one_eye_that_moves_tells_them_apart() {
    let array = display(20, 2.6, SIZE);
    let observer = Observer { block_px: 7, reach_px: 8 };
    for trial in 0..4 {
        let [deep, flat] = [0.1, 0.01].map(|half_depth_m| {
            let images = shown(&array, &cake(trial, half_depth_m));
            let [before, after] = [-0.03, 0.03].map(|x_m| seen(&array, &images, x_m));
            observer.depth_px(&before, &after).unwrap()
        });
        assert!(deep > flat, "{deep} {flat}");
    }
}

#[test]
fn from_its_eye_a_deep_cake_looks_as_a_flat_one() {
    let array = display(20, 2.6, SIZE);
    let screen_size_m = array.description().screen_size_m;
    let eye = Eye::new(DVec3::new(0.0, 0.0, EYE_DISTANCE_M), SIZE).unwrap();
    let pictures = [0.1, 0.01].map(|half_depth_m| {
        let volume = cake(5, half_depth_m).volume([120, 90, 96]).unwrap();
        let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1e-3)));
        let parameters = CastParameters::new(&cake_settings(), &placement);
        let view = eye.view(screen_size_m, DAffine3::IDENTITY);
        Caster::new(&volume)
            .cast(&parameters, &Aids::default(), &[view])
            .remove(0)
            .image
            .over_background([0.0; 3])
    });
    let mean = |picture: &RgbImage| {
        picture.rgb.iter().map(|rgb| f64::from(rgb[0])).sum::<f64>() / picture.rgb.len() as f64
    };
    assert!((mean(&pictures[0]) - 0.5).abs() < 0.12, "{}", mean(&pictures[0]));
    let differ =
        pictures[0].rgb.iter().zip(&pictures[1].rgb).filter(|(a, b)| (a[0] - b[0]).abs() > 0.5).count();
    assert!((differ as f64) < 0.15 * pictures[0].rgb.len() as f64, "{differ} pixels differ");
}

#[test]
fn disparities_are_those_of_shifted_dots() {
    let pattern = |x: i64, y: i64| (((x * 7 + y * 13 + x * y * 3) * 2_654_435_761_i64) >> 12 & 1) as f32;
    let picture = |shift: i64| RgbImage {
        width: 40,
        height: 16,
        rgb: (0..40 * 16).map(|i| [pattern(i % 40 + shift, i / 40); 3]).collect(),
    };
    let observer = Observer { block_px: 6, reach_px: 5 };
    for shift in -4..=4 {
        let found = observer.disparities_px(&picture(0), &picture(shift)).unwrap();
        let right = found.iter().filter(|&&d| i64::from(d) == shift).count();
        assert!(right * 10 > found.len() * 8 && found.len() > 50, "{shift}: {right} of {}", found.len());
    }
    let blank = RgbImage { width: 40, height: 16, rgb: vec![[0.5; 3]; 640] };
    assert_eq!(observer.depth_px(&blank, &blank).unwrap(), 0);
    let small = RgbImage { width: 4, height: 4, rgb: vec![[0.5; 3]; 16] };
    assert!(observer.disparities_px(&small, &small).unwrap().is_empty());
    assert!(observer.depth_px(&blank, &small).is_err());
}
