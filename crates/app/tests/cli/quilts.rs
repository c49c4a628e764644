//! Quilts, and what eyes in front of displays see.

use crate::support::{Bench, Run};
use image::RgbImage;
use serde_json::{Value, json};

/// A display of 3 × 2 views of 32 × 32 pixels.
const SMALL: [&str; 12] = [
    "--columns",
    "3",
    "--rows",
    "2",
    "--quilt-size",
    "96x64",
    "--aspect",
    "1",
    "--view-cone",
    "40",
    "--focal-distance",
    "0.5",
];

/// Calibration of a panel of 192 × 192 pixels for it.
const CALIBRATION: &str = r#"{"pitch":{"value":20},"slope":{"value":-7},"center":{"value":0.3},"DPI":{"value":100},
    "screenW":{"value":192},"screenH":{"value":192},"viewCone":{"value":40}}"#;

fn try_quilt(bench: &Bench, output: &str, flags: &[&str]) -> Run {
    let base = ["quilt", "sphere.nrrd", "-o", output, "--backend", "cpu", "--iso", "0.5"];
    bench.run(&[&base[..], &SMALL, flags].concat())
}

/// A quilt of the sphere, which must succeed.
fn quilt(bench: &Bench, output: &str, flags: &[&str]) -> Run {
    let run = try_quilt(bench, output, flags);
    assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
    run
}

fn try_simulate(bench: &Bench, picture: &str, flags: &[&str]) -> Run {
    bench.run(&[&["simulate", picture, "-o", "seen.png"][..], &SMALL, flags].concat())
}

fn simulate(bench: &Bench, picture: &str, flags: &[&str]) -> Run {
    let run = try_simulate(bench, picture, flags);
    assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
    run
}

fn open(bench: &Bench, name: &str) -> RgbImage {
    image::open(bench.path(name)).unwrap().into_rgb8()
}

/// The tile of a view of the small display, by the rule: from the bottom left to the right, then up.
fn tile(quilt: &RgbImage, view: u32) -> RgbImage {
    image::imageops::crop_imm(quilt, view % 3 * 32, 32 - view / 3 * 32, 32, 32).to_image()
}

/// Mean column of what is not black.
fn middle(picture: &RgbImage) -> f64 {
    let lit = picture.enumerate_pixels().filter(|(_, _, p)| p.0 != [0; 3]);
    let columns: Vec<f64> = lit.map(|(x, _, _)| f64::from(x) + 0.5).collect();
    assert!(columns.len() > 10, "hardly anything is seen");
    columns.iter().sum::<f64>() / columns.len() as f64
}

/// Place of a camera of the small display, metres.
fn camera_x_m(view: u32) -> f64 {
    0.5 * (((f64::from(view) + 0.5) / 6.0 - 0.5) * 40.0_f64.to_radians()).tan()
}

#[test]
fn things_move_from_view_to_view_about_the_screen() {
    let bench = Bench::new();
    let moves = |before: &str| {
        quilt(&bench, "q.png", &["--volume-size", "0.04", "--before-screen", before]);
        let quilt = open(&bench, "q_qs3x2a1.png");
        let middles: Vec<f64> = (0..6).map(|view| middle(&tile(&quilt, view))).collect();
        middles.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<f64>>()
    };
    // Cameras further right see what is before the screen further left on it.
    assert!(moves("0.05").into_iter().all(|px| px < -0.5), "{:?}", moves("0.05"));
    assert!(moves("0").into_iter().all(|px| px.abs() < 0.5), "{:?}", moves("0"));
    assert!(moves("-0.05").into_iter().all(|px| px > 0.5), "{:?}", moves("-0.05"));
}

#[test]
fn the_only_view_of_a_quilt_is_the_picture_of_its_camera() {
    let bench = Bench::new();
    bench.run(&["phantom", "orientation", "--size", "24", "-o", "o.nrrd"]);
    let look = ["o.nrrd", "--backend", "cpu", "--tf", "ramp:0..1", "--azimuth", "30", "--elevation", "20"];
    let display = [
        "--columns",
        "1",
        "--rows",
        "1",
        "--quilt-size",
        "48x48",
        "--aspect",
        "1",
        "--screen-height",
        "0.16",
        "--focal-distance",
        "0.64",
        "--volume-size",
        "0.1",
    ];
    assert_eq!(bench.run(&[&["quilt", "-o", "q.png"][..], &look, &display].concat()).code, 0);
    // The same seen from 6.4 m, where the volume is 1 m long: 2 atan(0.08/0.64).
    let camera = ["--size", "48x48", "--distance", "6.4", "--fov", "0.248709989"];
    assert_eq!(bench.run(&[&["render", "-o", "r.png"][..], &look, &camera].concat()).code, 0);
    let same = bench.run(&["compare", "q_qs1x1a1.png", "r.png", "--json"]).json();
    assert!(same["max_abs"].as_f64().unwrap() <= 1.0 / 255.0 + 1e-6, "{same}");
    let picture = open(&bench, "r.png");
    assert!(picture.pixels().any(|p| p.0 != [0; 3]), "nothing is seen");
}

#[test]
fn files_tell_how_they_are_laid_out() {
    let bench = Bench::new();
    let report = quilt(&bench, "a.png", &["--json"]).json();
    assert_eq!(report["outputs"], json!(["a_qs3x2a1.png"]));
    assert_eq!((&report["views"], &report["tile_size"]), (&json!(6), &json!([32, 32])));
    assert_eq!(report["rays"], 96 * 64);
    assert!(report["samples"].as_u64().unwrap() > 0 && report["display"]["columns"] == 3, "{report}");
    quilt(&bench, "b_QS3x2A1.00.png", &[]);
    assert_eq!(bench.files(), ["a_qs3x2a1.png", "b_QS3x2A1.00.png", "sphere.nrrd"]);
    assert_eq!(bench.png("a_qs3x2a1.png"), (96, 64, image::ColorType::Rgb8));

    let mut file = std::io::BufReader::new(std::fs::File::open(bench.path("a_qs3x2a1.png")).unwrap());
    let metadata = exif::Reader::new().read_from_container(&mut file).unwrap();
    let comment = metadata.get_field(exif::Tag::UserComment, exif::In::PRIMARY).unwrap();
    let exif::Value::Undefined(bytes, _) = &comment.value else { panic!("{comment:?}") };
    let layout: Value = serde_json::from_slice(bytes.strip_prefix(b"ASCII\0\0\0").unwrap()).unwrap();
    let expected =
        json!({"LKGNumViews": 6, "LKGRows": 2, "LKGColumns": 3, "LKGAspect": 1.0, "LKGType": "Image"});
    assert_eq!(layout, expected);

    let wrong = try_quilt(&bench, "c_qs5x9a1.78.png", &[]);
    assert_eq!(wrong.code, 2);
    assert!(wrong.stderr.contains("5x9") && wrong.stderr.contains("c_qs3x2a1"), "{}", wrong.stderr);
    assert_eq!(bench.files().len(), 3);
}

#[test]
fn both_sampling_rules_place_the_cameras() {
    let bench = Bench::new();
    let outermost = |rule: &str| {
        quilt(&bench, "q.png", &["--volume-size", "0.04", "--before-screen", "0.05", "--sampling", rule]);
        let quilt = open(&bench, "q_qs3x2a1.png");
        middle(&tile(&quilt, 0)) - middle(&tile(&quilt, 5))
    };
    let (middles, ends) = (outermost("middles"), outermost("ends"));
    // The outermost cameras are 2 tan(20° · 5/6) or 2 tan(20°) of the distance apart.
    let expected = 20.0_f64.to_radians().tan() / (20.0_f64.to_radians() * 5.0 / 6.0).tan();
    assert!((ends / middles - expected).abs() < 0.07, "{ends} {middles} {expected}");
}

#[test]
fn a_turntable_is_a_sequence_of_quilts_with_what_the_panel_shows() {
    let bench = Bench::new();
    std::fs::write(bench.path("visual.json"), CALIBRATION).unwrap();
    let size = ["--volume-size", "0.1", "--tf", "ramp:0..1"];
    quilt(&bench, "t.png", &[&["--turntable", "4", "--interlace", "visual.json"], &size[..]].concat());
    quilt(&bench, "q.png", &[&["--azimuth", "90"], &size[..]].concat());
    let frames = (0..4).flat_map(|n| [format!("t_000{n}_interlaced.png"), format!("t_000{n}_qs3x2a1.png")]);
    let expected: Vec<String> =
        ["q_qs3x2a1.png", "sphere.nrrd"].map(String::from).into_iter().chain(frames).collect();
    assert_eq!(bench.files(), [&expected[..], &["visual.json".to_owned()]].concat());
    let same = bench.run(&["compare", "q_qs3x2a1.png", "t_0001_qs3x2a1.png", "--json"]).json();
    assert_eq!(same["max_abs"], 0.0);

    // Each sub-pixel has the channel of the view that its lens sends there.
    use wheatstone_core::lightfield::{Lenticular, QuiltDisplay};
    let lenses = Lenticular::from_visual_json(CALIBRATION).unwrap();
    let display: QuiltDisplay = serde_json::from_value(json!({
        "columns": 3, "rows": 2, "quilt_size_px": [96, 64], "aspect": 1.0, "view_cone_deg": 40.0,
        "focal_distance_m": 0.5, "screen_height_m": 0.16,
    }))
    .unwrap();
    let (quilt, panel) = (open(&bench, "t_0000_qs3x2a1.png"), open(&bench, "t_0000_interlaced.png"));
    assert_eq!(panel.dimensions(), (192, 192));
    for (x, y, pixel) in panel.enumerate_pixels() {
        for channel in 0..3 {
            let [left, top] = display.tile_px(lenses.view(x, y, channel, 6));
            let shown = quilt.get_pixel(left + x / 6, top + y / 6).0[channel];
            assert_eq!(pixel.0[channel], shown, "{x} {y} {channel}");
        }
    }
}

#[test]
fn what_is_too_deep_is_told() {
    let bench = Bench::new();
    let deep = quilt(&bench, "q.png", &["--volume-size", "0.15"]);
    assert!(deep.stderr.contains("warning: the volume reaches from 75.0 mm behind"), "{}", deep.stderr);
    let flat = quilt(&bench, "q.png", &["--volume-size", "0.005"]);
    assert!(!flat.stderr.contains("warning"), "{}", flat.stderr);
    let behind = quilt(&bench, "q.png", &["--volume-size", "0.15", "--before-screen=-900"]);
    let says = "warning: the volume reaches from 900075.0 mm to 899925.0 mm behind the screen; beyond";
    assert!(behind.stderr.contains(says), "{}", behind.stderr);
    let lenient = quilt(&bench, "q.png", &["--volume-size", "0.15", "--most-disparity", "100"]);
    assert!(!lenient.stderr.contains("warning"), "{}", lenient.stderr);
}

#[test]
fn quilts_may_be_as_large_as_descriptions_allow() {
    let bench = Bench::new();
    let base = ["quilt", "sphere.nrrd", "-o", "q_qs1x1a1.png", "--display", "none.json", "--quilt-size"];
    for (size, says) in [
        ("32768x4096", "none.json"),
        ("32769x1", "each from 1 to 32768, with at most 134217728 pixels"),
        ("32768x4097", "each from 1 to 32768, with at most 134217728 pixels"),
    ] {
        let run = bench.run(&[&base[..], &[size]].concat());
        assert!(run.code == 2 && run.stderr.contains(says), "{size}: {}", run.stderr);
    }
    quilt(&bench, "q.png", &["--volume-size", "0.05"]);
    simulate(&bench, "q_qs3x2a1.png", &["--size", "20000x1"]);
    assert_eq!(open(&bench, "seen.png").dimensions(), (20_000, 1));
}

#[test]
fn a_calibration_of_hardly_any_lenses_is_refused() {
    let bench = Bench::new();
    quilt(&bench, "q.png", &["--volume-size", "0.05"]);
    std::fs::write(bench.path("visual.json"), CALIBRATION.replace("{\"value\":20}", "0.0001")).unwrap();
    let refused = try_simulate(&bench, "q_qs3x2a1.png", &["--interlaced", "visual.json"]);
    assert_eq!(refused.code, 2);
    let says = "visual.json: pitch is 0.0001, with slope -7 and DPI 100:";
    assert!(refused.stderr.contains(says), "{}", refused.stderr);
    assert!(refused.stderr.contains("must be from 10 to 576"), "{}", refused.stderr);
}

#[test]
fn by_default_the_volume_just_fits_the_screen() {
    let bench = Bench::new();
    let box_of = |flags: &[&str]| {
        bench.run(&["phantom", "box", "--size", "16", "-o", "box.nrrd"]);
        let base = ["quilt", "box.nrrd", "-o", "q_qs1x1a1.png", "--backend", "cpu", "--mode", "mip"];
        let display = ["--columns", "1", "--rows", "1", "--quilt-size", "64x64", "--aspect", "1", "--json"];
        let run = bench.run(&[&base[..], &display, flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.json()["volume_size_m"].as_f64().unwrap()
    };
    let (still, turning) = (box_of(&[]), box_of(&["--azimuth", "45"]));
    assert!(turning < still, "a turned cube is wider");
    // The cube's near face is the screen's width there: s/2 · D/(D − s/2) = w/2.
    let display = wheatstone_core::lightfield::quilt::Model::Portrait.display();
    let (w, d) = (display.screen_height_m, display.focal_distance_m);
    assert!((still - w * d / (d + 0.5 * w)).abs() < 1e-6, "{still}");
}

#[test]
fn an_eye_where_a_camera_was_sees_its_view() {
    let bench = Bench::new();
    quilt(&bench, "q.png", &["--volume-size", "0.06", "--before-screen", "0.03"]);
    let picture = open(&bench, "q_qs3x2a1.png");
    for view in 0..6 {
        let eye = format!("{},0.1,0.5", camera_x_m(view));
        simulate(&bench, "q_qs3x2a1.png", &["--eye", &eye]);
        let seen = open(&bench, "seen.png");
        let furthest = seen.iter().zip(tile(&picture, view).iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(furthest <= Some(1), "view {view}: {furthest:?}");
    }
    let [left, right] = ["-0.06,0,0.5", "0.06,0,0.5"].map(|eye| {
        simulate(&bench, "q_qs3x2a1.png", &["--eye", eye]);
        middle(&open(&bench, "seen.png"))
    });
    assert!(left > right + 1.0, "what is before the screen: {left} {right}");
    let beyond = simulate(&bench, "q_qs3x2a1.png", &["--eye", "0.4,0,0.5"]);
    assert!(beyond.stderr.contains("beyond the view cone"), "{}", beyond.stderr);
}

#[test]
fn the_name_of_a_quilt_tells_how_it_is_laid_out() {
    use wheatstone_core::lightfield::quilt::Model;
    let bench = Bench::new();
    quilt(&bench, "q.png", &["--volume-size", "0.06", "--before-screen", "0.03"]);
    let picture = open(&bench, "q_qs3x2a1.png");
    let read = |name: &str, flags: &[&str]| {
        std::fs::copy(bench.path("q_qs3x2a1.png"), bench.path("copy.png")).unwrap();
        std::fs::rename(bench.path("copy.png"), bench.path(name)).unwrap();
        bench.run(&[&["simulate", name, "-o", "seen.png", "--json"], flags].concat())
    };
    // Of what the name does not tell the portrait's is taken, whose view cone is as wide.
    let nearer = Model::Portrait.display().focal_distance_m / 0.5;
    for view in 0..6 {
        let eye = format!("{},0,{}", camera_x_m(view) * nearer, 0.5 * nearer);
        for name in ["q_qs3x2a1.png", "q_qs3x2a1_v2.png"] {
            assert_eq!(read(name, &["--eye", &eye]).code, 0);
            let seen = open(&bench, "seen.png");
            let furthest = seen.iter().zip(tile(&picture, view).iter()).map(|(a, b)| a.abs_diff(*b)).max();
            assert!(seen.dimensions() == (32, 32) && furthest <= Some(1), "{name} {view}: {furthest:?}");
        }
    }
    let go = Model::Go.display();
    let known = read("q_qs11x6a0.5625.png", &[]).json();
    assert_eq!((&known["screen_size_m"], &known["size"]), (&json!(go.screen_size_m()), &json!([8, 10])));
    assert_eq!(known["eyes_m"][0][2], go.focal_distance_m);
    for (flags, says) in [
        (&["--columns", "4"][..], "3x2 views"),
        (&["--aspect", "0.75"], "aspect 1:"),
        (&["--display", "go"], "q_qs11x6a0.5625"),
        (&["--quilt-size", "96x96"], "must be of 96x96"),
    ] {
        let run = read("q_qs3x2a1.png", flags);
        assert!(run.code == 2 && run.stderr.contains(says), "{flags:?}: {}", run.stderr);
    }
}

#[test]
fn a_walk_is_a_numbered_sequence() {
    let bench = Bench::new();
    quilt(&bench, "q.png", &[]);
    let walk = ["--eye", "-0.1,0,0.5", "--walk", "0.1,0,0.7", "--frames", "3", "--size", "20x10", "--json"];
    let report = simulate(&bench, "q_qs3x2a1.png", &walk).json();
    assert_eq!(report["outputs"], json!(["seen_0000.png", "seen_0001.png", "seen_0002.png"]));
    assert_eq!(report["eyes_m"][0], json!([-0.1, 0.0, 0.5]));
    assert_eq!(report["eyes_m"][2], json!([0.1, 0.0, 0.7]));
    assert_eq!(report["shown"], "quilt");
    assert_eq!(bench.png("seen_0002.png"), (20, 10, image::ColorType::Rgb8));
}

#[test]
fn an_interlaced_picture_shows_what_its_quilt_does() {
    let bench = Bench::new();
    std::fs::write(bench.path("visual.json"), CALIBRATION).unwrap();
    quilt(&bench, "q.png", &["--volume-size", "0.08", "--interlace", "visual.json"]);
    let eye = format!("{},0,0.5", camera_x_m(4));
    simulate(&bench, "q_qs3x2a1.png", &["--eye", &eye]);
    std::fs::rename(bench.path("seen.png"), bench.path("quilt.png")).unwrap();
    let through = ["--interlaced", "visual.json", "--eye", &eye, "--json"];
    assert_eq!(simulate(&bench, "q_interlaced.png", &through).json()["shown"], "interlaced");
    let compared = bench.run(&["compare", "quilt.png", "seen.png", "--json"]).json();
    assert!(compared["dssim"].as_f64().unwrap() < 0.1, "{compared}");
    let quilt = try_simulate(&bench, "q_qs3x2a1.png", &["--interlaced", "visual.json"]);
    assert!(quilt.code == 2 && quilt.stderr.contains("192x192"), "{}", quilt.stderr);
}

#[test]
fn an_eye_sees_the_projector_whose_beam_meets_it() {
    use wheatstone_core::image::RgbImage as Picture;
    use wheatstone_core::lightfield::ProjectorArray;
    let bench = Bench::new();
    let projector = |id: u32| {
        let image = json!({"left_m": -0.1, "right_m": 0.1, "down_m": -0.1, "up_m": 0.1});
        json!({"id": id, "emitter_m": [0.02 * (f64::from(id) - 1.5), 0.0, -0.5], "image": image})
    };
    let description = json!({
        "wheatstone_projector_array": 1, "screen_size_m": [0.2, 0.2], "pixel_size_m": 0.0125,
        "beam_angle_deg": 2.3, "viewer": {"height_m": 0.0, "distance_m": 0.5}, "image_size_px": [16, 16],
        "projectors": [projector(0), projector(1), projector(2), projector(3)],
        "packing": {"frame_size_px": [32, 18], "header_rows": 2},
    })
    .to_string();
    std::fs::write(bench.path("array.json"), &description).unwrap();
    let array = ProjectorArray::from_json(&description).unwrap();
    let grey = |id: u32| Picture { width: 16, height: 16, rgb: vec![[0.2 * (id + 1) as f32; 3]; 256] };
    let images: Vec<Picture> = (0..4).map(grey).collect();
    for (index, frame) in array.pack(&images).unwrap().iter().enumerate() {
        let png = RgbImage::from_raw(32, 18, frame.to_rgb8()).unwrap();
        png.save(bench.path(&format!("frame_{index}.png"))).unwrap();
    }
    for id in 0..4_u32 {
        let eye = format!("{},0,0.5", -0.02 * (f64::from(id) - 1.5));
        let run = bench.run(&[
            "simulate",
            "frame_0.png",
            "frame_1.png",
            "-o",
            "seen.png",
            "--display",
            "array.json",
            "--eye",
            &eye,
            "--size",
            "15x15",
        ]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        assert_eq!(open(&bench, "seen.png").get_pixel(7, 7).0, [(51 * (id + 1)) as u8; 3]);
    }
    let one = bench.run(&["simulate", "frame_0.png", "-o", "x.png", "--display", "array.json"]);
    assert!(one.code == 2 && one.stderr.contains("the image of projector 2"), "{}", one.stderr);
    let twice =
        ["simulate", "frame_0.png", "frame_1.png", "frame_0.png", "-o", "x.png", "--display", "array.json"];
    let twice = bench.run(&twice);
    let says = "frame_0.png: it has the image of projector 0, which came before";
    assert!(twice.code == 2 && twice.stderr.contains(says), "{}", twice.stderr);
}

#[test]
fn what_is_no_display_is_refused_with_nothing_written() {
    let bench = Bench::new();
    std::fs::write(bench.path("bad.json"), r#"{"columns": 3}"#).unwrap();
    std::fs::write(bench.path("visual.json"), CALIBRATION).unwrap();
    std::fs::write(bench.path("no-pitch.json"), r#"{"slope": 1}"#).unwrap();
    let before = bench.files();
    let cases: [(&[&str], &str); 12] = [
        (&["--display", "8k"], "portrait"),
        (&["--display", "bad.json"], "bad.json: missing field"),
        (&["--display", "missing.json"], "missing.json"),
        (&["--display", "agus-2008"], "agus-2008 has projectors"),
        (&["--quilt-size", "2x2"], "a pixel for each tile"),
        (&["--columns", "0"], "--columns"),
        (&["--view-cone", "180"], "from 0.1 to 179"),
        (&["--columns", "1000", "--rows", "1000", "--quilt-size", "1000x1000"], "at most 1024"),
        (&["--before-screen", "0.5"], "--before-screen must be less"),
        (&["--interlace", "no-pitch.json"], "no-pitch.json: pitch is missing"),
        (&["--interlace", "visual.json", "--aspect", "0.75"], "the display's aspect is 0.75"),
        (&["--mode", "mip"], "--iso needs --mode iso"),
    ];
    for (flags, says) in cases {
        let flags_of_display: Vec<&str> =
            SMALL.chunks(2).filter(|pair| !flags.contains(&pair[0])).flatten().copied().collect();
        let base = ["quilt", "sphere.nrrd", "-o", "x.png", "--backend", "cpu", "--iso", "0.5"];
        let run = bench.run(&[&base[..], &flags_of_display, flags].concat());
        assert_eq!(run.code, 2, "{flags:?}: {}", run.stderr);
        assert!(run.stderr.starts_with("error: ") && run.stderr.contains(says), "{flags:?}: {}", run.stderr);
    }
    assert_eq!(bench.files(), before);

    quilt(&bench, "q.png", &[]);
    let simulations: [(&[&str], &str); 5] = [
        (&["q_qs3x2a1.png", "--display", "portrait"], "3x2"),
        (&["q_qs3x2a1.png", "q_qs3x2a1.png"], "2 pictures"),
        (&["q_qs3x2a1.png", "--eye", "0,0,-1"], "Z from 0.001"),
        (&["q_qs3x2a1.png", "--frames", "3"], "--walk"),
        (&["sphere.nrrd"], "sphere.nrrd"),
    ];
    let before = bench.files();
    for (args, says) in simulations {
        let run = bench.run(&[&["simulate", "-o", "seen.png"], args].concat());
        assert_eq!(run.code, 2, "{args:?}: {}", run.stderr);
        assert!(run.stderr.starts_with("error: ") && run.stderr.contains(says), "{args:?}: {}", run.stderr);
    }
    let size = try_simulate(&bench, "q_qs3x2a1.png", &[]);
    assert_eq!(size.code, 0, "{}", size.stderr);
    std::fs::copy(bench.path("q_qs3x2a1.png"), bench.path("plain.png")).unwrap();
    let other = bench.run(&["simulate", "plain.png", "-o", "x.png"]);
    assert!(other.code == 2 && other.stderr.contains("plain.png: the quilt is of 96x64"), "{}", other.stderr);
    assert_eq!(bench.files().len(), before.len() + 2);
}

#[test]
fn the_gpu_makes_the_same_quilt() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = Bench::new();
    let flags = ["--volume-size", "0.08", "--before-screen", "0.02"];
    quilt(&bench, "cpu.png", &flags);
    let gpu = ["quilt", "sphere.nrrd", "-o", "gpu.png", "--backend", "gpu", "--iso", "0.5", "--json"];
    let run = bench.run(&[&gpu[..], &SMALL, &flags].concat());
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(run.json()["backend"], "gpu");
    let compared = bench.run(&["compare", "cpu_qs3x2a1.png", "gpu_qs3x2a1.png", "--json"]).json();
    assert!(compared["dssim"].as_f64().unwrap() <= 0.002, "{compared}");
}

#[test]
fn views_method_says_what_cannot_be_derived() {
    let bench = Bench::new();
    let report = quilt(&bench, "q.png", &["--json"]).json();
    assert_eq!(
        (&report["method"], &report["anchors"], &report["bytes"]),
        (&json!("each"), &json!(null), &json!(0))
    );
    let refused = try_quilt(&bench, "q.png", &["--views-method", "each", "--anchors", "2"]);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("--anchors needs --views-method anchors"), "{}", refused.stderr);
    let refused = try_quilt(&bench, "q.png", &["--views-method", "anchors"]);
    assert_eq!(refused.code, 2);
    assert!(refused.stderr.contains("--views-method anchors: the CPU renderer"), "{}", refused.stderr);
}

#[test]
fn views_come_of_anchors() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = Bench::new();
    let base = [
        "quilt",
        "sphere.nrrd",
        "--backend",
        "gpu",
        "--tf",
        "ramp:0.2..0.9",
        "--volume-size",
        "0.05",
        "--json",
    ];
    let made = |output: &str, flags: &[&str]| {
        let run = bench.run(&[&base[..], &["-o", output], &SMALL, flags].concat());
        (run.code == 0).then(|| run.json()).ok_or(run.stderr)
    };
    let each = made("each.png", &["--views-method", "each"]).unwrap();
    let anchors = made("anchors.png", &["--views-method", "anchors", "--anchors", "2"]).unwrap();
    assert_eq!(
        (&each["method"], &anchors["method"], &anchors["anchors"]),
        (&json!("each"), &json!("anchors"), &json!(2))
    );
    assert!(
        anchors["bytes"].as_u64() > Some(0) && anchors["samples"].as_u64() < each["samples"].as_u64(),
        "{anchors}"
    );
    let same = bench.run(&["compare", "each_qs3x2a1.png", "anchors_qs3x2a1.png", "--json"]).json();
    assert!(same["dssim"].as_f64().unwrap() < 0.01, "{same}");
    let error = made("mip.png", &["--mode", "mip", "--views-method", "anchors"]).unwrap_err();
    assert!(error.contains("--views-method anchors: mode mip: only composites"), "{error}");
    assert_eq!(made("mip.png", &["--mode", "mip"]).unwrap()["method"], "each");
}
