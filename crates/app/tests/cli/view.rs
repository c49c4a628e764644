//! The viewer, played by scripts.

use crate::support::{Bench, Run};
use crate::xvfb::Xvfb;
use image::RgbImage;

/// A session: everything that the viewer is for, once.
const SESSION: &str = r#"
{"wait_for": "rest"}
{"do": {"preset": "viridis"}}
{"wait_for": "rest"}
{"do": {"picture": "first.png"}}
{"wait_for": "rest"}
{"do": {"warp": "volumetric"}}
{"wait_for": "rest"}
{"drag": {"from": [60, 150], "to": [200, 180], "ms": 150}}
{"wait_for": "rest"}
{"do": {"picture": "orbited.png"}}
{"wait_for": "rest"}
{"drag": {"from": [60, 150], "to": [60, 190], "ms": 400, "ctrl": true}}
{"drag": {"from": [616, 131], "to": [590, 170], "ms": 400}}
{"do": {"clip_handles": true}}
{"do": {"move_face": {"face": 3, "to": 0.5}}}
{"do": {"clip_plane": {"normal": [0, 1, 0], "offset_m": -0.2}}}
{"scroll": {"at": [60, 150], "points": 80}}
{"press": "?"}
{"wait_for": "rest"}
{"do": {"screenshot": "clipped.png"}}
{"do": {"arrangement": "side_by_side"}}
{"wait_for": "rest"}
{"do": {"picture": "pair.png"}}
{"do": {"save": "view.json"}}
{"wait_for": "rest"}
{"do": {"arrangement": "anaglyph"}}
{"do": "reset_camera"}
{"wait_for": "rest"}
{"resize": [560, 300]}
{"do": {"open": "view.json"}}
{"do": "reload"}
{"wait_for": "rest"}
{"do": {"save": "again.json"}}
{"do": {"turntable": {"pictures": 2, "path": "turn.png"}}}
{"wait_for": "rest"}
{"do": "quit"}
"#;

fn play(script: &str, flags: &[&str], display: Option<&Xvfb>) -> (Bench, Run) {
    let bench = Bench::new();
    std::fs::write(bench.path("session.jsonl"), script).unwrap();
    let args = ["view", "sphere.nrrd", "--script", "session.jsonl", "--json"];
    let size: &[&str] = if flags.contains(&"--size") { &[] } else { &["--size", "640x360"] };
    let display = display.map_or("", |xvfb| &xvfb.display);
    let run = bench.run_in(&[&args, size, flags].concat(), &[("DISPLAY", display), ("WAYLAND_DISPLAY", "")]);
    (bench, run)
}

fn picture(bench: &Bench, name: &str) -> RgbImage {
    image::open(bench.path(name)).unwrap().into_rgb8()
}

/// Pixels that are brighter than the background.
fn lit(picture: &RgbImage) -> usize {
    picture.pixels().filter(|pixel| pixel.0.iter().any(|&channel| channel > 60)).count()
}

fn needs_adapter() -> bool {
    std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_none()
}

fn assert_session(bench: &Bench, run: &Run) {
    assert_eq!(run.code, 0, "{}", run.stderr);
    let report = run.json();
    assert!(report["failures"].as_array().unwrap().is_empty(), "{report}");
    assert!(report["event_to_present_ms"]["count"].as_u64().unwrap() > 30, "{report}");
    let first = picture(bench, "first.png");
    assert!(first.width() < 640 && first.height() == 360, "without the panels");
    let middle = first.get_pixel(first.width() / 2, 180).0;
    assert!(middle.iter().any(|&channel| channel > 60), "the sphere is in the middle: {middle:?}");
    assert!(lit(&first) > 3000);
    let orbited = picture(bench, "orbited.png");
    assert!(first != orbited, "a drag orbits");
    assert_eq!(picture(bench, "clipped.png").dimensions(), (640, 360));
    let pair = picture(bench, "pair.png");
    let half = pair.width() / 2;
    let [left, right] = [0, half].map(|x| image::imageops::crop_imm(&pair, x, 0, half, 360).to_image());
    assert!(lit(&left) > 500 && lit(&right) > 500 && left != right);
    let view = |name: &str| std::fs::read_to_string(bench.path(name)).unwrap();
    assert_eq!(view("view.json"), view("again.json"));
    let saved: serde_json::Value = serde_json::from_str(&view("view.json")).unwrap();
    let dragged = saved["transfer"]["opacity"][1].as_array().unwrap().clone();
    assert!(
        dragged.iter().all(|number| number.as_f64().unwrap() < 0.95),
        "the last point, at 1: {dragged:?}"
    );
    assert_ne!(saved["transfer"]["window"], serde_json::json!([0.0, 1.0]), "Ctrl drag widens the window");
    assert!(lit(&picture(bench, "turn_0001.png")) > 500);
}

#[test]
fn a_session_in_a_window_goes_without_an_error() {
    if needs_adapter() {
        let xvfb = Xvfb::start();
        let (bench, run) = play(SESSION, &[], Some(&xvfb));
        assert_session(&bench, &run);
    }
}

#[test]
fn the_same_session_without_quit_ends_without_a_window() {
    if needs_adapter() {
        let (bench, run) = play(&SESSION.replace("{\"do\": \"quit\"}", ""), &["--headless"], None);
        assert_session(&bench, &run);
    }
}

/// Lit pixels in the middle of a screenshot, where no messages are.
fn lit_in_the_middle(bench: &Bench, name: &str) -> usize {
    let shot = picture(bench, name);
    let (width, height) = shot.dimensions();
    lit(&image::imageops::crop_imm(&shot, width / 3, 0, width / 3, height).to_image())
}

#[test]
fn after_a_leap_of_the_eye_the_picture_is_neither_blank_nor_torn() {
    if !needs_adapter() {
        return;
    }
    const LEAPS: &str = r#"
{"do": {"preset": "ramp:0.2..0.6"}}
{"press": "H"}
{"do": {"face": "back"}}
{"wait_for": "rest"}
{"do": {"screenshot": "rest.png"}}
{"do": {"face": "right"}}
{"do": {"screenshot": "right.png"}}
{"wait_for": "rest"}
{"do": {"face": "left"}}
{"do": {"screenshot": "left.png"}}
{"wait_for": "rest"}
{"do": {"orbit": {"right_deg": 60, "up_deg": 0}}}
{"do": {"screenshot": "aslant.png"}}
"#;
    for warp in ["quad", "grid", "volumetric"] {
        let script = format!(
            "{{\"wait_for\": \"rest\"}}\n{{\"do\": {{\"warp\": \"{warp}\"}}}}\n{{\"wait_for\": \"rest\"}}{LEAPS}"
        );
        let (bench, run) = play(&script, &["--headless", "--size", "480x260"], None);
        assert_eq!(run.code, 0, "{}", run.stderr);
        let at_rest = lit_in_the_middle(&bench, "rest.png");
        assert!(at_rest > 3000, "{at_rest}");
        for name in ["right.png", "left.png", "aslant.png"] {
            let lit = lit_in_the_middle(&bench, name);
            assert!(10 * lit > 9 * at_rest, "{warp}, {name}: {lit} of {at_rest}");
        }
    }
}

#[test]
fn a_ball_stays_round_while_the_eyes_are_parted() {
    if !needs_adapter() {
        return;
    }
    let script = r#"
{"do": {"preset": "ramp:0.2..0.6"}}
{"do": {"warp": "none"}}
{"press": "H"}
{"wait_for": "rest"}
{"do": {"arrangement": "side_by_side"}}
{"do": {"screenshot": "at-once.png"}}
"#;
    let (bench, run) = play(&format!("{{\"wait_for\": \"rest\"}}{script}"), &["--headless"], None);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let shot = picture(&bench, "at-once.png");
    let right = image::imageops::crop_imm(&shot, 320, 0, 320, 360).to_image();
    let is_lit = |x, y| right.get_pixel(x, y).0.iter().any(|&channel| channel > 60);
    let columns = (0..320).filter(|&x| (0..360).any(|y| is_lit(x, y))).count();
    let rows = (0..360).filter(|&y| (0..320).any(|x| is_lit(x, y))).count();
    assert!(columns > 100 && columns.abs_diff(rows) < 10, "{columns}×{rows}");
}

#[test]
fn one_cast_parts_the_eyes_by_every_warp_and_shows_what_two_casts_do() {
    if !needs_adapter() {
        return;
    }
    let mut script = r#"
{"wait_for": "rest"}
{"do": {"preset": "ramp:0.2..0.6"}}
{"press": "H"}
{"do": {"eye_distance": 0.1}}
{"do": {"arrangement": "side_by_side"}}
{"wait_for": "rest"}
{"do": {"picture": "two_casts.png"}}
{"wait_for": "rest"}
{"do": {"eye_method": "one_cast"}}
"#
    .to_owned();
    // How far from two casts each may be, DSSIM.
    const WARPS: [(&str, f64); 4] =
        [("none", 0.005), ("quad", 0.005), ("grid", 0.005), ("volumetric", 0.012)];
    for (warp, _) in WARPS {
        script += &format!(
            "{{\"do\": {{\"warp\": \"{warp}\"}}}}\n{{\"wait_for\": \"rest\"}}\n\
             {{\"do\": {{\"picture\": \"{warp}.png\"}}}}\n{{\"wait_for\": \"rest\"}}\n"
        );
    }
    let (bench, run) = play(&script, &["--headless", "--size", "1000x600"], None);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let expected = as_picture(&picture(&bench, "two_casts.png"));
    for (warp, most_dssim) in WARPS {
        let pair = picture(&bench, &format!("{warp}.png"));
        let [left, right] = [0, 500].map(|x| image::imageops::crop_imm(&pair, x, 0, 500, 600).to_image());
        let differing = left.pixels().zip(right.pixels()).filter(|(left, right)| left != right).count();
        assert!(differing > 5000, "{warp}: both eyes see the same but for {differing} pixels");
        let dssim = wheatstone_core::metrics::compare(&as_picture(&pair), &expected).unwrap().dssim();
        assert!(dssim < most_dssim, "{warp}: {dssim}");
    }
}

#[test]
fn keys_are_held_and_pressed_with_ctrl() {
    if !needs_adapter() {
        return;
    }
    let script = r#"
{"wait_for": "rest"}
{"do": {"save": "before.json"}}
{"hold": {"key": "Right", "ms": 400}}
{"press": "Ctrl+S"}
{"press": "Ctrl+S"}
{"press": "Ctrl+R"}
{"wait_for": "rest"}
{"press": "Ctrl+Q"}
{"do": {"save": "after.json"}}
"#;
    let (bench, run) = play(script, &["--headless"], None);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let azimuth_deg = |name: &str| saved(&bench, name)["camera"]["azimuth_deg"].as_f64().unwrap();
    assert!(azimuth_deg("view.json") > azimuth_deg("before.json") + 2.0, "{}", azimuth_deg("view.json"));
    assert!(!bench.path("after.json").exists(), "Ctrl Q ends the program");
    assert!(bench.path("view-2.json").exists() && !bench.path("view-3.json").exists());
}

fn saved(bench: &Bench, name: &str) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(bench.path(name)).unwrap()).unwrap()
}

#[test]
fn what_is_edited_while_a_file_is_read_again_stays_and_a_file_that_is_dropped_is_opened() {
    if !needs_adapter() {
        return;
    }
    let script = r#"
{"wait_for": "rest"}
{"do": {"save": "first.json"}}
{"do": "reload"}
{"do": {"zoom": 2.0}}
{"do": "reload"}
{"do": {"isovalue": 0.25}}
{"wait_for": "rest"}
{"do": {"save": "again.json"}}
{"drop": "b_8x8x8_uint8.raw"}
{"do": {"screenshot": "dropped.png"}}
{"wait_for": "rest"}
{"do": {"save": "dropped.json"}}
"#;
    let bench = Bench::new();
    std::fs::write(bench.path("b_8x8x8_uint8.raw"), [7; 512]).unwrap();
    std::fs::write(bench.path("s.jsonl"), script).unwrap();
    let args = ["view", "sphere.nrrd", "--headless", "--size", "640x360", "--script", "s.jsonl", "--json"];
    let run = bench.run(&args);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let again = saved(&bench, "again.json");
    assert_eq!((&again["look"]["isovalue"], &again["file"]), (&0.25.into(), &"sphere.nrrd".into()));
    let dropped = saved(&bench, "dropped.json");
    assert_eq!(dropped["file"], "b_8x8x8_uint8.raw");
    let distance_m = |view: &serde_json::Value| view["camera"]["distance_m"].as_f64().unwrap();
    assert_eq!(2.0 * distance_m(&again), distance_m(&saved(&bench, "first.json")));
}

#[test]
fn edits_of_what_is_not_there_fail_with_what_there_is() {
    if !needs_adapter() {
        return;
    }
    let edits = [
        (r#"{"move_face": {"face": 99, "to": 0.5}}"#, "from 0 to 5"),
        (r#"{"remove_opacity_point": 999}"#, "from 0 to"),
        (r#"{"zoom": 0}"#, "above 0"),
    ];
    let script: String = edits.iter().map(|(edit, _)| format!("{{\"do\": {edit}}}\n")).collect();
    let run = play(&script, &["--headless"], None).1;
    assert_eq!(run.code, 1, "{}", run.stderr);
    let failures = run.json()["failures"].as_array().unwrap().clone();
    assert_eq!(failures.len(), 3);
    for (failure, (_, says)) in failures.iter().zip(edits) {
        assert!(failure.as_str().unwrap().contains(says), "{failure}");
    }
}

#[test]
fn voxels_that_are_a_million_times_as_long_as_wide_are_shown_with_a_warning() {
    let bench = Bench::new();
    let voxels: Vec<u8> = (0..512).map(|index| (index % 8 * 36) as u8).collect();
    std::fs::write(bench.path("a_8x8x8_uint8.raw"), voxels).unwrap();
    let script = r#"
{"wait_for": "rest"}
{"press": "H"}
{"wait_for": "rest"}
{"do": {"picture": "viewed.png"}}
"#;
    std::fs::write(bench.path("s.jsonl"), script).unwrap();
    for (spacing, is_visible) in
        [("0.000001,1,1000000", false), ("0.001,1,1000", false), ("1,0.00001,1", true)]
    {
        let flags =
            ["a_8x8x8_uint8.raw", "--raw-size", "8x8x8", "--raw-type", "uint8", "--raw-spacing", spacing];
        let check = |command: &[&str], output: &str| {
            let run = bench.run(&[command, &flags].concat());
            assert_eq!(run.code, 0, "{spacing}: {}", run.stderr);
            assert!(run.stderr.contains("smallest spacing"), "{spacing}: {}", run.stderr);
            let lit = lit(&picture(&bench, output));
            assert!(!is_visible || lit > 200, "{command:?} {spacing}: {lit}");
        };
        let render = ["render", "--tf", "ramp:0..1", "--size", "64x48", "-o", "rendered.png", "--backend"];
        check(&[&render[..], &["cpu"]].concat(), "rendered.png");
        if needs_adapter() {
            check(&[&render[..], &["gpu"]].concat(), "rendered.png");
            check(&["view", "--headless", "--size", "320x200", "--script", "s.jsonl"], "viewed.png");
        }
    }
}

#[test]
fn volumetric_warps_are_as_flags_and_scripts_say() {
    let run = play("{\"do\": \"quit\"}", &["--headless", "--warp-thresholds", "0.5,0.2"], None).1;
    assert!(run.code == 2 && run.stderr.contains("--warp-thresholds"), "{}", run.stderr);
    let five = ["--headless", "--warp-thresholds", "0.1,0.2,0.3,0.4,0.5"];
    let run = play("{\"do\": \"quit\"}", &five, None).1;
    assert!(run.code == 2 && run.stderr.contains("5 layers"), "{}", run.stderr);
    if !needs_adapter() {
        return;
    }
    let script = r#"
{"wait_for": "rest"}
{"do": {"preset": "ramp:0.2..0.6"}}
{"do": {"warp": "volumetric"}}
{"press": "H"}
{"wait_for": "rest"}
{"do": {"save": "view.json"}}
{"do": {"orbit": {"right_deg": 4, "up_deg": 0}}}
{"do": {"screenshot": "few.png"}}
{"wait_for": "rest"}
{"do": {"orbit": {"right_deg": -4, "up_deg": 0}}}
{"wait_for": "rest"}
{"do": {"layers": {"thresholds": [0.5, 1.0], "steps": 64}}}
{"wait_for": "rest"}
{"do": {"orbit": {"right_deg": 4, "up_deg": 0}}}
{"do": {"screenshot": "many.png"}}
{"do": {"save": "again.json"}}
"#;
    let flags = ["--headless", "--size", "320x200", "--warp-thresholds", "0.5,1", "--warp-steps", "1"];
    let (bench, run) = play(script, &flags, None);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let layers = |name: &str| {
        let text = std::fs::read_to_string(bench.path(name)).unwrap();
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["pace"]["layers"].clone()
    };
    assert_eq!(layers("view.json"), serde_json::json!({"thresholds": [0.5, 1.0], "steps": 1}));
    assert_eq!(layers("again.json")["steps"], 64);
    // Beside the messages.
    let middle = |name: &str| image::imageops::crop_imm(&picture(&bench, name), 175, 0, 80, 200).to_image();
    assert!(middle("few.png") != middle("many.png"), "other steps show other pictures");
}

#[test]
fn without_a_display_the_error_says_what_to_do() {
    let (_, run) = play("{\"do\": \"quit\"}", &[], None);
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("DISPLAY") && run.stderr.contains("wheatstone render"), "{}", run.stderr);
}

#[test]
fn scripts_and_files_that_are_no_good_are_refused() {
    let (_, run) = play("{\"do\": \"dance\"}", &["--headless"], None);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("line 1"), "{}", run.stderr);
    let bench = Bench::new();
    assert_eq!(bench.run(&["view", "--headless"]).code, 2);
    std::fs::write(bench.path("bad.json"), "{}").unwrap();
    let run = bench.run(&["view", "bad.json", "--headless", "--soak", "1"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.contains("bad.json"), "{}", run.stderr);
}

#[test]
fn a_raw_file_is_opened_by_flags_whatever_its_name_and_again_by_its_view() {
    if !needs_adapter() {
        return;
    }
    let bench = Bench::new();
    let voxels: Vec<u8> = (0..16 * 16 * 16).map(|index| (index % 16 * 16) as u8).collect();
    std::fs::write(bench.path("ramp.json"), voxels).unwrap();
    let view = |file: &str, script: &str, flags: &[&str]| {
        std::fs::write(bench.path("script.jsonl"), script).unwrap();
        let args = ["view", file, "--headless", "--size", "320x200", "--script", "script.jsonl"];
        let run = bench.run(&[&args, flags].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
    };
    let saving = "{\"wait_for\": \"rest\"}\n{\"do\": {\"orbit\": {\"right_deg\": 40, \"up_deg\": 20}}}\n\
                  {\"do\": {\"save\": \"view.json\"}}";
    view("ramp.json", saving, &["--raw-size", "16x16x16", "--raw-type", "uint8"]);
    let shooting = "{\"wait_for\": \"rest\"}\n{\"press\": \"H\"}\n{\"wait_for\": \"rest\"}\n";
    view("view.json", &format!("{shooting}{{\"do\": {{\"picture\": \"a.png\"}}}}"), &[]);
    let opening = "{\"do\": {\"open\": \"view.json\"}}\n{\"wait_for\": \"rest\"}\n";
    view("sphere.nrrd", &format!("{shooting}{opening}{{\"do\": {{\"picture\": \"b.png\"}}}}"), &[]);
    assert_eq!(picture(&bench, "a.png"), picture(&bench, "b.png"), "the camera is that of the view");
}

/// A display of 3 × 2 views of 32 × 32 pixels.
const SMALL_DISPLAY: &str = r#"{"columns": 3, "rows": 2, "quilt_size_px": [96, 64], "aspect": 1.0, "view_cone_deg": 40.0,
    "focal_distance_m": 0.5, "screen_height_m": 0.16}"#;

/// A calibration of a panel of 192 × 192 pixels for it.
const SMALL_PANEL: &str = r#"{"pitch": {"value": 20}, "slope": {"value": -7}, "center": {"value": 0.3}, "DPI": {"value": 100},
    "screenW": {"value": 192}, "screenH": {"value": 192}, "viewCone": {"value": 40}, "flipImageX": {"value": 1}}"#;

fn as_picture(image: &RgbImage) -> wheatstone_core::image::RgbImage {
    let rgb = image.pixels().map(|pixel| pixel.0.map(|level| f32::from(level) / 255.0)).collect();
    wheatstone_core::image::RgbImage { width: image.width(), height: image.height(), rgb }
}

/// The middle of a picture, of a size.
fn middle(picture: &RgbImage, [width, height]: [u32; 2]) -> RgbImage {
    let [left, top] = [(picture.width() - width) / 2, (picture.height() - height) / 2];
    image::imageops::crop_imm(picture, left, top, width, height).to_image()
}

#[test]
fn a_light_field_display_is_shown_as_it_is_sent_as_it_is_seen_and_as_its_panel_shows_it() {
    use glam::DVec3;
    use wheatstone_core::lightfield::simulator::Eye;
    use wheatstone_core::lightfield::{Lenticular, QuiltDisplay};
    if !needs_adapter() {
        return;
    }
    let one_line = |text: &str| text.replace('\n', "");
    let script = format!(
        r#"
{{"wait_for": "rest"}}
{{"do": {{"display": {}}}}}
{{"do": {{"arrangement": "quilt"}}}}
{{"wait_for": "rest"}}
{{"do": {{"picture": "quilt.png"}}}}
{{"wait_for": "rest"}}
{{"do": {{"arrangement": "light_field"}}}}
{{"do": {{"display_eye": [0.07, 0.02, 0.6]}}}}
{{"wait_for": "rest"}}
{{"do": {{"picture": "seen.png"}}}}
{{"wait_for": "rest"}}
{{"do": {{"calibration": {}}}}}
{{"do": {{"arrangement": "panel"}}}}
{{"wait_for": "rest"}}
{{"do": {{"picture": "panel.png"}}}}
{{"do": {{"save": "view.json"}}}}
{{"wait_for": "rest"}}
{{"do": {{"arrangement": "mono"}}}}
{{"wait_for": "rest"}}
{{"do": {{"open": "view.json"}}}}
{{"wait_for": "rest"}}
{{"do": {{"picture": "again.png"}}}}
{{"wait_for": "rest"}}
{{"do": {{"display": "agus-2008"}}}}
{{"wait_for": "rest"}}
{{"do": {{"picture": "projectors.png"}}}}
"#,
        one_line(SMALL_DISPLAY),
        one_line(SMALL_PANEL)
    );
    let (bench, run) = play(&script, &["--headless"], None);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let display = QuiltDisplay::from_json(SMALL_DISPLAY).unwrap();
    let quilt = as_picture(&middle(&picture(&bench, "quilt.png"), [96, 64]));
    let views = display.views_of(&quilt).unwrap();
    let lit = |view: &wheatstone_core::image::RgbImage| {
        view.rgb.iter().filter(|rgb| rgb.iter().any(|&level| level > 0.25)).count()
    };
    assert!(views.iter().all(|view| lit(view) > 100) && views[0] != views[5]);

    let whole = picture(&bench, "seen.png");
    let side = whole.width().min(whole.height());
    let seen = as_picture(&middle(&whole, [side, side]));
    let eye = Eye::new(DVec3::new(0.07, 0.02, 0.6), [side, side]).unwrap();
    let expected = display.seen_from(&eye, &views).unwrap();
    assert!(furthest(&seen, &expected) < 2.5 / 255.0, "{}", furthest(&seen, &expected));

    let panel = image::imageops::crop_imm(&picture(&bench, "panel.png"), 0, 0, 192, 192).to_image();
    let lenses = Lenticular::from_visual_json(SMALL_PANEL).unwrap();
    let interlaced = lenses.interlace(&display, &quilt).unwrap();
    assert_eq!(panel.into_raw(), interlaced.to_rgb8());
    assert_eq!(picture(&bench, "panel.png"), picture(&bench, "again.png"));
    // Of a display without lenses there is no panel: what the eye sees is shown.
    assert!(lit(&as_picture(&picture(&bench, "projectors.png"))) > 5000);
}

/// Largest difference of a channel.
fn furthest(a: &wheatstone_core::image::RgbImage, b: &wheatstone_core::image::RgbImage) -> f32 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    a.rgb.iter().flatten().zip(b.rgb.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn displays_are_chosen_by_flags_and_an_eye_sees_projectors_as_it_should() {
    use glam::DVec3;
    use wheatstone_core::lightfield::ProjectorArray;
    use wheatstone_core::lightfield::simulator::Eye;
    if !needs_adapter() {
        return;
    }
    let bench = Bench::new();
    let write = |name: &str, text: &str| std::fs::write(bench.path(name), text).unwrap();
    write("small.json", SMALL_DISPLAY);
    write("visual.json", SMALL_PANEL);
    let description = crate::projectors::array().to_string();
    write("array.json", &description);
    let view = |flags: &[&str], script: &str| {
        write("s.jsonl", script);
        let base = ["view", "sphere.nrrd", "--headless", "--size", "640x360", "--script", "s.jsonl"];
        let run = bench.run(&[&base[..], flags].concat());
        assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
    };
    let saves = "{\"wait_for\": \"rest\"}\n{\"do\": {\"save\": \"v.json\"}}\n";
    view(&["--display", "small.json", "--interlace", "visual.json"], saves);
    let saved: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(bench.path("v.json")).unwrap()).unwrap();
    assert_eq!(saved["stereo"]["arrangement"], "panel");
    assert_eq!(saved["light_field"]["display"]["columns"], 3);
    assert_eq!(saved["light_field"]["calibration"]["pitch"]["value"], 20);

    let sees = r#"
{"do": {"display_eye": [0.05, 0.03, 0.7]}}
{"wait_for": "rest"}
{"do": {"picture": "seen.png"}}
{"wait_for": "rest"}
{"do": {"arrangement": "quilt"}}
{"wait_for": "rest"}
{"do": {"picture": "images.png"}}
{"wait_for": "rest"}
"#;
    view(&["--display", "array.json"], sees);
    let array = ProjectorArray::from_json(&description).unwrap();
    // Five beside each other, as in a frame.
    let images = as_picture(&middle(&picture(&bench, "images.png"), [200, 90]));
    let images: Vec<_> = (0..12).map(|n| images.cut([n % 5 * 40, n / 5 * 30], [40, 30])).collect();
    assert!(images[0] != images[11] && images[3] != images[4]);
    let whole = picture(&bench, "seen.png");
    let size = [whole.width(), (f64::from(whole.width()) * 0.75).round() as u32];
    let eye = Eye::new(DVec3::new(0.05, 0.03, 0.7), size).unwrap();
    let (seen, expected) = (as_picture(&middle(&whole, size)), array.seen_from(&eye, &images).unwrap());
    assert!(furthest(&seen, &expected) < 2.5 / 255.0, "{}", furthest(&seen, &expected));
    assert!(expected.rgb.iter().filter(|rgb| rgb[0] > 0.25).count() > 2000);
}

#[test]
fn displays_that_are_none_are_refused_before_anything_is_opened() {
    let bench = Bench::new();
    std::fs::write(bench.path("visual.json"), SMALL_PANEL).unwrap();
    std::fs::write(bench.path("none.json"), r#"{"slope": 1}"#).unwrap();
    std::fs::write(bench.path("s.jsonl"), "{\"do\": \"quit\"}").unwrap();
    for (flags, says) in [
        (&["--display", "tv"][..], "portrait"),
        (&["--display", "missing.json"], "missing.json"),
        (&["--interlace", "none.json"], "none.json: pitch is missing"),
        (&["--interlace", "visual.json"], "the display's aspect is 0.75"),
        (&["--display", "agus-2008", "--interlace", "visual.json"], "has projectors"),
    ] {
        let args = [&["view", "sphere.nrrd", "--headless", "--script", "s.jsonl"], flags].concat();
        let run = bench.run(&args);
        assert_eq!(run.code, 2, "{flags:?}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{flags:?}: {}", run.stderr);
    }
}
