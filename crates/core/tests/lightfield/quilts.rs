//! Quilts: where views are, what the files are called, and how far things may be from the screen.

use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::quilt::{Model, QuiltName, Sampling};
use wheatstone_core::lightfield::{ProjectorArray, QuiltDisplay};

fn sampling() -> impl Strategy<Value = Sampling> {
    prop::sample::select(vec![Sampling::Middles, Sampling::Ends])
}

#[test]
fn models_have_their_published_quilts() {
    let quilt = |model: Model| {
        let display = model.display().checked().unwrap();
        (display.columns, display.rows, display.quilt_size_px, (display.aspect * 1e4).round() / 1e4)
    };
    assert_eq!(quilt(Model::Portrait), (8, 6, [3360, 3360], 0.75));
    assert_eq!(quilt(Model::Go), (11, 6, [4092, 4092], 0.5625));
    assert_eq!(quilt(Model::Inch16Landscape), (7, 7, [5999, 5999], 1.7778));
    assert_eq!(quilt(Model::Inch32), (5, 9, [8192, 8192], 1.7778));
    for &model in Model::ALL {
        model.display().checked().unwrap();
        assert_eq!(model.name().parse(), Ok(model));
    }
    assert_eq!(Model::Portrait.display().tile_size_px(), [420, 560]);
    let fault = "8k".parse::<Model>().unwrap_err().to_string();
    assert!(fault.starts_with("no display is called \"8k\"; there are portrait, go,"), "{fault}");
}

#[test]
fn the_first_view_is_the_bottom_left_tile_and_the_leftmost_camera() {
    let display = Model::Portrait.display();
    assert_eq!(display.tile_px(0), [0, 3360 - 560]);
    assert_eq!(display.tile_px(7), [7 * 420, 3360 - 560]);
    assert_eq!(display.tile_px(8), [0, 3360 - 2 * 560]);
    assert_eq!(display.tile_px(47), [7 * 420, 0]);
    for sampling in [Sampling::Middles, Sampling::Ends] {
        let x_m: Vec<f64> = display
            .views(sampling, DAffine3::IDENTITY)
            .iter()
            .map(|view| view.view_from_world.inverse().translation.x)
            .collect();
        assert!(x_m.windows(2).all(|pair| pair[0] < pair[1]));
        assert!((x_m[0] + x_m[47]).abs() < 1e-12);
        let end_rad = (x_m[47] / display.focal_distance_m).atan();
        let share = if sampling == Sampling::Ends { 1.0 } else { 47.0 / 48.0 };
        assert!((end_rad - share * 20.0_f64.to_radians()).abs() < 1e-12);
    }
}

proptest! {
    #[test]
    fn all_views_see_the_screen_from_edge_to_edge(sampling in sampling(), index in 0_usize..48, corner in 0_usize..4) {
        let display = Model::Portrait.display();
        let view = display.views(sampling, DAffine3::IDENTITY)[index];
        let [width_m, height_m] = display.screen_size_m();
        let [right, up] = [corner & 1, corner >> 1].map(|side| side as f64);
        let at = view.pixel_position(DVec3::new((right - 0.5) * width_m, (up - 0.5) * height_m, 0.0)).unwrap();
        prop_assert!((at.x - right * 420.0).abs() < 1e-9 && (at.y - (1.0 - up) * 560.0).abs() < 1e-9, "{}", at);
    }

    #[test]
    fn within_the_depth_range_things_move_by_no_more_than_was_asked(sampling in sampling(), most_px in 0.1_f64..4.0, x in -0.03_f64..0.03) {
        let display = Model::Portrait.display();
        let range = display.depth_range(sampling, most_px);
        let views = display.views(sampling, DAffine3::IDENTITY);
        let largest_step_px = |z: f64| {
            let at: Vec<f64> = views.iter().map(|view| view.pixel_position(DVec3::new(x, 0.0, z)).unwrap().x).collect();
            at.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
        };
        prop_assert!((largest_step_px(range.before_m) - most_px).abs() < 1e-6);
        prop_assert!((display.disparity_px(sampling, range.before_m) - most_px).abs() < 1e-6);
        prop_assert!(largest_step_px(0.5 * range.before_m) < most_px);
        if range.behind_m.is_finite() {
            prop_assert!((largest_step_px(-range.behind_m) - most_px).abs() < 1e-6);
            prop_assert!((display.disparity_px(sampling, -range.behind_m) + most_px).abs() < 1e-6);
        } else {
            prop_assert!(largest_step_px(-100.0) < most_px);
        }
    }

    #[test]
    fn names_are_read_as_they_are_written(stem in "[A-Za-z0-9_. -]{0,12}", columns in 1_u32..30, rows in 1_u32..30, aspect in 1_u32..40_000) {
        let name = QuiltName { stem, columns, rows, aspect: f64::from(aspect) / 1e4 };
        prop_assert_eq!(name.to_string().parse(), Ok(name));
    }

    #[test]
    fn no_name_makes_reading_it_fail_but_with_an_error(name in ".{0,40}") {
        let _ = name.parse::<QuiltName>();
        let _ = format!("{name}_qs{name}x{name}a{name}").parse::<QuiltName>();
    }
}

#[test]
fn names_are_those_that_players_know() {
    let display = Model::Portrait.display();
    assert_eq!(QuiltName::of(&display, "bonsai").to_string(), "bonsai_qs8x6a0.75");
    assert_eq!(QuiltName::of(&Model::Inch16.display(), "head").to_string(), "head_qs5x9a1.7778");
    let read = |name: &str| name.parse::<QuiltName>().unwrap();
    assert_eq!(read("image_qs5x9a1.77z1.2f0.0").aspect, 1.77);
    assert_eq!(read("A_qs1x1_QS8x6a0.75").stem, "A_qs1x1");
    assert_eq!(read("a_qs8x6a0.75_v2.3"), read("a_qs8x6a0.75"));
    assert_eq!(read("a_qs8x6a0.75_qs5x9a1.77"), read("a_qs8x6a0.75"));
    assert_eq!(read("a_qs8x6a1.5.2").aspect, 1.5);
    for wrong in
        ["bonsai", "a_qs8x6", "a_qs0x6a1", "a_qs8x6a", "a_qs8x6a0", "a_qs-8x6a1", "a_qs8x6a.", "a_qs8x6a-1"]
    {
        assert!(wrong.parse::<QuiltName>().is_err(), "{wrong}");
    }
    assert_eq!(read("a_qs8x6a1e999").aspect, 1.0);
    let fault = "bonsai".parse::<QuiltName>().unwrap_err().to_string();
    assert!(fault.starts_with("\"bonsai\" does not tell what quilts' names do"), "{fault}");
}

#[test]
fn tiles_come_back_and_others_are_refused() {
    let display = QuiltDisplay { columns: 3, rows: 2, quilt_size_px: [10, 9], ..Model::Portrait.display() };
    let view =
        |i: u32| RgbImage { width: 3, height: 4, rgb: (0..12).map(|p| [i as f32, p as f32, 0.5]).collect() };
    let views: Vec<RgbImage> = (0..6).map(view).collect();
    let quilt = display.quilt(&views).unwrap();
    assert_eq!(display.views_of(&quilt).unwrap(), views);
    assert_eq!(quilt.rgb[8 * 10], [0.0, 9.0, 0.5], "bottom left");
    assert_eq!(quilt.rgb[10 + 8], [5.0, 2.0, 0.5], "top right");
    assert_eq!(display.quilt(&views[1..]).unwrap_err().to_string(), "5 views: the quilt has 6 tiles");
    assert_eq!(
        display.views_of(&views[0]).unwrap_err().to_string(),
        "the quilt is of 3x4 pixels: must be of 10x9"
    );
}

#[test]
fn each_fault_of_a_description_is_named() {
    let text = serde_json::to_string(&Model::Portrait.display()).unwrap();
    assert_eq!(QuiltDisplay::from_json(&text).unwrap(), Model::Portrait.display());
    let fault = |part: &str, replacement: &str| {
        assert!(text.contains(part), "{part} is not in {text}");
        QuiltDisplay::from_json(&text.replacen(part, replacement, 1)).unwrap_err().to_string()
    };
    for (found, expected) in [
        (fault("\"columns\":8", "\"columns\":0"), "columns is 0: must be at least 1"),
        (fault("\"columns\":8", "\"columns\":-8"), "invalid value"),
        (fault("\"columns\":8,", ""), "missing field `columns`"),
        (
            fault("\"columns\":8", "\"columns\":4000000000"),
            "the tiles of a quilt: 24000000000 in all, must be at most 1024",
        ),
        (
            fault("[3360,3360]", "[32768,32768]"),
            "quilt_size_px: 1073741824 in all, must be at most 134217728",
        ),
        (fault("\"aspect\":0.75", "\"aspect\":0"), "aspect is 0: must be above 0.01 and below 100"),
        (fault("[3360,3360]", "[3360,5]"), "quilt_size_px[1] is 5: must be at least a pixel for each tile"),
        (
            fault("\"view_cone_deg\":40.0", "\"view_cone_deg\":180"),
            "view_cone_deg is 180: must be above 0 and below 180",
        ),
    ] {
        assert!(found.contains(expected), "{found:?} does not say {expected:?}");
    }
}

proptest! {
    #[test]
    fn at_the_largest_scale_the_outermost_point_is_at_the_edge(
        seed in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0), 1..8),
        before_m in -0.05_f64..0.05,
    ) {
        let display = Model::Portrait.display();
        let [width_m, height_m] = display.screen_size_m();
        let points: Vec<DVec3> = seed.into_iter().map(|(x, y, z)| DVec3::new(x, y, z)).collect();
        let scale = display.largest_scale(points.iter().copied(), before_m);
        prop_assume!(scale < 1.0);
        // In halves of the screen, from its middle.
        let outermost = |scale: f64| {
            let seen = |p: &DVec3| {
                let nearer = display.focal_distance_m / (display.focal_distance_m - before_m - scale * p.z);
                (2.0 * scale * p.x.abs() * nearer / width_m).max(2.0 * scale * p.y.abs() * nearer / height_m)
            };
            points.iter().map(seen).fold(0.0, f64::max)
        };
        prop_assert!((outermost(scale) - 1.0).abs() < 1e-9, "{}", outermost(scale));
    }

    #[test]
    fn a_viewer_who_is_not_in_the_middle_sees_as_much_as_fits(
        seed in prop::collection::vec((-1.0_f64..1.0, -1.0_f64..1.0, -1.0_f64..1.0), 1..8),
        before_m in -0.1_f64..0.1,
        height_m in -0.4_f64..0.4,
    ) {
        let mut description = ProjectorArray::of_paper().description().clone();
        description.viewer.height_m = height_m;
        let array = ProjectorArray::new(description).unwrap();
        let points: Vec<DVec3> = seed.into_iter().map(|(x, y, z)| DVec3::new(x, y, z)).collect();
        let scale = array.largest_scale(points.iter().copied(), before_m);
        // In halves of the screen, from its middle.
        let outermost = |scale: f64| {
            let seen = |p: &DVec3| {
                let at = DVec3::Z * before_m + *p * scale;
                let (x, y) = (at.x / (1.0 - at.z), height_m + (at.y - height_m) / (1.0 - at.z));
                (x.abs() / 0.2).max(y.abs() / 0.15)
            };
            points.iter().map(seen).fold(0.0, f64::max)
        };
        prop_assume!(scale.is_finite() && points.iter().all(|p| before_m + p.z * scale < 0.9));
        prop_assert!((outermost(scale) - 1.0).abs() < 1e-9, "{}", outermost(scale));
    }
}
