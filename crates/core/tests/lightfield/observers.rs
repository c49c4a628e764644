//! LF's experiment: a deep cake of random dots is told from a flat one with two eyes, and not with one still eye.

use crate::scene::display;
use glam::{DAffine3, DVec2, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::observer::Observer;
use wheatstone_core::lightfield::projectors::VirtualViewer;
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

/// A cake that looks alike to an eye on the axis so far away, whatever its depth.
fn cake(seed: u64, half_depth_m: f64, eye_distance_m: f64) -> WeddingCake {
    WeddingCake { seed, size_m: [0.3, 0.225, 0.22], half_depth_m, eye_distance_m, dot_m: 0.02 }
}

/// A display for an eye on the axis of the cakes. Its beams are narrow, and dots large, so that those before and behind the screen are no
/// less sharp than those on it: that alone would tell the deep cake to one eye.
fn on_axis_display() -> ProjectorArray {
    let mut description = display(40, 1.3, SIZE).description().clone();
    description.viewer = VirtualViewer { height_m: 0.0, distance_m: EYE_DISTANCE_M };
    ProjectorArray::new(description).unwrap()
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

/// Radii on the screen between which one eye looks for cues, metres: those of the layers.
const RINGS_M: [f64; 2] = [0.35 * 0.1125, 0.7 * 0.1125];

/// What one eye can go by: of each layer's ring on the screen its brightness, its contrast, and how much it changes to the right and
/// downwards, as it does the more the smaller and sharper its dots are.
fn cues(picture: &RgbImage, screen_size_m: [f64; 2]) -> Vec<f64> {
    let [width, height] = SIZE.map(|side| side as usize);
    let level = |x: usize, y: usize| f64::from(picture.rgb[y * width + x][0]);
    let ring = |x: usize, y: usize| {
        let share = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) / DVec2::from(SIZE.map(f64::from)) - 0.5;
        let radius_m = (share * DVec2::from(screen_size_m)).length();
        RINGS_M.iter().filter(|&&inner_m| radius_m >= inner_m).count()
    };
    let mut sums = [[0.0; 5]; 3];
    for (x, y) in (0..height - 1).flat_map(|y| (0..width - 1).map(move |x| (x, y))) {
        let here = level(x, y);
        let found = [1.0, here, here * here, (level(x + 1, y) - here).abs(), (level(x, y + 1) - here).abs()];
        sums[ring(x, y)].iter_mut().zip(found).for_each(|(sum, value)| *sum += value);
    }
    let of_ring = |[count, sum, squares, right, down]: [f64; 5]| {
        let mean = sum / count;
        [mean, (squares / count - mean * mean).sqrt(), right / count, down / count]
    };
    sums.into_iter().flat_map(of_ring).collect()
}

/// Tells a deep cake from a flat one by cues of one picture: to which of two means they are nearer, in deviations within the classes.
struct NearestMean {
    /// For each cue, by how much more depth it speaks per unit.
    weights: Vec<f64>,
}

impl NearestMean {
    /// From the cues of deep and flat cakes.
    fn learned(seen: &[&[Vec<f64>; 2]]) -> Self {
        let count = seen.len() as f64;
        let weight = |cue: usize| {
            let [deep, flat] =
                [0, 1].map(|class| seen.iter().map(|cues| cues[class][cue]).sum::<f64>() / count);
            let square = |cues: &[Vec<f64>; 2]| (cues[0][cue] - deep).powi(2) + (cues[1][cue] - flat).powi(2);
            (deep - flat) / seen.iter().map(|cues| square(cues)).sum::<f64>().max(1e-12)
        };
        Self { weights: (0..seen[0][0].len()).map(weight).collect() }
    }

    fn depth(&self, cues: &[f64]) -> f64 {
        self.weights.iter().zip(cues).map(|(weight, cue)| weight * cue).sum()
    }
}

/// In how many trials one eye finds the deep cake when it has learned from the other half of the trials.
fn right_with_one_eye(trials: &[[Vec<f64>; 2]]) -> usize {
    let of_half = |half: usize| {
        let (judged, seen): (Vec<_>, Vec<_>) =
            trials.iter().enumerate().partition(|(trial, _)| trial % 2 == half);
        let eye = NearestMean::learned(&seen.into_iter().map(|(_, cues)| cues).collect::<Vec<_>>());
        judged.iter().filter(|(_, [deep, flat])| eye.depth(deep) > eye.depth(flat)).count()
    };
    of_half(0) + of_half(1)
}

/// The cues of a deep and of a flat cake for one still eye, and how deep they look with two, pixels.
fn trial(array: &ProjectorArray, trial: u64, eye_distance_m: f64) -> ([Vec<f64>; 2], [i32; 2]) {
    let observer = Observer { block_px: 7, reach_px: 8 };
    let seen_of = |(class, half_depth_m): (u64, f64)| {
        let seed = 2 * trial + class;
        let images = shown(array, &cake(seed, half_depth_m, eye_distance_m));
        let at = |x_m: f64, noise: u64| glance(&seen(array, &images, x_m), 3 * seed + noise);
        let (left, right) = (at(-HALF_EYE_DISTANCE_M, 0), at(HALF_EYE_DISTANCE_M, 1));
        let cues = cues(&at(0.0, 2), array.description().screen_size_m);
        (cues, observer.depth_px(&left, &right).unwrap())
    };
    let [deep, flat] = [(0, 0.1), (1, 0.01)].map(seen_of);
    ([deep.0, flat.0], [deep.1, flat.1])
}

#[test]
fn two_eyes_tell_a_deep_cake_from_a_flat_one_and_a_still_one_does_not() {
    let array = on_axis_display();
    let (cues, depths_px): (Vec<_>, Vec<_>) =
        (0..TRIALS).map(|number| trial(&array, number, EYE_DISTANCE_M)).unzip();
    let right = depths_px.iter().filter(|[deep, flat]| deep > flat).count();
    assert_eq!(right, TRIALS as usize, "with two eyes");
    // Of 100 fair coins fewer than 36 or more than 64 show heads once in 300 times.
    let right = right_with_one_eye(&cues);
    assert!((36..=64).contains(&right), "{right} of {TRIALS} with one eye");
}

#[test]
fn a_still_eye_tells_a_deep_cake_by_dots_that_are_not_alike() {
    let array = on_axis_display();
    // Dots of all layers are of one size themselves, so that those in front look larger.
    let cues: Vec<_> = (0..40).map(|number| trial(&array, number, 1e6).0).collect();
    let right = right_with_one_eye(&cues);
    assert!(right >= 36, "{right} of 40");
}

#[test]
fn one_eye_that_moves_tells_them_apart() {
    let array = on_axis_display();
    let observer = Observer { block_px: 7, reach_px: 8 };
    for trial in 0..4 {
        let [deep, flat] = [0.1, 0.01].map(|half_depth_m| {
            let images = shown(&array, &cake(trial, half_depth_m, EYE_DISTANCE_M));
            let [before, after] = [-0.03, 0.03].map(|x_m| seen(&array, &images, x_m));
            observer.depth_px(&before, &after).unwrap()
        });
        assert!(deep > flat, "{deep} {flat}");
    }
}

#[test]
fn from_its_eye_a_deep_cake_looks_as_a_flat_one() {
    let array = on_axis_display();
    let screen_size_m = array.description().screen_size_m;
    let eye = Eye::new(DVec3::new(0.0, 0.0, EYE_DISTANCE_M), SIZE).unwrap();
    let pictures = [0.1, 0.01].map(|half_depth_m| {
        let volume = cake(5, half_depth_m, EYE_DISTANCE_M).volume([120, 90, 96]).unwrap();
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
