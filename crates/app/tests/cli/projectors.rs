//! Frames for displays of projectors, and their calibration.

use crate::support::{Bench, Run};
use serde_json::{Value, json};

/// Twelve projectors of 40 × 30 pixels, 4° apart, behind a screen of 0.2 × 0.15 m; the outermost two are seen in mirrors.
pub(crate) fn array() -> Value {
    let projector = |id: u32| {
        let (left_m, right_m) = if id == 0 || id == 11 { (0.1, -0.1) } else { (-0.1, 0.1) };
        let x_m = 2.0 * 0.5 * 2.0_f64.to_radians().tan() * (f64::from(id) - 5.5);
        json!({
            "id": 100 + id,
            "emitter_m": [x_m, 0.0, -0.5],
            "image": { "left_m": left_m, "right_m": right_m, "down_m": -0.075, "up_m": 0.075 },
        })
    };
    json!({
        "wheatstone_projector_array": 1,
        "screen_size_m": [0.2, 0.15],
        "pixel_size_m": 0.005,
        "beam_angle_deg": 4.0,
        "viewer": { "height_m": 0.0, "distance_m": 0.6 },
        "image_size_px": [40, 30],
        "projectors": (0..12).map(projector).collect::<Vec<_>>(),
        "packing": { "frame_size_px": [200, 64], "header_rows": 4 },
    })
}

/// The same display, as seen from its viewer's place, as one view behind a lens.
const AS_ONE_VIEW: [&str; 14] = [
    "--columns",
    "1",
    "--rows",
    "1",
    "--quilt-size",
    "40x30",
    "--aspect",
    "1.3333333",
    "--screen-height",
    "0.15",
    "--focal-distance",
    "0.6",
    "--view-cone",
    "40",
];

fn bench() -> Bench {
    let bench = Bench::new();
    std::fs::write(bench.path("array.json"), array().to_string()).unwrap();
    let run = bench.run(&["phantom", "orientation", "--size", "32", "-o", "o.nrrd"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    bench
}

fn try_projectors(bench: &Bench, output: &str, flags: &[&str]) -> Run {
    let base =
        ["projectors", "o.nrrd", "-o", output, "--display", "array.json", "--backend", "cpu", "--json"];
    bench.run(&[&base[..], flags].concat())
}

fn projectors(bench: &Bench, output: &str, flags: &[&str]) -> Value {
    let run = try_projectors(bench, output, flags);
    assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
    run.json()
}

/// What an eye sees of frames `NAME_0000.png` and `NAME_0001.png`.
fn simulate(bench: &Bench, name: &str, output: &str, eye: &str) {
    let frames = [0, 1].map(|frame| format!("{name}_000{frame}.png"));
    let run = bench.run(&[
        "simulate",
        &frames[0],
        &frames[1],
        "-o",
        output,
        "--display",
        "array.json",
        "--eye",
        eye,
    ]);
    assert_eq!(run.code, 0, "{}", run.stderr);
}

fn dssim(bench: &Bench, a: &str, b: &str) -> f64 {
    bench.run(&["compare", a, b, "--json"]).json()["dssim"].as_f64().unwrap()
}

#[test]
fn the_viewer_sees_the_volume() {
    let bench = bench();
    for look in [
        &["--tf", "ramp:0..1"][..],
        &["--mode", "mip"],
        &["--mode", "xray"],
        &["--tf", "ramp:0..1", "--shading", "phong"],
        &["--tf", "ramp:0..1", "--shading", "style:clay:glass"],
        &["--tf", "ramp:0..1", "--boundaries", "0.2,20,1"],
    ] {
        let turned = [look, &["--volume-size", "0.1", "--before-screen", "0.01", "--azimuth", "30"]].concat();
        let in_full = [&turned[..], &["--resolution", "full"]].concat();
        let report = projectors(&bench, "f.png", &in_full);
        assert_eq!(report["outputs"], json!(["f_0000.png", "f_0001.png"]));
        simulate(&bench, "f", "seen.png", "0,0,0.6");
        let truth = ["quilt", "o.nrrd", "-o", "truth_qs1x1a1.33.png", "--backend", "cpu"];
        let run = bench.run(&[&truth[..], &AS_ONE_VIEW, &turned].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let found = dssim(&bench, "seen.png", "truth_qs1x1a1.33.png");
        assert!(found < 0.02, "{look:?}: {found}");
        simulate(&bench, "f", "beside.png", "0.15,0,0.6");
        let moved = dssim(&bench, "beside.png", "truth_qs1x1a1.33.png");
        assert!(moved > 3.0 * found, "{look:?}: {moved} and {found}");
    }
}

#[test]
fn frames_have_the_ids_of_their_projectors_and_what_is_resolved_is_matched() {
    let bench = bench();
    let run = bench.run(&["phantom", "snake", "--size", "64", "-o", "o.nrrd"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let deep = ["--tf", "ramp:0..1", "--volume-size", "0.1", "--skip", "none"];
    let matched = projectors(&bench, "m.png", &deep);
    let full = projectors(&bench, "f.png", &[&deep[..], &["--resolution", "full"]].concat());
    assert_eq!((&matched["resolution"], &full["resolution"]), (&json!("matched"), &json!("full")));
    assert_eq!((&matched["projectors"], &matched["frames"]), (&json!(12), &json!(2)));
    let samples = |report: &Value| report["samples"].as_f64().unwrap();
    assert!(samples(&matched) < 0.8 * samples(&full), "{matched} {full}");
    let (screen, behind) = (
        matched["resolved_m"]["screen"].as_f64().unwrap(),
        matched["resolved_m"]["behind"].as_f64().unwrap(),
    );
    let reach_m = matched["behind_screen_m"].as_f64().unwrap();
    assert!((behind - screen - 2.0 * reach_m * 2.0_f64.to_radians().tan()).abs() < 1e-9);
    simulate(&bench, "m", "matched.png", "0,0,0.6");
    simulate(&bench, "f", "full.png", "0,0,0.6");
    let apart = dssim(&bench, "matched.png", "full.png");
    assert!(apart > 0.0 && apart < 0.1, "{apart}");
    let frame = image::open(bench.path("f_0001.png")).unwrap().into_rgb8();
    assert_eq!(frame.dimensions(), (200, 64));
    // Ten places: the second frame has projectors 110 and 111, then free places.
    let ids: Vec<[u8; 3]> = [10, 30, 50].map(|x| frame.get_pixel(x, 2).0).to_vec();
    assert_eq!(ids, [[0, 0, 110], [0, 0, 111], [255; 3]]);
}

#[test]
fn a_turntable_turns_the_volume_and_corrections_are_applied() {
    let bench = bench();
    let look = ["--tf", "ramp:0..1", "--volume-size", "0.1"];
    let turns = projectors(&bench, "t.png", &[&look[..], &["--turntable", "4"]].concat());
    let outputs = turns["outputs"].as_array().unwrap();
    assert_eq!((outputs.len(), &outputs[3]), (8, &json!("t_0001_0001.png")));
    projectors(&bench, "a.png", &[&look[..], &["--azimuth", "90"]].concat());
    assert!(dssim(&bench, "a_0000.png", "t_0001_0000.png") < 1e-9);

    let table = json!([1.0, 0.0]);
    let inverted = json!({ "id": 101, "colors": { "red": table, "green": table, "blue": table } });
    let corrections = json!({ "wheatstone_corrections": 1, "projectors": [inverted] });
    std::fs::write(bench.path("c.json"), corrections.to_string()).unwrap();
    projectors(&bench, "c.png", &[&look[..], &["--azimuth", "90", "--corrections", "c.json"]].concat());
    let [plain, corrected] =
        ["a_0000.png", "c_0000.png"].map(|name| image::open(bench.path(name)).unwrap().into_rgb8());
    for (x, y, pixel) in plain.enumerate_pixels() {
        let is_of_101 = (40..80).contains(&x) && (4..34).contains(&y);
        let expected = if is_of_101 { pixel.0.map(|level| 255 - level) } else { pixel.0 };
        let sent = corrected.get_pixel(x, y).0;
        assert!((0..3).all(|c| sent[c].abs_diff(expected[c]) <= 1), "{x} {y}: {sent:?} {expected:?}");
    }
}

#[test]
fn measured_displays_are_described_as_they_are() {
    let bench = bench();
    // Beams of a projector that stands 3 mm further to the right than it should.
    let (emitter, beams) =
        ([-0.0175 * 5.5 + 0.003, 0.0, -0.5], [(2.5, 3.5), (36.5, 4.0), (8.0, 27.5), (33.0, 20.0)]);
    let correspondences: Vec<Value> = beams
        .into_iter()
        .flat_map(|pixel| [-0.1, 0.15].map(|z| (pixel, z)))
        .map(|((x, y), z): ((f64, f64), f64)| {
            let screen = [-0.1 + 0.2 * x / 40.0, 0.075 - 0.15 * y / 30.0];
            let way = (z - emitter[2]) / -emitter[2];
            let at = |axis: usize| emitter[axis] + (screen[axis] - emitter[axis]) * way;
            json!({ "pixel": [x, y], "place_m": [at(0), at(1), z] })
        })
        .collect();
    let measured = |id: u32| {
        json!({
            "wheatstone_measurements": 1,
            "projectors": [{ "id": id, "correspondences": correspondences }],
        })
        .to_string()
    };
    std::fs::write(bench.path("measured.json"), measured(104)).unwrap();
    let calibrate = |measurements: &str, output: &str| {
        bench.run(&["calibrate", measurements, "--display", "array.json", "-o", output, "--json"])
    };
    let run = calibrate("measured.json", "fitted.json");
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(run.json()["fitted"][0]["id"], 104);
    assert!(run.json()["worst_m"].as_f64().unwrap() < 1e-8);
    let fitted = &run.json()["fitted"][0];
    assert!(fitted["worst_correspondence"].is_u64(), "{fitted}");
    assert!(fitted["emitter_deviation_m"][2].as_f64().unwrap() < 1e-6, "{fitted}");
    assert!(fitted["image_deviation_m"].as_f64().unwrap() < 1e-6, "{fitted}");
    let fitted: Value =
        serde_json::from_str(&std::fs::read_to_string(bench.path("fitted.json")).unwrap()).unwrap();
    for (axis, expected) in emitter.into_iter().enumerate() {
        let found = fitted["projectors"][4]["emitter_m"][axis].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-6, "{axis}: {found}");
    }
    assert_eq!(fitted["projectors"][5], array()["projectors"][5]);

    std::fs::write(bench.path("other.json"), measured(4)).unwrap();
    let unknown = calibrate("other.json", "x.json");
    assert!(unknown.code == 2 && unknown.stderr.contains("no projector of that id"), "{}", unknown.stderr);
    assert!(!bench.path("x.json").exists());
}

#[test]
fn what_no_projectors_can_show_is_refused_with_nothing_written() {
    let bench = bench();
    std::fs::write(bench.path("c.json"), r#"{"wheatstone_corrections": 1, "projectors": [{"id": 5}]}"#)
        .unwrap();
    let before = bench.files();
    let cases: [(&[&str], &str); 7] = [
        (&["--resolution", "matched", "--mode", "mip"], "--resolution matched needs --mode dvr"),
        (&["--resolution", "half"], "--resolution"),
        (&["--before-screen", "0.6"], "--before-screen must be less"),
        (&["--corrections", "c.json"], "c.json: projectors[0].id is 5"),
        (&["--corrections", "missing.json"], "missing.json"),
        (&["--boundaries", "1,1"], "INSIDE,GAIN,EXPONENT"),
        (&["--mode", "mip", "--boundaries", "1,1,1"], "--boundaries needs --mode dvr"),
    ];
    for (flags, says) in cases {
        let run = try_projectors(&bench, "x.png", flags);
        assert_eq!(run.code, 2, "{flags:?}: {}", run.stderr);
        assert!(run.stderr.starts_with("error: ") && run.stderr.contains(says), "{flags:?}: {}", run.stderr);
    }
    let lenses = bench.run(&["projectors", "o.nrrd", "-o", "x.png", "--display", "go"]);
    assert!(lenses.code == 2 && lenses.stderr.contains("go is behind lenses"), "{}", lenses.stderr);
    assert_eq!(bench.files(), before);

    let misspelt = array().to_string().replace("wheatstone_projector_array", "wheatstone_projectors_array");
    for (text, says) in [
        (misspelt.as_str(), "display.json: neither wheatstone_projector_array is in it"),
        ("[8, 6, [336, 336], 0.75, 40, 0.654, 0.16]", "display.json: invalid type: sequence, expected a map"),
    ] {
        std::fs::write(bench.path("display.json"), text).unwrap();
        let run = bench.run(&["projectors", "o.nrrd", "-o", "x.png", "--display", "display.json"]);
        assert!(run.code == 2 && run.stderr.contains(says), "{}", run.stderr);
    }
}

#[test]
fn the_gpu_makes_the_same_frames() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = bench();
    // Deep before and behind the screen: slabs of several levels, coarse ones before fine ones.
    let deep = ["--tf", "ramp:0..1", "--volume-size", "0.4", "--azimuth", "20"];
    projectors(&bench, "cpu.png", &deep);
    let base = ["projectors", "o.nrrd", "-o", "gpu.png", "--display", "array.json", "--json"];
    let run = bench.run(&[&base[..], &["--backend", "gpu"], &deep].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!((&run.json()["backend"], &run.json()["resolution"]), (&json!("gpu"), &json!("matched")));
    for frame in ["_0000.png", "_0001.png"] {
        let apart = dssim(&bench, &format!("cpu{frame}"), &format!("gpu{frame}"));
        assert!(apart <= 0.002, "{frame}: {apart}");
    }
}

#[test]
fn how_coarsely_frames_are_cast_does_not_depend_on_a_projector_beside_the_volume() {
    let bench = bench();
    let run = bench.run(&["phantom", "snake", "--size", "64", "-o", "o.nrrd"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let flags = ["--volume-size", "0.1", "--resolution", "matched", "--tf", "ramp:0..1", "--skip", "none"];
    let beside = json!({
        "id": 7,
        "emitter_m": [0.3, 0.0, -0.5],
        "image": { "left_m": 0.08, "right_m": 0.1, "down_m": -0.075, "up_m": 0.075 },
    });
    let steps: Vec<Value> = [12, 6]
        .map(|place| {
            let mut array = array();
            array["projectors"].as_array_mut().unwrap().insert(place, beside.clone());
            std::fs::write(bench.path("array.json"), array.to_string()).unwrap();
            let json = projectors(&bench, "a.png", &flags);
            json!([json["longest_step"], json["voxels_per_step"]])
        })
        .into();
    assert_eq!(steps, [json!([2, 1]), json!([2, 1])]);
}
