//! A projector is found from what its beams pass, and what remains is corrected by tables.

use crate::scene::display;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::ProjectorArray;
use wheatstone_core::lightfield::calibration::{
    ColorTable, Correction, CorrectionError, Corrections, Correspondence, Fit, GeometryWarp, MeasuredBeam,
    MeasuredProjector, Measurements,
};
use wheatstone_core::lightfield::projectors::{ImageRect, Projector};

const SIZE: [u32; 2] = [320, 240];

/// What a projector's beams pass at three depths, with an error of so many metres to each side.
fn measured(projector: &Projector, error_m: f64) -> Vec<Correspondence> {
    measured_at([-0.1, 0.0, 0.15], projector, error_m)
}

fn measured_at(depths_m: [f64; 3], projector: &Projector, error_m: f64) -> Vec<Correspondence> {
    let mut found = Vec::new();
    for z in depths_m {
        for (i, j) in (0..6).flat_map(|j| (0..8).map(move |i| (i, j))) {
            let pixel = DVec2::new(f64::from(i) * 45.0 + 2.5, f64::from(j) * 47.0 + 2.5);
            let screen_m = projector.screen_m(pixel, SIZE).extend(0.0);
            let emitter = projector.emitter();
            let passed = emitter + (screen_m - emitter) * ((z - emitter.z) / -emitter.z);
            // As good as random, and without a mean.
            let phase = f64::from(i * 7 + j * 13) + 100.0 * z;
            found.push(Correspondence {
                pixel,
                place_m: passed + error_m * DVec3::new((phase * 2.4).sin(), (phase * 3.7).cos(), 0.0),
            });
        }
    }
    found
}

fn most(a: &Projector, b: &Projector) -> f64 {
    let numbers = |p: &Projector| {
        let ImageRect { left_m, right_m, down_m, up_m } = p.image;
        [p.emitter_m.to_vec(), vec![left_m, right_m, down_m, up_m]].concat()
    };
    numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn displaced_projectors_are_found_mirrored_ones_with_them(index in 0_usize..96, moved in prop::array::uniform3(-0.05_f64..0.05), grown in -0.01_f64..0.01) {
        let paper = ProjectorArray::of_paper();
        let guess = paper.projectors()[index];
        let [x, y, z] = guess.emitter_m;
        let ImageRect { left_m, right_m, down_m, up_m } = guess.image;
        let true_one = Projector {
            emitter_m: [x + moved[0], y + moved[1], z + moved[2]],
            image: ImageRect { left_m: left_m * (1.0 + grown), right_m: right_m + grown, down_m, up_m: up_m - grown },
            ..guess
        };
        let fit = Fit::of(&guess, SIZE, &measured(&true_one, 0.0)).unwrap();
        prop_assert!(most(&fit.projector, &true_one) < 1e-7, "{:?} {:?}", fit, true_one);
        prop_assert!(fit.worst_m < 1e-8);
        let reversed = |p: &Projector| p.image.left_m > p.image.right_m;
        prop_assert_eq!(reversed(&fit.projector), reversed(&guess));
        // Errors of a tenth of a millimetre leave a residual of as much, and an emitter that is nearly right.
        let fit = Fit::of(&guess, SIZE, &measured(&true_one, 1e-4)).unwrap();
        prop_assert!(fit.rms_m > 0.5e-4 && fit.rms_m < 1.1e-4 && fit.worst_m < 2e-4, "{:?}", fit);
        prop_assert!(most(&fit.projector, &true_one) < 3e-3, "{:?} {:?}", fit, true_one);
    }
}

#[test]
fn a_mirrored_projector_is_what_a_mirror_shows() {
    let aimed = Projector {
        id: 3,
        emitter_m: [0.2, 0.05, -1.0],
        image: ImageRect { left_m: 0.4, right_m: 0.8, down_m: -0.15, up_m: 0.15 },
    };
    let seen = aimed.reflected(0.3, 4);
    assert_eq!(seen.id, 4);
    assert!((seen.emitter_m[0] - 0.4).abs() < 1e-12 && seen.emitter_m[2] == -1.0);
    assert!((seen.image.left_m - 0.2).abs() < 1e-12 && (seen.image.right_m + 0.2).abs() < 1e-12);
    assert!(most(&seen.reflected(0.3, 3), &aimed) < 1e-12);
    for pixel in [DVec2::new(0.0, 0.0), DVec2::new(17.0, 200.0)] {
        let (at, reflected) = (aimed.screen_m(pixel, SIZE), seen.screen_m(pixel, SIZE));
        assert!((0.6 - at.x - reflected.x).abs() < 1e-12 && at.y == reflected.y);
        assert!((seen.pixel(reflected, SIZE) - pixel).length() < 1e-9);
    }
}

#[test]
fn what_tells_too_little_gives_one_clear_error() {
    let guess = display(8, 2.0, SIZE).projectors()[4];
    let all = measured(&guess, 0.0);
    let fault = |measured: &[Correspondence]| Fit::of(&guess, SIZE, measured).unwrap_err().to_string();
    assert_eq!(fault(&all[..3]), "3 correspondences: at least 4 are needed");
    let undetermined = "the correspondences do not determine the projector: pixels of different columns and of different rows at each \
                        of two depths do";
    let of = |measured: &[Correspondence], is_one: &dyn Fn(&Correspondence) -> bool| -> Vec<Correspondence> {
        measured.iter().copied().filter(is_one).collect()
    };
    let (is_left, is_top) = (|c: &Correspondence| c.pixel.x < 10.0, |c: &Correspondence| c.pixel.y < 10.0);
    let (on_screen, before) = (&all[48..96], &all[96..]);
    assert_eq!(fault(&all[..48]), undetermined);
    assert_eq!(fault(on_screen), undetermined);
    assert_eq!(fault(&of(&all, &is_top)), undetermined);
    assert_eq!(fault(&of(&all, &is_left)), undetermined);
    // The top row at one depth, the bottom row at another; one beam alone off the screen.
    let is_bottom = |c: &Correspondence| c.pixel.y > 200.0;
    assert_eq!(fault(&[of(on_screen, &is_top), of(before, &is_bottom)].concat()), undetermined);
    assert_eq!(fault(&[on_screen, &all[..1]].concat()), undetermined);
    let mut broken = all.clone();
    broken[7].place_m.x = f64::NAN;
    assert_eq!(fault(&broken), "correspondences[7].place_m[0] is NaN: must be from -1000 to 1000 m");
    let mut far = all.clone();
    far[2].place_m.z = -1e308;
    assert_eq!(fault(&far), "correspondences[2].place_m[2] is -1e308: must be from -1000 to 1000 m");
    let mut outside = all.clone();
    outside[3].pixel.y = 1e9;
    assert_eq!(fault(&outside), "correspondences[3].pixel[1] is 1000000000: must be from -32768 to 32768");
    // Depths that are nearer each other than the places are exact.
    let uncertain = fault(&measured_at([-3e-5, 0.0, 4.5e-5], &guess, 1e-4));
    assert!(uncertain.contains("m with a standard deviation of"), "{uncertain}");
}

#[test]
fn from_other_guesses_the_same_is_found() {
    let true_one = ProjectorArray::of_paper().projectors()[90];
    let [x, y, z] = true_one.emitter_m;
    let all = measured(&true_one, 1e-4);
    let from = |moved: [f64; 3]| {
        let guess = Projector { emitter_m: [x + moved[0], y + moved[1], z + moved[2]], ..true_one };
        Fit::of(&guess, SIZE, &all).unwrap()
    };
    let fit = from([0.0; 3]);
    for moved in [[0.1, -0.08, 0.3], [-0.2, 0.3, -0.7]] {
        assert!(most(&from(moved).projector, &fit.projector) < 1e-6, "{:?} {fit:?}", from(moved));
    }
    // Its deviations are those that it has.
    for axis in 0..3 {
        let (found, true_m) = (fit.projector.emitter_m[axis], true_one.emitter_m[axis]);
        let deviation_m = fit.emitter_deviation_m[axis];
        assert!((found - true_m).abs() < 3.0 * deviation_m, "{axis}: {found}, {true_m} ± {deviation_m}");
        assert!(deviation_m > 1e-5 && deviation_m < 1e-3, "{axis}: ± {deviation_m}");
    }
    assert!(fit.image_deviation_m > 1e-6 && fit.image_deviation_m < 1e-4, "{fit:?}");
}

#[test]
fn one_wrong_place_is_named_and_moves_the_projector_hardly() {
    let true_one = ProjectorArray::of_paper().projectors()[40];
    let mut all = measured(&true_one, 1e-4);
    let without = Fit::of(&true_one, SIZE, &all).unwrap();
    all[100].place_m.x += 0.05;
    let fit = Fit::of(&true_one, SIZE, &all).unwrap();
    assert_eq!(fit.worst, 100);
    assert!((fit.worst_m - 0.05).abs() < 1e-3, "{fit:?}");
    assert!(most(&fit.projector, &without.projector) < 5e-4, "{fit:?} {without:?}");
}

#[test]
fn the_measurements_of_the_documentation_determine_their_projector() {
    let documentation = include_str!("../../../../docs/displays.md");
    let start = documentation.find("{\n  \"wheatstone_measurements\"").unwrap();
    let length = documentation[start..].find("```").unwrap();
    let measurements = Measurements::from_json(&documentation[start..start + length]).unwrap();
    let paper = ProjectorArray::of_paper();
    let from = |id: usize| {
        let mut description = paper.description().clone();
        description.projectors[0] = Projector { id: 0, ..paper.projectors()[id] };
        measurements.fit(&ProjectorArray::new(description).unwrap()).unwrap().fits[0]
    };
    let (fit, other) = (from(48), from(55));
    assert!(most(&fit.projector, &other.projector) < 1e-6, "{fit:?} {other:?}");
    assert!(fit.worst_m < 1e-4 && (fit.projector.emitter_m[2] + 1.0).abs() < 0.01, "{fit:?}");
}

fn smooth() -> RgbImage {
    let level = |i: u32| {
        let (x, y) = (f64::from(i % 40), f64::from(i / 40));
        [(x * 0.2).sin(), (y * 0.15).cos(), 0.3].map(|v| (0.5 + 0.4 * v) as f32)
    };
    RgbImage { width: 40, height: 30, rgb: (0..1200).map(level).collect() }
}

#[test]
fn a_warp_undoes_a_distortion() {
    let size = [40, 30];
    // The lens of the projector shows what is at `p` at `p` moved by up to 2 pixels.
    let distorted = |p: DVec2| p + DVec2::new((p.y * 0.1).sin(), (p.x * 0.08).cos()) * 2.0;
    let ideal = smooth();
    let warp = GeometryWarp::from_fn(41, 31, size, distorted);
    let sent = warp.apply(&ideal);
    let worst = (3..27_u32).flat_map(|y| (3..37_u32).map(move |x| (x, y))).map(|(x, y)| {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        // What is shown at its distorted place is to be what the ideal picture has there.
        let shown = sent.rgb[(y * 40 + x) as usize];
        let wanted = ideal.sample(distorted(pixel)).unwrap_or([0.0; 3]);
        (0..3).map(|c| (shown[c] - wanted[c]).abs()).fold(0.0, f32::max)
    });
    assert!(worst.fold(0.0, f32::max) < 0.01);
    let identity = GeometryWarp::from_fn(2, 2, size, |p| p);
    let same = identity.apply(&ideal);
    assert!(same.rgb.iter().flatten().zip(ideal.rgb.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-6));
    let away = GeometryWarp::from_fn(2, 2, size, |p| p + 100.0);
    assert!(away.apply(&ideal).rgb.iter().flatten().all(|&level| level == 0.0));
}

#[test]
fn tables_are_checked_and_applied() {
    let nodes = vec![[0.0, 0.0]; 4];
    assert_eq!(
        GeometryWarp::new(1, 4, nodes.clone()).unwrap_err().to_string(),
        "a warp of 1x4 nodes: at least 2x2 are needed"
    );
    assert_eq!(
        GeometryWarp::new(2, 3, nodes.clone()).unwrap_err().to_string(),
        "4 positions: 6 nodes need one each"
    );
    let mut broken = nodes.clone();
    broken[2][1] = f64::INFINITY;
    assert_eq!(
        GeometryWarp::new(2, 2, broken).unwrap_err().to_string(),
        "the position of node 2 is not finite"
    );
    let table = |green: Vec<f32>| ColorTable::new([vec![0.0, 1.0], green, vec![1.0, 0.0]]);
    assert_eq!(
        table(vec![0.5]).unwrap_err().to_string(),
        "the green table has 1 entries: at least 2 are needed"
    );
    assert_eq!(
        table(vec![0.0, 2.0]).unwrap_err().to_string(),
        "entry 1 of the green table is 2: must be from 0 to 1"
    );
    assert!(table(vec![0.0, f32::NAN]).is_err());
    let table = table(vec![0.0, 0.2, 1.0]).unwrap();
    let corrected = table.corrected([0.25, 0.75, 0.25]);
    assert!(
        (corrected[0] - 0.25).abs() < 1e-6
            && (corrected[1] - 0.6).abs() < 1e-6
            && (corrected[2] - 0.75).abs() < 1e-6
    );
    assert_eq!(table.corrected([-1.0, 3.0, 1.0]), [0.0, 1.0, 0.0]);
    let text = serde_json::to_string(&table).unwrap();
    assert_eq!(serde_json::from_str::<ColorTable>(&text).unwrap().checked().unwrap(), table);
}

/// What the beams of some projectors of a display pass.
fn measurements_of(display: &ProjectorArray, indices: &[usize]) -> Measurements {
    let projector = |&index: &usize| {
        let projector = &display.projectors()[index];
        let beam =
            |c: Correspondence| MeasuredBeam { pixel: c.pixel.to_array(), place_m: c.place_m.to_array() };
        let correspondences = measured(projector, 0.0).into_iter().map(beam).collect();
        MeasuredProjector { id: projector.id, correspondences }
    };
    Measurements { wheatstone_measurements: 1, projectors: indices.iter().map(projector).collect() }
}

#[test]
fn a_display_is_fitted_projector_by_projector_and_the_others_stay() {
    let designed = display(8, 2.0, SIZE);
    let mut description = designed.description().clone();
    description.projectors[0].emitter_m[0] += 0.004;
    description.projectors[5].image.left_m -= 0.002;
    let built = ProjectorArray::new(description).unwrap();
    let text = serde_json::to_string(&measurements_of(&built, &[5, 0])).unwrap();
    let calibrated = Measurements::from_json(&text).unwrap().fit(&designed).unwrap();
    assert_eq!(calibrated.fits.iter().map(|fit| fit.projector.id).collect::<Vec<_>>(), [5, 0]);
    assert!(calibrated.fits.iter().all(|fit| fit.worst_m < 1e-8));
    for (fitted, built) in calibrated.array.projectors().iter().zip(built.projectors()) {
        assert!(most(fitted, built) < 1e-7, "{fitted:?} {built:?}");
    }
    assert_eq!(calibrated.array.projectors()[3], designed.projectors()[3]);
}

#[test]
fn measurements_and_corrections_that_are_none_give_one_clear_error() {
    let display = display(8, 2.0, SIZE);
    let fault = |measurements: &Measurements| measurements.fit(&display).unwrap_err().to_string();
    let all = measurements_of(&display, &[1, 2]);
    let with = |change: &dyn Fn(&mut Measurements)| {
        let mut changed = all.clone();
        change(&mut changed);
        changed
    };
    assert_eq!(
        fault(&with(&|m| m.projectors[1].id = 77)),
        "projectors[1].id is 77: the display has no projector of that id"
    );
    assert!(fault(&with(&|m| m.projectors[1].id = 1)).contains("ids must differ"));
    let few = fault(&with(&|m| m.projectors[0].correspondences.truncate(2)));
    assert_eq!(few, "projector 1: 2 correspondences: at least 4 are needed");
    let far = fault(&with(&|m| m.projectors[1].correspondences[4].place_m = [1e308, -1e308, 1e308]));
    assert_eq!(far, "projector 2: correspondences[4].place_m[0] is 1e308: must be from -1000 to 1000 m");
    let of_text = |text: &str| Measurements::from_json(text).unwrap_err().to_string();
    assert!(of_text(r#"{"wheatstone_measurements": 2, "projectors": []}"#).contains("version 2"));
    assert!(of_text(r#"{"projectors": []}"#).contains("wheatstone_measurements"));

    let corrections = |text: &str| Corrections::from_json(text, &display).unwrap_err().to_string();
    let of_projectors = |list: &str| format!(r#"{{"wheatstone_corrections": 1, "projectors": [{list}]}}"#);
    assert!(corrections(&of_projectors(r#"{"id": 9}"#)).contains("no projector of that id"));
    assert!(corrections(&of_projectors(r#"{"id": 1}, {"id": 1}"#)).contains("ids must differ"));
    let warp = r#"{"id": 1, "warp": {"columns": 1, "rows": 2, "positions_px": [[0, 0], [1, 1]]}}"#;
    assert!(corrections(&of_projectors(warp)).starts_with("projectors[0].warp: a warp of 1x2 nodes"));
    let table = r#"{"id": 1, "colors": {"red": [0, 2], "green": [0, 1], "blue": [0, 1]}}"#;
    assert!(corrections(&of_projectors(table)).starts_with("projectors[0].colors: entry 1 of the red table"));
    assert!(corrections(&of_projectors(r#"{"id": 1, "colours": 3}"#)).contains("colours"));
}

#[test]
fn corrections_are_each_projectors_own() -> Result<(), CorrectionError> {
    let display = display(8, 2.0, [40, 30]);
    let inverted = ColorTable::new([vec![1.0, 0.0], vec![1.0, 0.0], vec![1.0, 0.0]]).unwrap();
    let shifted = GeometryWarp::from_fn(2, 2, [40, 30], |p| p + DVec2::X);
    let corrections = Corrections {
        wheatstone_corrections: 1,
        projectors: vec![Correction { id: 3, warp: Some(shifted), colors: Some(inverted) }],
    };
    let read = Corrections::from_json(&serde_json::to_string(&corrections).unwrap(), &display)?;
    let ideal = smooth();
    assert_eq!(read.apply(2, ideal.clone()), ideal);
    let corrected = read.apply(3, ideal.clone());
    for (x, y) in [(0, 0), (20, 13), (38, 29)] {
        let (sent, wanted) = (corrected.rgb[y * 40 + x], ideal.rgb[y * 40 + x + 1]);
        assert!((0..3).all(|c| (sent[c] - (1.0 - wanted[c])).abs() < 1e-5), "{x} {y}");
    }
    Ok(())
}
