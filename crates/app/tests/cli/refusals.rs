//! Bad input and bad usage: exit code 2, a line that says why, nothing written.

use crate::support::Bench;

/// Runs `render` with flags and checks that it is refused with a message, and that nothing was written.
fn refuses(bench: &Bench, flags: &[&str], says: &str) {
    let before = bench.files();
    let run = bench.try_render("x.png", flags);
    assert_eq!(run.code, 2, "{flags:?}: {}", run.stderr);
    assert!(run.stderr.starts_with("error: "), "{flags:?}: {}", run.stderr);
    assert!(run.stderr.contains(says), "{flags:?} does not say {says:?}: {}", run.stderr);
    assert!(run.stdout.is_empty(), "{flags:?}");
    assert_eq!(bench.files(), before, "{flags:?}");
}

#[test]
fn impossible_values_name_their_flag_and_range() {
    let bench = Bench::new();
    let cases: &[(&[&str], &str)] = &[
        (&["--size", "0x10"], "--size"),
        (&["--size", "100000x100000"], "16384"),
        (&["--size", "10"], "WIDTHxHEIGHT"),
        (&["--distance", "-1"], "from 0 to 1000"),
        (&["--distance", "nan"], "--distance"),
        (&["--fov", "3.2"], "below pi"),
        (&["--fov", "0"], "--fov"),
        (&["--elevation", "91"], "from -90 to 90"),
        (&["--azimuth", "inf"], "--azimuth"),
        (&["--sampling-factor", "0"], "from 0.01 to 32"),
        (&["--sampling-factor", "-1"], "--sampling-factor"),
        (&["--sampling-factor", "1000"], "--sampling-factor"),
        (&["--ert", "1.5"], "from 0 to 1"),
        (&["--eye-distance", "-0.1"], "from 0 to 1"),
        (&["--eye-distance", "50"], "--eye-distance"),
        (&["--convergence", "0"], "inf or"),
        (&["--shading", "directional:65"], "from 0 to 64"),
        (&["--shading", "gouraud"], "phong"),
        (&["--window", "5..5"], "LO below HI"),
        (&["--window", "9..-5"], "--window"),
        (&["--window", "nan..1"], "--window"),
        (&["--iso", "1.5"], "from 0 to 1"),
        (&["--iso", "-0.5"], "--iso"),
        (&["--frames", "0"], "1..=10000"),
        (&["--turntable", "0"], "--turntable"),
        (&["--background", "red"], "RRGGBB"),
        (&["--tf", "no-such-preset"], "ct-bone"),
        (&["--tf", "ramp:1..0"], "V0 <= V1"),
        (&["--tf", "missing.json"], "missing.json"),
        (&["--clip-box", "0..1,0..0,0..1"], "--clip-box"),
        (&["--clip-plane", "0,0,0,1"], "normal"),
        (&["--orthographic", "0"], "--orthographic"),
        (&["--up", "Q"], "--up"),
        (&["--backend", "abacus"], "--backend"),
        (&["--bits", "12"], "--bits"),
        (&["--skip", "octree"], "anisotropic"),
        (&["--block-size", "1"], "from 2 to 16"),
        (&["--block-size", "17"], "from 2 to 16"),
        (&["--block-size", "-4"], "--block-size"),
        (&["--gradient-map", "12"], "--gradient-map"),
        (&["--stereo-method", "layers-of-cake"], "two-pass"),
        (&["--stereo-quality", "perfect"], "repaired"),
        (&["--reference-eye", "third"], "left"),
        (&["--show", "depth"], "samples"),
        (&["--show", "samples:0"], "above 0"),
        (&["--no-such-flag"], "--no-such-flag"),
    ];
    for (flags, says) in cases {
        refuses(&bench, flags, says);
    }
}

#[test]
fn contradictions_are_refused() {
    let bench = Bench::new();
    refuses(&bench, &["--mode", "mip", "--iso", "0.5"], "--iso needs --mode iso");
    refuses(&bench, &["--mode", "mip", "--shading", "phong"], "--shading needs");
    refuses(&bench, &["--mode", "mip", "--preintegrated"], "--preintegrated needs");
    refuses(&bench, &["--preintegrated", "--tf", "ramp:0..1,0..1"], "one dimension");
    refuses(&bench, &["--level-of-detail", "--mode", "mip"], "--level-of-detail needs --mode dvr");
    refuses(&bench, &["--level-of-detail=2", "--tf", "ramp:0..1,0..1"], "one dimension");
    let strips = ["--stereo", "anaglyph", "--stereo-method", "strips", "--level-of-detail"];
    refuses(&bench, &strips, "--level-of-detail needs a cast of each eye");
    refuses(&bench, &["--orthographic", "1", "--stereo", "anaglyph"], "--stereo needs a perspective");
    refuses(&bench, &["--stereo-method", "two-pass"], "--stereo-method needs --stereo side-by-side");
    refuses(&bench, &["--stereo-quality", "fast", "--stereo", "left"], "--stereo-quality needs --stereo");
    refuses(&bench, &["--reference-eye", "right", "--stereo", "right"], "--reference-eye needs --stereo");
    let layers = ["--stereo", "anaglyph", "--stereo-method", "layers", "--stereo-quality", "repaired"];
    refuses(&bench, &layers, "only strips are repaired");
    let warp = ["--stereo", "anaglyph", "--stereo-method", "volumetric", "--stereo-quality", "nearest"];
    refuses(&bench, &warp, "a warp has one quality");
    let heat_map = ["--show", "samples", "--stereo", "anaglyph", "--stereo-method", "strips"];
    refuses(&bench, &heat_map, "two-pass");
    refuses(&bench, &["--stereo", "wobble"], ".gif");
    refuses(&bench, &["--orthographic", "1", "--fov", "1"], "--fov");
    refuses(&bench, &["--turntable", "2", "--frames", "2"], "--frames");
    refuses(&bench, &["--raw-size", "4x4x4"], "--raw-type");
    refuses(&bench, &["--skip", "none", "--block-size", "4"], "--block-size needs a --skip");
}

#[test]
fn bad_files_are_refused() {
    let bench = Bench::new();
    std::fs::write(bench.path("empty.nrrd"), []).unwrap();
    std::fs::write(bench.path("noise.nii"), b"not a volume at all").unwrap();
    let whole = std::fs::read(bench.path("sphere.nrrd")).unwrap();
    std::fs::write(bench.path("short.nrrd"), &whole[..whole.len() / 2]).unwrap();
    std::fs::write(bench.path("huge_1048576x1048576x1_uint8.raw"), [0; 8]).unwrap();
    std::fs::write(bench.path("tf.json"), "{}").unwrap();
    let before = bench.files();
    for file in
        ["empty.nrrd", "noise.nii", "short.nrrd", "huge_1048576x1048576x1_uint8.raw", "missing.nrrd", "."]
    {
        let render = ["render", file, "-o", "x.png"];
        for args in [
            &["info", file][..],
            &render,
            &["bench", "cast", file],
            &["bench", "skip", file],
            &["bench", "stereo", file],
            &["bench", "warp", file],
        ] {
            let run = bench.run(args);
            assert_eq!(run.code, 2, "{args:?}: {}", run.stderr);
            let errors: Vec<&str> = run.stderr.lines().filter(|line| line.starts_with("error: ")).collect();
            assert!(errors.len() == 1 && errors[0].contains(file), "{args:?}: {}", run.stderr);
        }
    }
    refuses(&bench, &["--tf", "tf.json"], "tf.json");
    assert_eq!(bench.run(&["compare", "noise.nii", "noise.nii"]).code, 2);
    assert_eq!(bench.files(), before);
}

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_work() {
    let bench = Bench::new();
    std::fs::create_dir(bench.path("folder.png")).unwrap();
    std::fs::write(bench.path("file"), []).unwrap();
    let before = bench.files();
    let wobble = bench.try_render("x.gif", &["--stereo", "wobble", "--bits", "16"]);
    assert!(wobble.code == 2 && wobble.stderr.contains("--bits 16"), "{}", wobble.stderr);
    for (output, says) in [
        ("x.gif", ".png"),
        ("no/such/x.png", "no/such: no such folder"),
        ("x.jpg", ".png"),
        ("folder.png", "folder.png"),
    ] {
        let run = bench.try_render(output, &[]);
        assert_eq!(run.code, 2, "{output}: {}", run.stderr);
        assert!(run.stderr.contains(says), "{output}: {}", run.stderr);
    }
    for args in [
        &["phantom", "sphere", "--size", "8", "-o", "x.raw"][..],
        &["phantom", "sphere", "--size", "8", "-o", "no/x.nrrd"],
        &["phantom", "sphere", "--size", "0", "-o", "x.nrrd"],
        &["phantom", "cube", "-o", "x.nrrd"],
        &["demo", "-o", "file"],
        &["bench", "skip", "beetle:8", "--plot", "file"],
        &["bench", "stereo", "box:8", "--error-pictures", "file"],
        &["bench", "stereo", "box:8", "--distance", "far"],
        &["bench", "stereo", "box:8", "--shading-samples", "6"],
        &["bench", "stereo", "box:8", "--methods", "two-pass"],
        &["bench", "stereo", "box:8", "--methods", "tiles", "--qualities", "repaired"],
        &["bench", "stereo"],
        &["bench", "warp"],
        &["bench", "warp", "box:8", "--warp-ms", "12"],
        &["bench", "warp", "box:8", "--warps", "sheet"],
        &["bench", "warp", "box:8", "--render-ms", "0"],
        &["bench", "warp", "box:8", "--live", "0"],
        &["bench", "warp", "box:8", "--live", "--render-ms", "30"],
        &["bench", "warp", "box:8", "--plot", "file"],
        &["bench", "warp", "box:8", "--warp-thresholds", "0.5,0.1"],
        &["bench", "warp", "box:8", "--warp-thresholds", "0.1,0.2,0.3,0.4,0.5,0.6,0.7,0.8,0.9"],
        &["bench", "warp", "box:8", "--warp-steps", "0"],
        &["bench", "skip", "beetle:0"],
        &["bench", "skip", "beetle:8", "--block-sizes", "4,99"],
    ] {
        let run = bench.run(args);
        assert_eq!(run.code, 2, "{args:?}: {}", run.stderr);
    }
    assert_eq!(bench.files(), before);
}

#[test]
fn what_is_read_is_not_replaced() {
    let bench = Bench::new();
    let files =
        ["q_qs3x2a1.png", "walk_0001.png", "v.png", "v_qs8x6a0.75.png", "v_0003.png", "r.jsonl", "d.json"];
    for file in files {
        std::fs::write(bench.path(file), [7; 64]).unwrap();
    }
    std::fs::create_dir(bench.path("sub")).unwrap();
    let before = bench.files();
    let raw = |command, file, output| {
        [command, file, "--raw-size", "4x4x4", "--raw-type", "uint8", "--backend", "cpu", "-o", output]
    };
    for args in [
        &["simulate", "q_qs3x2a1.png", "-o", "sub/../q_qs3x2a1.png"][..],
        &["simulate", "walk_0001.png", "-o", "walk.png", "--walk", "0,0,1"],
        &["calibrate", "r.jsonl", "--display", "d.json", "-o", "./d.json"],
        &["calibrate", "d.json", "-o", "d.json"],
        &raw("render", "v.png", "./v.png"),
        &raw("quilt", "v_qs8x6a0.75.png", "v.png"),
        &raw("projectors", "v_0003.png", "v.png"),
        &["vr", "sphere.nrrd", "--headset", "none", "--replay", "r.jsonl", "--record", "r.jsonl"],
    ] {
        let run = bench.run(args);
        assert!(run.code == 2 && run.stderr.contains("would be replaced"), "{args:?}: {}", run.stderr);
        assert_eq!(bench.files(), before, "{args:?}");
    }
    assert!(files.iter().all(|file| std::fs::read(bench.path(file)).unwrap() == [7; 64]));
}

#[test]
fn pictures_of_different_sizes_are_not_compared() {
    let bench = Bench::new();
    bench.render("a.png", &[]);
    bench.render("b.png", &["--size", "8x8"]);
    let run = bench.run(&["compare", "a.png", "b.png"]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("32×24") && run.stderr.contains("8×8"), "{}", run.stderr);
}

/// A PNG file of 8-bit colour that ends where its pixels would begin; the last word of its header is the checksum.
fn png_without_pixels(side: u32, checksum: u32) -> Vec<u8> {
    let sides = [side, side].map(u32::to_be_bytes).concat();
    let header = [&b"IHDR"[..], &sides, &[8, 2, 0, 0, 0], &checksum.to_be_bytes()].concat();
    let data = [&[0, 0, 0, 10][..], b"IDAT", &[0x78, 0x9c]].concat();
    [&b"\x89PNG\r\n\x1a\n"[..], &[0, 0, 0, 13], &header, &data].concat()
}

#[test]
fn pictures_too_large_to_decode_are_refused_by_their_header() {
    let bench = Bench::new();
    // 2²⁷ pixels are a square of 11,585.2.
    for (side, checksum, is_too_large) in [(11_585, 0xe2f7_c49e, false), (11_586, 0x8f54_0d33, true)] {
        std::fs::write(bench.path("large.png"), png_without_pixels(side, checksum)).unwrap();
        let run = bench.run(&["compare", "large.png", "large.png"]);
        assert_eq!(run.code, 2, "{}", run.stderr);
        assert!(run.stderr.starts_with("error: large.png: "), "{}", run.stderr);
        assert_eq!(run.stderr.contains("at most 134217728 pixels"), is_too_large, "{side}: {}", run.stderr);
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_is_no_picture_and_is_not_waited_for() {
    let bench = Bench::new();
    let made = std::process::Command::new("mkfifo").arg(bench.path("pipe.png")).status().unwrap();
    assert!(made.success());
    let run = bench.run(&["compare", "pipe.png", "pipe.png"]);
    assert_eq!(run.code, 2, "{}", run.stderr);
    assert!(run.stderr.starts_with("error: pipe.png: not a file"), "{}", run.stderr);
}
