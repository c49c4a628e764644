//! Pictures: what `render` writes, and what `compare` finds in it.

use crate::support::Bench;
use image::ColorType;

#[test]
fn a_picture_is_written_and_is_like_itself() {
    let bench = Bench::new();
    bench.render("a.png", &["--tf", "ramp:0..1"]);
    bench.render("b.png", &["--tf", "ramp:0..1", "--bits", "16"]);
    bench.render("c.png", &["--tf", "viridis"]);
    assert_eq!(bench.png("a.png"), (32, 24, ColorType::Rgb8));
    assert_eq!(bench.png("b.png"), (32, 24, ColorType::Rgb16));
    let same = bench.run(&["compare", "a.png", "a.png", "--json"]).json();
    assert_eq!(same["ssim"], 1.0);
    assert!(same["psnr"].is_null());
    let depths = bench.run(&["compare", "a.png", "b.png", "--json"]).json();
    assert!(depths["max_abs"].as_f64().unwrap() <= 0.5 / 255.0 + 1e-4, "{depths}");
    let other = bench.run(&["compare", "a.png", "c.png", "--json"]).json();
    assert!(other["dssim"].as_f64().unwrap() > 0.001 && other["psnr"].as_f64().unwrap() < 60.0, "{other}");
    let text = bench.run(&["compare", "a.png", "c.png"]);
    assert!(text.stdout.contains("dssim"), "{}", text.stdout);
}

#[test]
fn every_mode_and_shading_makes_a_picture_that_is_not_empty() {
    let bench = Bench::new();
    bench.run(&["phantom", "box", "--size", "8", "-o", "box.nrrd"]);
    let looks: &[&[&str]] = &[
        &[],
        &["--shading", "phong"],
        &["--shading", "shadow"],
        &["--shading", "ambient"],
        &["--shading", "directional:2"],
        &["--preintegrated", "--tf", "ramp:0..1"],
        &["--tf", "ramp:0..1,0..0.1"],
        &["--tf", "ct-bone"],
        &["--mode", "mip"],
        &["--mode", "mean"],
        &["--mode", "xray"],
        &["--mode", "iso"],
        &["--iso", "0.5", "--gradient", "tetrahedron", "--tf", "inferno"],
        &["--orthographic", "1.2", "--iso", "0.5"],
        &["--iso", "0.5", "--up", "a", "--azimuth", "-40", "--elevation", "-20"],
        &["--storage", "32", "--window", "auto", "--ert", "0", "--sampling-factor", "2"],
    ];
    for flags in looks {
        bench.render("look.png", flags);
        let picture = image::open(bench.path("look.png")).unwrap().into_rgb8();
        assert!(picture.pixels().any(|p| p.0.iter().any(|&c| c > 40)), "{flags:?} is black");
    }
}

/// Writes a raw file of 16³ floats: values from 100 to 200 in a ball, and a background.
fn write_ball(bench: &Bench, name: &str, background: f32) {
    let value = |i: usize| {
        let from_middle = |i: usize| (i % 16) as f32 - 7.5;
        let [x, y, z] = [i, i / 16, i / 256].map(from_middle);
        let radius = (x * x + y * y + z * z).sqrt();
        if radius < 6.0 { 200.0 - 16.0 * radius } else { background }
    };
    let bytes: Vec<u8> = (0..4096).flat_map(|i| value(i).to_le_bytes()).collect();
    std::fs::write(bench.path(name), bytes).unwrap();
}

#[test]
fn a_background_of_nan_is_as_clear_as_the_low_end_of_the_window() {
    let bench = Bench::new();
    write_ball(&bench, "nan_16x16x16_float32.raw", f32::NAN);
    write_ball(&bench, "low_16x16x16_float32.raw", -50.0);
    write_ball(&bench, "least_16x16x16_float32.raw", 104.0);
    let looks: &[&[&str]] = &[
        &["--tf", "ramp:0..1"],
        &["--tf", "ramp:0..1", "--shading", "phong", "--preintegrated"],
        &["--mode", "mip"],
        &["--mode", "mean"],
        &["--iso", "0.4"],
    ];
    for flags in looks {
        let render = |name: &str| {
            let (file, output) = (format!("{name}_16x16x16_float32.raw"), format!("{name}.png"));
            let place = ["--backend", "cpu", "--size", "32x24", "--window", "-50..250"];
            let run = bench.run(&[&["render", &file, "-o", &output][..], &place, flags].concat());
            assert_eq!(run.code, 0, "{flags:?} {name}: {}", run.stderr);
            run.stderr
        };
        assert!(render("nan").contains("window's low end"), "{flags:?}: nothing is said of the NaN voxels");
        render("low");
        render("least");
        let dssim = |other: &str| {
            let run = bench.run(&["compare", "nan.png", other, "--json"]);
            run.json()["dssim"].as_f64().unwrap()
        };
        assert!(dssim("low.png") < 1e-6, "{flags:?}: {}", dssim("low.png"));
        assert!(dssim("least.png") > 1e-3, "{flags:?}: {}", dssim("least.png"));
    }
}

#[test]
fn skipping_changes_no_picture() {
    let bench = Bench::new();
    for look in [
        &["--tf", "ramp:0.5..1"][..],
        &["--tf", "ramp:0.3..1,0.05..0.2"],
        &["--mode", "mip"],
        &["--iso", "0.5"],
    ] {
        bench.render("none.png", &[&["--skip", "none"], look].concat());
        for structure in ["auto", "occupancy", "distance", "anisotropic"] {
            bench.render("skip.png", &[&["--skip", structure], look].concat());
            let same = bench.run(&["compare", "none.png", "skip.png", "--json"]).json();
            assert_eq!(same["max_abs"], 0.0, "{look:?} {structure}");
        }
    }
}

#[test]
fn a_heat_map_is_white_where_most_is_read() {
    let bench = Bench::new();
    let heat_map = |show: &str, skip: &str| {
        let flags = ["--show", show, "--skip", skip, "--tf", "ramp:0.5..1", "--ert", "0", "--json"];
        let white = bench.render("heat.png", &flags).json()["white"].as_u64().unwrap();
        (white, image::open(bench.path("heat.png")).unwrap().into_rgb8())
    };
    let (white, base) = heat_map("samples", "none");
    assert!((24..=48).contains(&white), "{white} samples through 24 voxels");
    assert_eq!(base.get_pixel(0, 0).0, [0; 3]);
    assert!(base.pixels().any(|pixel| pixel.0 == [255; 3]));
    let sum = |picture: &image::RgbImage| picture.pixels().map(|pixel| u64::from(pixel.0[0])).sum::<u64>();
    let (same_white, skipping) = heat_map(&format!("samples:{white}"), "distance");
    assert_eq!(same_white, white);
    assert!(sum(&skipping) < sum(&base) && sum(&skipping) > 0);
}

#[test]
fn heat_maps_of_a_turntable_have_one_scale() {
    let bench = Bench::new();
    let white = |flags: &[&str]| {
        let heat_map = ["--show", "samples", "--skip", "none", "--json"];
        bench.render("h.png", &[&heat_map[..], flags].concat()).json()["white"].as_u64().unwrap()
    };
    let alone = ["0", "120", "240"].map(|azimuth| white(&["--azimuth", azimuth]));
    assert_ne!(alone[0], alone[1], "the rays of a turned cube are longer");
    assert_eq!(Some(white(&["--turntable", "3"])), alone.into_iter().max());
    let is_white = |name| {
        let picture = image::open(bench.path(name)).unwrap().into_rgb8();
        picture.pixels().any(|pixel| pixel.0 == [255; 3])
    };
    assert!(!is_white("h_0000.png") && (is_white("h_0001.png") || is_white("h_0002.png")));
}

#[test]
fn clipping_and_background_show() {
    let bench = Bench::new();
    let at = |name: &str, x, y| image::open(bench.path(name)).unwrap().into_rgb8().get_pixel(x, y).0;
    bench.render("all.png", &["--iso", "0.5", "--background", "0000ff"]);
    bench.render("box.png", &["--iso", "0.5", "--clip-box", "0..0.4,0..1,0..1"]);
    bench.render("plane.png", &["--iso", "0.5", "--clip-plane", "-1,0,0,0.1"]);
    assert_eq!(at("all.png", 0, 0), [0, 0, 255]);
    assert_ne!(at("all.png", 18, 12), [0, 0, 255]);
    // From the front the patient's right hand is on the left, where texture x is large.
    assert_eq!(at("box.png", 12, 12), [0, 0, 0]);
    assert_ne!(at("box.png", 20, 12), [0, 0, 0]);
    assert_ne!(at("plane.png", 12, 12), [0, 0, 0]);
    assert_eq!(at("plane.png", 20, 12), [0, 0, 0]);
}

#[test]
fn stereo_layouts_have_their_sizes_and_sides() {
    let bench = Bench::new();
    let stereo = |name: &str, layout: &str, convergence: &str| {
        bench.render(name, &["--iso", "0.5", "--stereo", layout, "--convergence", convergence]);
        image::open(bench.path(name)).unwrap().into_rgb8()
    };
    let side = stereo("side.png", "side-by-side", "inf");
    let top = stereo("top.png", "top-bottom", "inf");
    let anaglyph = stereo("anaglyph.png", "anaglyph", "1.7");
    let (left, right) = (stereo("left.png", "left", "inf"), stereo("right.png", "right", "inf"));
    assert_eq!(side.dimensions(), (64, 24));
    assert_eq!(top.dimensions(), (32, 48));
    assert_eq!(anaglyph.dimensions(), (32, 24));
    assert_eq!(left.dimensions(), (32, 24));
    for (x, y, pixel) in left.enumerate_pixels() {
        assert_eq!(pixel, side.get_pixel(x, y));
        assert_eq!(pixel, top.get_pixel(x, y));
        assert_eq!(right.get_pixel(x, y), side.get_pixel(x + 32, y));
        assert_eq!(right.get_pixel(x, y), top.get_pixel(x, y + 24));
    }
    // With parallel eyes everything lies further left for the right eye.
    let centre = |picture: &image::RgbImage| {
        let lit: Vec<f64> = picture
            .enumerate_pixels()
            .filter(|(_, _, p)| p.0 != [0, 0, 0])
            .map(|(x, _, _)| f64::from(x))
            .collect();
        lit.iter().sum::<f64>() / lit.len() as f64
    };
    assert!(centre(&left) > centre(&right) + 0.5, "{} {}", centre(&left), centre(&right));
}

#[test]
fn a_wobble_shows_the_left_eye_then_the_right_one() {
    use image::AnimationDecoder as _;
    let bench = Bench::new();
    let parallel = ["--iso", "0.5", "--eye-distance", "0.2"];
    bench.render("w.gif", &[&["--stereo", "wobble"], &parallel[..]].concat());
    bench.render("side.png", &[&["--stereo", "side-by-side"], &parallel[..]].concat());
    let side = image::open(bench.path("side.png")).unwrap().into_rgb8();
    let file = std::io::BufReader::new(std::fs::File::open(bench.path("w.gif")).unwrap());
    let frames = image::codecs::gif::GifDecoder::new(file).unwrap().into_frames().collect_frames().unwrap();
    assert_eq!(frames.len(), 2);
    for (eye, frame) in frames.iter().enumerate() {
        assert_eq!(frame.buffer().dimensions(), (32, 24));
        for (x, y, pixel) in frame.buffer().enumerate_pixels() {
            let own = side.get_pixel(x + 32 * eye as u32, y).0;
            let difference = (0..3).map(|c| own[c].abs_diff(pixel.0[c])).max().unwrap();
            assert!(difference <= 8, "eye {eye}: {own:?} is {:?}", pixel.0);
        }
    }
    bench.render("t.gif", &["--stereo", "wobble", "--turntable", "2", "--iso", "0.5"]);
    assert_eq!(bench.files(), ["side.png", "sphere.nrrd", "t_0000.gif", "t_0001.gif", "w.gif"]);
}

#[test]
fn what_one_cast_cannot_make_two_casts_do() {
    let bench = Bench::new();
    let pair = ["--stereo", "side-by-side", "--stereo-method", "strips", "--json"];
    let run = bench.render("cpu.png", &pair);
    assert!(run.stderr.contains("note: ") && run.stderr.contains("CPU renderer"), "{}", run.stderr);
    assert_eq!(run.json()["stereo_method"], "two-pass");
    let auto = bench.render("auto.png", &["--stereo", "side-by-side", "--json"]);
    assert!(auto.stderr.is_empty(), "{}", auto.stderr);
    let same = bench.run(&["compare", "cpu.png", "auto.png", "--json"]).json();
    assert_eq!(same["max_abs"], 0.0);
}

#[test]
fn one_cast_makes_both_eyes_on_the_gpu() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = Bench::new();
    let render = |output: &str, flags: &[&str]| {
        let base = ["render", "sphere.nrrd", "-o", output, "--size", "64x48", "--stereo", "top-bottom"];
        let look = ["--tf", "ramp:0.2..1", "--convergence", "1.7", "--json"];
        let run = bench.run(&[&base[..], &look, flags].concat());
        assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
        run
    };
    let two_pass = render("two.png", &["--backend", "gpu", "--stereo-method", "two-pass"]).json();
    assert_eq!(two_pass["stereo_method"], "two-pass");
    let ways = [
        ("strips", "repaired", "left", 0),
        ("strips", "repaired", "right", 48),
        ("tiles", "fast", "right", 48),
        ("layers", "fast", "left", 0),
        ("layers-16", "fast", "left", 0),
        ("volumetric", "fast", "left", 0),
        ("volumetric", "fast", "right", 48),
    ];
    for (method, quality, eye, half) in ways {
        // Asked for by name, a pair of one cast is made on a GPU, software or not.
        let one = render("one.png", &["--stereo-method", method, "--reference-eye", eye]).json();
        assert_eq!((&one["backend"], &one["stereo_method"]), (&"gpu".into(), &method.into()), "{one}");
        assert_eq!((&one["stereo_quality"], &one["reference_eye"]), (&quality.into(), &eye.into()));
        assert!(one["stereo_bytes"].as_u64().unwrap() > 0, "{one}");
        let compared = bench.run(&["compare", "two.png", "one.png", "--json"]).json();
        assert!(compared["dssim"].as_f64().unwrap() <= 0.01, "{compared}");
        let [two, one] =
            ["two.png", "one.png"].map(|name| image::open(bench.path(name)).unwrap().into_rgb8());
        for (a, b) in two.rows().zip(one.rows()).skip(half).take(48) {
            assert!(a.zip(b).all(|(a, b)| (0..3).all(|c| a.0[c].abs_diff(b.0[c]) <= 1)), "{method} {eye}");
        }
    }
    let same_eyes = render("zero.png", &["--stereo-method", "strips", "--eye-distance", "0"]).json();
    assert_eq!(same_eyes["stereo_method"], "strips");
    let xray = render("xray.png", &["--backend", "gpu", "--mode", "xray"]).json();
    assert_eq!((&xray["stereo_method"], &xray["stereo_quality"]), (&"strips".into(), &"repaired".into()));
    let fast = render("fast.png", &["--stereo-method", "strips", "--stereo-quality", "fast"]).json();
    assert_eq!(fast["stereo_quality"], "fast");
    let mip = ["--backend", "gpu", "--mode", "mip"];
    let silent = render("mip.png", &mip);
    assert!(
        !silent.stderr.contains("note: ") && silent.json()["stereo_method"] == "two-pass",
        "{}",
        silent.stderr
    );
    let noted = render("mip.png", &[&mip[..], &["--stereo-method", "strips"]].concat());
    assert!(noted.stderr.contains("note: strips cannot make this pair"), "{}", noted.stderr);
    assert_eq!(noted.json()["stereo_method"], "two-pass");
    let inside = render("inside.png", &["--stereo-method", "strips", "--distance", "0.1"]);
    assert!(inside.stderr.contains("rays of both eyes are alike from 0.130 m on"), "{}", inside.stderr);
    assert_eq!(inside.json()["stereo_method"], "two-pass");
}

#[test]
fn a_turntable_is_a_numbered_sequence() {
    let bench = Bench::new();
    let run = bench.render("t.png", &["--turntable", "4", "--iso", "0.5", "--distance", "1.5", "--json"]);
    assert_eq!(bench.files(), ["sphere.nrrd", "t_0000.png", "t_0001.png", "t_0002.png", "t_0003.png"]);
    let json = run.json();
    assert_eq!(json["frames_ms"].as_array().unwrap().len(), 4);
    assert_eq!(json["outputs"].as_array().unwrap().len(), 4);
    let quarter = bench.render("q.png", &["--azimuth", "90", "--iso", "0.5", "--distance", "1.5"]);
    assert!(quarter.stderr.contains("cpu"), "{}", quarter.stderr);
    let same = bench.run(&["compare", "q.png", "t_0001.png", "--json"]).json();
    assert_eq!(same["max_abs"], 0.0);
}

#[test]
fn the_gpu_makes_the_same_picture() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = Bench::new();
    let looks: [&[&str]; 3] = [
        &["--shading", "phong", "--stereo", "top-bottom", "--azimuth", "20", "--tf", "generic"],
        &["--tf", "ramp:0.3..1,0.05..0.2", "--skip", "distance"],
        &["--tf", "ramp:0.3..1,0.05..0.2", "--skip", "distance", "--gradient-map", "none"],
    ];
    for look in looks {
        // By default the blocks of a volume this small differ.
        let look = &[look, &["--block-size", "4"]].concat();
        let cpu = bench.render("cpu.png", &[&["--json"], &look[..]].concat()).json();
        let gpu = ["render", "sphere.nrrd", "-o", "gpu.png", "--backend", "gpu", "--size", "32x24", "--json"];
        let run = bench.run(&[&gpu[..], &look[..]].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        let gpu = run.json();
        assert_eq!(gpu["backend"], "gpu");
        assert_eq!(gpu["gradient_map"]["bits"], cpu["gradient_map"]["bits"], "{look:?}");
        let occupied = [&cpu, &gpu].map(|json| json["skip"]["occupied_fraction"].as_f64());
        assert!(
            occupied[0].zip(occupied[1]).is_none_or(|(cpu, gpu)| (cpu - gpu).abs() <= 0.02),
            "{look:?}: {occupied:?}"
        );
        let compared = bench.run(&["compare", "cpu.png", "gpu.png", "--json"]).json();
        assert!(compared["dssim"].as_f64().unwrap() <= 0.002, "{look:?}: {compared}");
    }
}

#[test]
fn the_gpu_skips_without_changing_the_picture() {
    if std::env::var_os("WHEATSTONE_SKIP_GPU_TESTS").is_some() {
        return;
    }
    let bench = Bench::new();
    let render = |output: &str, flags: &[&str]| {
        let gpu = ["render", "sphere.nrrd", "-o", output, "--backend", "gpu", "--size", "32x24", "--json"];
        let run = bench.run(&[&gpu[..], &["--ert", "0"], flags].concat());
        assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
        run.json()
    };
    let looks: [(&[&str], &str); 4] = [
        (&["--tf", "ramp:0.5..1"], "anisotropic"),
        (&["--tf", "ramp:0.3..1,0.05..0.2"], "anisotropic"),
        (&["--tf", "ramp:0.3..1,0.05..0.2", "--gradient-map", "16"], "anisotropic"),
        (&["--mode", "mip"], "ranges"),
    ];
    for (look, structure) in looks {
        let base = render("none.png", &[&["--skip", "none"], look].concat());
        let skipped = render("auto.png", &[&["--block-size", "2"], look].concat());
        assert_eq!(skipped["skip"]["structure"], structure, "{look:?}");
        assert!(skipped["samples"].as_u64() < base["samples"].as_u64(), "{look:?}");
        let same = bench.run(&["compare", "none.png", "auto.png", "--json"]).json();
        assert!(same["max_abs"].as_f64().unwrap() <= 1.0 / 255.0 + 1e-6, "{look:?}: {same}");
    }
    let heat_map = render("heat.png", &["--show", "samples"]);
    assert!(heat_map["white"].as_u64().unwrap() > 0);
}
