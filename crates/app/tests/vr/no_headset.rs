//! Without a headset: a demonstration, and recordings.

use crate::support::{distance, folder, recorded, stand_of, wheatstone};
use glam::{DQuat, DVec3};
use serde_json::Value;
use std::path::Path;
use wheatstone_core::head::Display;
use wheatstone_core::headset::{Demonstration, Recording, Scale, Stand, Tick};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::transfer::Preset;
use wheatstone_core::view::AnatomicalDirection;
use wheatstone_core::volume::Grid;

/// All keys of a row of `bench vr --json`.
const KEYS: [&str; 31] = [
    "canted",
    "checked",
    "depth_layer",
    "draw_ms_first",
    "draw_ms_median",
    "draw_ms_p99",
    "draw_ms_worst",
    "dropped",
    "dssim_covered_moving_mean",
    "dssim_covered_moving_worst",
    "dssim_covered_still_mean",
    "dssim_covered_still_worst",
    "dssim_moving_mean",
    "dssim_moving_worst",
    "dssim_still_mean",
    "dssim_still_worst",
    "ended",
    "eye_method",
    "failures",
    "headset",
    "period_ms",
    "pictures",
    "refreshes",
    "shown",
    "stand",
    "values_under_hands",
    "view",
    "volume",
    "warm_up_ms",
    "warp",
    "warps",
];

fn sides(clip: &Value, side: &str) -> Vec<f64> {
    serde_json::from_value(clip[side].clone()).unwrap()
}

#[test]
fn a_demonstration_ends_where_it_is_to() {
    let folder = folder();
    let bench =
        ["bench", "vr", "sphere.nrrd", "--size", "48x48", "--refresh-hz", "25", "--patient", "--json"];
    let report = wheatstone(folder.path(), &[&bench[..], &["--check-every", "100"]].concat()).json();
    let row = &report["rows"][0];

    let sphere = Phantom::Sphere.cube(24).unwrap();
    let demonstration = Demonstration::new(sphere.grid(), AnatomicalDirection::Superior);
    let outcome = demonstration.outcome();
    let off = distance(&stand_of(row), &outcome.stand);
    assert!(off < 1e-6, "{off}: {} instead of {:?}", row["stand"], outcome.stand);
    let clip = &row["view"]["clip"];
    for (side, wanted) in [("box_lo", outcome.clip.box_lo), ("box_hi", outcome.clip.box_hi)] {
        for (is, wanted) in sides(clip, side).into_iter().zip(wanted.to_array()) {
            assert!((is - wanted).abs() < 1e-6, "{clip}");
        }
    }
    assert!(clip["plane"].is_null());
    assert_eq!(row["failures"], serde_json::json!([]));
    assert_eq!(row["ended"], "the recording is over");

    // The stick has gone to the first preset.
    assert_eq!(outcome.preset_steps, 1);
    let first = Preset::all().next().unwrap().name();
    let by_flag = wheatstone(folder.path(), &[&bench[..], &["--tf", first, "--refreshes", "1"]].concat());
    assert_eq!(row["view"]["transfer"], by_flag.json()["rows"][0]["view"]["transfer"]);
}

/// Side of a cube of values that rise by `RISE` from voxel to voxel along the first axis.
const RISING: usize = 24;
const RISE: f64 = 10.0;

/// Where a ray that comes from outside enters a box, by the slabs that its faces bound; nowhere if it passes by.
fn entry(origin: DVec3, direction: DVec3, [lo, hi]: [DVec3; 2]) -> Option<DVec3> {
    let (a, b) = ((lo - origin) / direction, (hi - origin) / direction);
    let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
    (0.0 <= enters && enters <= leaves).then(|| origin + enters * direction)
}

#[test]
fn hands_point_at_the_values_where_they_meet_the_volume() {
    let folder = folder();
    let header = format!(
        "NRRD0004\ntype: float\ndimension: 3\nsizes: {RISING} {RISING} {RISING}\nencoding: raw\nendian: little\n\n"
    );
    let voxel = |index: usize| ((index % RISING) as f64 * RISE) as f32;
    let voxels = (0..RISING.pow(3)).flat_map(|index| voxel(index).to_le_bytes());
    let file: Vec<u8> = header.into_bytes().into_iter().chain(voxels).collect();
    std::fs::write(folder.path().join("rising.nrrd"), file).unwrap();

    // The face has been dragged, and the stick not yet flicked: everything is still opaque.
    let args = ["bench", "vr", "rising.nrrd", "--size", "32x32", "--patient", "--json", "--tf", "ramp:0..0"];
    let end = ["--refresh-hz", "25", "--refreshes", "240", "--check-every", "1000"];
    let report = wheatstone(folder.path(), &[&args[..], &end].concat()).json();
    let row = &report["rows"][0];

    let grid = Grid::centred([RISING; 3], [1.0; 3]).unwrap();
    let demonstration = Demonstration::new(&grid, AnatomicalDirection::Superior);
    let outcome = demonstration.outcome();
    let placement = outcome.stand.placement(&grid, AnatomicalDirection::Superior);
    let visible = [outcome.clip.box_lo, outcome.clip.box_hi];
    let tick = demonstration.tick_at(9.56, 0.04);
    let mut met = 0;
    for (side, hand) in tick.hands.iter().enumerate() {
        let aim = hand.aim.unwrap();
        let origin = placement.texture_from_world().transform_point3(aim.position_m);
        let direction = placement.texture_from_world().transform_vector3(aim.orientation * DVec3::NEG_Z);
        let value = row["values_under_hands"][side].as_f64();
        let Some(entry) = entry(origin, direction, visible) else {
            assert_eq!(value, None, "hand {side}");
            continue;
        };
        // The first sample is in the middle of the first step, which is no longer than a voxel.
        let sample = entry + 0.5 * direction.normalize_or_zero() / RISING as f64;
        let values = [entry, sample].map(|at| RISE * (at.x * RISING as f64 - 0.5));
        let [least, most] = [values[0].min(values[1]), values[0].max(values[1])];
        let value = value.unwrap();
        assert!((least - 0.01..=most + 0.01).contains(&value), "hand {side}: {value} of {values:?}");
        met += 1;
    }
    assert!(met > 0);
}

#[test]
fn a_report_has_what_is_documented() {
    let folder = folder();
    let args = ["bench", "vr", "sphere.nrrd", "--size", "32x32", "--patient", "--json", "--refreshes", "12"];
    let checks = ["--check-every", "4", "--checks", "2", "--check-pictures", "shown"];
    let report = wheatstone(folder.path(), &[&args[..], &checks].concat()).json();
    assert!(report["device"].is_string());
    let row = report["rows"][0].as_object().unwrap();
    assert!(row.keys().all(|key| KEYS.contains(&key.as_str())), "{:?}", row.keys());
    assert!(KEYS.iter().all(|key| row.contains_key(*key)), "{:?}", row.keys());
    assert_eq!(row["refreshes"], 12);
    assert_eq!(row["ended"], "the session was closed");
    let checked = row["checked"].as_array().unwrap();
    assert_eq!(checked.len(), 4);
    for (index, check) in checked.iter().enumerate() {
        let eye = ["left", "right"][index % 2];
        assert_eq!(check["eye"], eye);
        // What is around it is alike.
        let [whole, covered] = ["dssim", "dssim_covered"].map(|figure| check[figure].as_f64().unwrap());
        assert!(covered >= whole && whole >= 0.0, "{check}");
        let name =
            format!("shown/sphere_volumetric/refresh_{:05}_{eye}.png", check["refresh"].as_u64().unwrap());
        assert_eq!(image::image_dimensions(folder.path().join(name)).unwrap(), (32, 32));
    }
}

#[test]
fn one_cast_shows_both_eyes_what_two_casts_do() {
    let folder = folder();
    let bench = ["bench", "vr", "sphere.nrrd", "--size", "96x96", "--patient", "--json", "--refreshes", "60"];
    let one = wheatstone(folder.path(), &[&bench[..], &["--eye-method", "one-cast"]].concat()).json();
    let two = wheatstone(folder.path(), &[&bench[..], &["--eye-method", "two-casts"]].concat()).json();
    for (report, method) in [(&one, "one_cast"), (&two, "two_casts")] {
        let row = &report["rows"][0];
        assert_eq!((row["eye_method"].as_str(), row["canted"].as_bool()), (Some(method), Some(false)));
        let checked = row["checked"].as_array().unwrap();
        assert!(checked.len() >= 4, "{checked:?}");
        let worst = checked.iter().map(|check| check["dssim"].as_f64().unwrap()).fold(0.0, f64::max);
        assert!(worst < 0.02, "{method}: {checked:?}");
    }
}

/// The demonstration with a sphere, 25 times per second.
fn demonstrated() -> Vec<Tick> {
    let sphere = Phantom::Sphere.cube(24).unwrap();
    let demonstration = Demonstration::new(sphere.grid(), AnatomicalDirection::Superior);
    demonstration.recording(Display::new(25.0).unwrap()).unwrap().ticks().to_vec()
}

fn write_recording(ticks: Vec<Tick>, path: &Path) {
    Recording::new(ticks).unwrap().write(std::fs::File::create(path).unwrap()).unwrap();
}

#[test]
fn canted_displays_get_two_casts_and_that_is_told_once() {
    let folder = folder();
    let mut ticks = demonstrated();
    for tick in &mut ticks {
        let [left, right] = tick.eyes.as_mut().unwrap();
        left.pose.orientation *= DQuat::from_rotation_y(0.1);
        right.pose.orientation *= DQuat::from_rotation_y(-0.1);
    }
    write_recording(ticks, &folder.path().join("canted.jsonl"));

    let vr = ["vr", "sphere.nrrd", "--headset", "none", "--patient", "--json", "--replay", "canted.jsonl"];
    let ends = ["--refreshes", "30"];
    let told = "the displays are canted";
    let run = wheatstone(folder.path(), &[&vr[..], &ends, &["--eye-method", "one-cast"]].concat());
    assert_eq!(run.stderr.matches(told).count(), 1, "{}", run.stderr);
    let report = run.json();
    assert_eq!((report["eye_method"].as_str(), report["canted"].as_bool()), (Some("two_casts"), Some(true)));
    // Two casts that are asked for are nothing to tell of.
    let run = wheatstone(folder.path(), &[&vr[..], &ends].concat());
    assert!(!run.stderr.contains(told), "{}", run.stderr);
}

#[test]
fn eyes_that_walk_into_the_volume_see_it_from_inside() {
    let folder = folder();
    let sphere = Phantom::Sphere.cube(24).unwrap();
    let mut ticks = demonstrated();
    ticks.truncate(120);
    let begin = ticks[0];
    let to_middle_m = {
        let head = begin.between_eyes().unwrap();
        let stand = Stand::before(&head, sphere.grid(), AnatomicalDirection::Superior, Scale::Human);
        stand.pose.position_m - head.position_m
    };
    for (index, tick) in ticks.iter_mut().enumerate() {
        // As far as into the volume, but not to its middle.
        let way = 0.85 * (index as f64 / 60.0).min(1.0);
        let eyes = begin.eyes.unwrap().map(|mut eye| {
            eye.pose.position_m += way * to_middle_m;
            eye
        });
        (tick.eyes, tick.hands) = (Some(eyes), Default::default());
    }
    write_recording(ticks, &folder.path().join("inside.jsonl"));

    let phantom = ["phantom", "shepp-logan", "--size", "24", "-o", "head.nrrd"];
    assert_eq!(wheatstone(folder.path(), &phantom).code, 0);
    let bench = ["bench", "vr", "head.nrrd", "--replay", "inside.jsonl", "--size", "64x64", "--patient"];
    let flags = ["--refresh-hz", "25", "--json", "--check-every", "4", "--checks", "50"];
    let pictures = ["--check-pictures", "shown"];
    let report = wheatstone(folder.path(), &[&bench[..], &flags, &pictures].concat()).json();
    let checked = report["rows"][0]["checked"].as_array().unwrap();
    let last = &checked[checked.len() - 1];
    assert_eq!((&last["refresh"], &last["moves"]), (&120.into(), &false.into()), "{checked:?}");
    assert!(last["dssim_covered"].as_f64().unwrap() <= 0.003, "{last}");
    let corner =
        image::open(folder.path().join("shown/head_volumetric/refresh_00120_left.png")).unwrap().into_luma8();
    assert!(corner.get_pixel(1, 1).0[0] > 40, "the volume does not fill the eye's picture");
}

#[test]
fn what_is_recorded_is_played_back_to_the_same_end() {
    let folder = folder();
    let vr = ["vr", "sphere.nrrd", "--headset", "none", "--patient", "--json"];
    let record = ["--record", "session.jsonl", "--refreshes", "200"];
    let shown = wheatstone(folder.path(), &[&vr[..], &record].concat()).json();
    let recording = recorded(&folder.path().join("session.jsonl"));
    assert_eq!(recording.ticks().len(), 200);

    let replay = ["--replay", "session.jsonl"];
    let played = wheatstone(folder.path(), &[&vr[..], &replay].concat()).json();
    let [shown_stand, played_stand] = [&shown, &played].map(stand_of);
    let sphere = Phantom::Sphere.cube(24).unwrap();
    let demonstration = Demonstration::new(sphere.grid(), AnatomicalDirection::Superior);
    assert!(distance(&shown_stand, demonstration.stand()) > 0.03, "nothing was carried: {shown_stand:?}");
    let off = distance(&shown_stand, &played_stand);
    assert!(off < 1e-6, "{off}: {shown_stand:?} {played_stand:?}");
    assert_eq!(shown["view"], played["view"]);
}

#[test]
fn a_bad_recording_is_refused_with_its_line() {
    let folder = folder();
    let demonstration =
        Demonstration::new(Phantom::Sphere.cube(24).unwrap().grid(), AnatomicalDirection::Superior);
    let recording = demonstration.recording(Display::new(20.0).unwrap()).unwrap();
    let mut text = Vec::new();
    recording.write(&mut text).unwrap();
    let text = String::from_utf8(text).unwrap();
    let mut lines: Vec<_> = text.lines().collect();
    lines[4] = r#"{"time_s": "noon"}"#;
    std::fs::write(folder.path().join("bad.jsonl"), lines.join("\n")).unwrap();
    let args = ["sphere.nrrd", "--headset", "none", "--replay", "bad.jsonl"];
    for command in [&["vr"][..], &["bench", "vr"]] {
        let run = wheatstone(folder.path(), &[command, &args].concat());
        assert_eq!(run.code, 2, "{run:?}");
        let error = run.error();
        assert!(error.contains("bad.jsonl") && error.contains("line 5"), "{error}");
    }
    let flags = ["--tf", "none.json", "--patient", "--refreshes", "1"];
    for command in [&["vr", "--headset", "none"][..], &["bench", "vr"]] {
        let run = wheatstone(folder.path(), &[command, &["sphere.nrrd"], &flags].concat());
        assert_eq!(run.code, 2, "{run:?}");
        assert!(run.error().contains("none.json"));
    }
    let run = wheatstone(folder.path(), &["vr", "--headset", "none", "--replay", "none.jsonl"]);
    assert_eq!(run.code, 2, "{run:?}");
    assert!(run.error().contains("none.jsonl"));
}

#[test]
fn a_bad_volume_is_refused_and_no_recording_is_left() {
    let folder = folder();
    std::fs::write(folder.path().join("bad.nrrd"), "no volume").unwrap();
    let args = ["vr", "bad.nrrd", "--headset", "none", "--record", "session.jsonl"];
    let run = wheatstone(folder.path(), &args);
    assert_eq!(run.code, 2, "{run:?}");
    assert!(run.error().contains("bad.nrrd"));
    let left: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().file_name()).collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn a_recording_without_eyes_ends_when_it_is_told_to() {
    let folder = folder();
    let header = r#"{"wheatstone_recording":1,"units":"s, m, tangents, unit quaternions as x, y, z, w","period_s":0.02,"frusta":[{"left":-1.0,"right":1.0,"down":-1.0,"up":1.0,"near_m":0.01},{"left":-1.0,"right":1.0,"down":-1.0,"up":1.0,"near_m":0.01}]}"#;
    let hand = r#"{"squeeze":0.0,"trigger":0.0,"stick":[0.0,0.0],"menu":false}"#;
    let tick = |time_s: f64| format!(r#"{{"time_s":{time_s},"hands":[{hand},{hand}]}}"#);
    std::fs::write(folder.path().join("blind.jsonl"), format!("{header}\n{}\n{}\n", tick(0.0), tick(8e4)))
        .unwrap();
    let vr = ["vr", "sphere.nrrd", "--headset", "none", "--patient", "--replay", "blind.jsonl", "--json"];
    let report = wheatstone(folder.path(), &[&vr[..], &["--refreshes", "40"]].concat()).json();
    assert_eq!([&report["refreshes"], &report["shown"], &report["dropped"]], [40, 0, 0]);
}
