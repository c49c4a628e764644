//! Interlaced pictures are, sub-pixel by sub-pixel, what the calibration says.

use proptest::prelude::*;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::lenticular::CellPattern;
use wheatstone_core::lightfield::quilt::Model;
use wheatstone_core::lightfield::{Lenticular, QuiltDisplay};

/// As written by a display of the first generations.
const STRIPES: &str = r#"{"configVersion":"1.0","serial":"00112","pitch":{"value":49.825218200683597},
    "slope":{"value":5.2160325050354},"center":{"value":-0.23396748304367066},"viewCone":{"value":40.0},
    "invView":{"value":1.0},"verticalAngle":{"value":0.0},"DPI":{"value":338.0},"screenW":{"value":96.0},
    "screenH":{"value":60.0},"flipImageX":{"value":0.0},"flipImageY":{"value":0.0},"flipSubp":{"value":0.0}}"#;

/// With sub-pixels that are not stripes, as of the third generation.
const CELLS: &str = r#"{"pitch":44.72,"slope":-7.45,"center":0.1,"viewCone":50,"DPI":283,"screenW":81,"screenH":96,
    "CellPatternMode":{"value":4},"subpixelCells":[
    {"ROffsetX":-0.25,"ROffsetY":-0.31,"GOffsetX":-0.25,"GOffsetY":0.28,"BOffsetX":0.25,"BOffsetY":0},
    {"ROffsetX":0.25,"ROffsetY":-0.31,"GOffsetX":0.25,"GOffsetY":0.28,"BOffsetX":-0.25,"BOffsetY":0}]}"#;

fn display() -> QuiltDisplay {
    QuiltDisplay { columns: 5, rows: 3, quilt_size_px: [5 * 32, 3 * 20], ..Model::Portrait.display() }
}

/// A quilt of which every channel of every pixel is told apart by its level.
fn quilt(display: &QuiltDisplay) -> RgbImage {
    let [width, height] = display.quilt_size_px;
    let level = |i: u32| i as f32 / (3 * width * height) as f32;
    RgbImage {
        width,
        height,
        rgb: (0..width * height).map(|i| [0, 1, 2].map(|c| level(3 * i + c))).collect(),
    }
}

/// The makers' formulas written out once more: the view of a sub-pixel from numbers of the file.
fn direct_view(text: &str, column: u32, row: u32, channel: usize, views: u32) -> u32 {
    let file: serde_json::Value = serde_json::from_str(text).unwrap();
    let number = |name: &str| match &file[name] {
        serde_json::Value::Object(entry) => entry["value"].as_f64().unwrap(),
        other => other.as_f64().unwrap_or(0.0),
    };
    let (width, height) = (number("screenW"), number("screenH"));
    let pitch = number("pitch") * width / number("DPI") * (1.0 / number("slope")).atan().cos();
    let mut tilt = height / (width * number("slope"));
    if number("flipImageX") >= 0.5 {
        tilt = -tilt;
    }
    let from_bottom = height as u32 - 1 - row;
    let (mut x, mut y) = ((f64::from(column) + 0.5) / width, (f64::from(from_bottom) + 0.5) / height);
    let stripe = if number("flipSubp") >= 0.5 { 2 - channel } else { channel };
    if let Some(cells) = file["subpixelCells"].as_array() {
        let cell = match number("CellPatternMode") as u32 {
            0 => 0,
            1 => (column + from_bottom) % 2,
            2 => column % 2,
            3 => (from_bottom + column % 2 * 2) % 4,
            _ => from_bottom % 2,
        };
        let offset = |axis: &str| {
            cells[cell as usize][format!("{}Offset{axis}", ["R", "G", "B"][stripe])].as_f64().unwrap()
        };
        x += offset("X") / width;
        y += offset("Y") / height;
    } else {
        let sign = if number("flipImageX") >= 0.5 { -1.0 } else { 1.0 };
        x += sign * stripe as f64 / (3.0 * width);
    }
    let phase = (x + y * tilt) * pitch - number("center");
    let share = 1.0 - (phase - phase.floor());
    ((share * f64::from(views)) as u32).min(views - 1)
}

#[test]
fn each_sub_pixel_is_that_of_the_direct_computation() {
    let display = display();
    let quilt = quilt(&display);
    let flipped = |name: &str| {
        STRIPES.replace(&format!("\"{name}\":{{\"value\":0.0}}"), &format!("\"{name}\":{{\"value\":1.0}}"))
    };
    for text in [
        STRIPES.to_owned(),
        CELLS.to_owned(),
        flipped("flipImageX"),
        flipped("flipImageY"),
        flipped("flipSubp"),
    ] {
        let lenses = Lenticular::from_visual_json(&text).unwrap();
        let picture = lenses.interlace(&display, &quilt).unwrap();
        assert_eq!([picture.width, picture.height], lenses.panel_px);
        let mut seen = vec![false; display.view_count() as usize];
        for (index, rgb) in picture.rgb.iter().enumerate() {
            let (column, row) = (index as u32 % picture.width, index as u32 / picture.width);
            let across = if lenses.flips_x { picture.width - 1 - column } else { column };
            let down = if lenses.flips_y { picture.height - 1 - row } else { row };
            let x = ((f64::from(across) + 0.5) / f64::from(picture.width) * 32.0) as u32;
            let y = ((f64::from(down) + 0.5) / f64::from(picture.height) * 20.0) as u32;
            for (channel, &found) in rgb.iter().enumerate() {
                let view = direct_view(&text, column, row, channel, 15);
                assert_eq!(lenses.view(column, row, channel, 15), view, "{column} {row} {channel}");
                seen[view as usize] = true;
                let [left, top] = [view % 5 * 32, (2 - view / 5) * 20];
                let expected = quilt.rgb[((top + y) * quilt.width + left + x) as usize][channel];
                assert_eq!(found, expected, "{column} {row} {channel}");
            }
        }
        assert!(seen.iter().all(|&seen| seen), "every view is shown somewhere");
    }
}

/// The calibration in which a flag is set.
fn flipped(name: &str) -> Lenticular {
    let (unset, set) = (format!("\"{name}\":{{\"value\":0.0}}"), format!("\"{name}\":{{\"value\":1.0}}"));
    assert!(STRIPES.contains(&unset), "{name}");
    Lenticular::from_visual_json(&STRIPES.replace(&unset, &set)).unwrap()
}

#[test]
fn a_panel_that_exchanges_left_and_right_has_the_mirror_image_of_each_lens() {
    let (straight, mirrored) = (Lenticular::from_visual_json(STRIPES).unwrap(), flipped("flipImageX"));
    let both = 2.0 * straight.center - straight.lenses_across();
    for (column, row) in [(0, 0), (17, 3), (95, 59)] {
        for channel in 0..3 {
            // From a mirrored place as many lenses are left to the right edge as there are from the left edge to the place.
            let sum = straight.share(95 - column, row, channel) + mirrored.share(column, row, channel);
            let apart = sum - both;
            assert!((apart - apart.round()).abs() < 1e-9, "{column} {row} {channel}: {apart}");
        }
    }
}

#[test]
fn what_is_just_between_two_lenses_shows_the_last_view() {
    let lenses = Lenticular::from_visual_json(STRIPES).unwrap();
    let (x, y) = ((7.0 + 0.5) / 96.0, (60.0 - 1.0 - 11.0 + 0.5) / 60.0);
    let center = (x + y * lenses.tilt()) * lenses.lenses_across();
    let centred = Lenticular { center, ..lenses };
    assert_eq!((centred.share(7, 11, 0), centred.view(7, 11, 0, 48)), (1.0, 47));
    let to_the_right = Lenticular { views_run_left: false, ..centred };
    assert_eq!((to_the_right.share(7, 11, 0), to_the_right.view(7, 11, 0, 48)), (0.0, 0));
}

#[test]
fn other_ways_to_write_a_calibration_are_read() {
    let cells = Lenticular::from_visual_json(CELLS).unwrap();
    let lower = CELLS.replace("CellPatternMode", "cellPatternMode");
    assert_eq!(Lenticular::from_visual_json(&lower).unwrap(), cells);
    let without = STRIPES.replacen('{', "{\"subpixelCells\":null,", 1);
    assert_eq!(
        Lenticular::from_visual_json(&without).unwrap(),
        Lenticular::from_visual_json(STRIPES).unwrap()
    );
}

proptest! {
    #[test]
    fn patterns_of_cells_are_those_of_the_makers_shader(column in 0_u32..9, row in 0_u32..9) {
        use CellPattern::{Checkered, Columns, One, Quadruple, Rows};
        let both = (column % 2, row % 2);
        prop_assert_eq!(One.cell(column, row), 0);
        prop_assert_eq!(Checkered.cell(column, row), usize::from(both == (0, 1) || both == (1, 0)));
        prop_assert_eq!(Columns.cell(column, row), both.0 as usize);
        prop_assert_eq!(Rows.cell(column, row), both.1 as usize);
        prop_assert_eq!(Quadruple.cell(column, row), ((row + 2 * both.0) % 4) as usize);
    }
}

#[test]
fn each_fault_of_a_calibration_is_named() {
    let fault = |part: &str, replacement: &str| {
        let of = if STRIPES.contains(part) { STRIPES } else { CELLS };
        assert!(of.contains(part), "{part}");
        Lenticular::from_visual_json(&of.replacen(part, replacement, 1)).unwrap_err().to_string()
    };
    for (found, expected) in [
        (fault("\"pitch\":{\"value\":49.825218200683597},", ""), "pitch is missing: must be a number"),
        (fault("{\"value\":49.825218200683597}", "{}"), "pitch is null: must be a number"),
        (fault("{\"value\":49.825218200683597}", "\"fine\""), "pitch is \"fine\": must be a number"),
        (fault("49.825218200683597", "0"), "pitch is 0: must be above 0 and at most 10000"),
        (fault("5.2160325050354", "0"), "slope is 0: must be from 0.001 to 1000000, or negative so"),
        (fault("\"DPI\":{\"value\":338.0}", "\"DPI\":{\"value\":0}"), "DPI is 0: must be from 1 to 100000"),
        (fault("96.0", "96.5"), "screenW is 96.5: must be a whole number of pixels"),
        (fault("96.0", "1e9"), "screenW, screenH[0] is 1000000000: must be from 1 to 32768 pixels"),
        (
            fault("49.825218200683597", "0.0001"),
            "pitch is 0.0001, with slope 5.2160325050354 and DPI 338: 0.0000278",
        ),
        (fault("49.825218200683597", "0.0001"), "must be from 10 to 288, one for each sub-pixel"),
        (fault("49.825218200683597", "1e-200"), "pitch is 1e-200, with slope"),
        (fault("49.825218200683597", "9000"), "must be from 10 to 288"),
        (fault("5.2160325050354", "0.001"), "with slope 0.001 and DPI 338: 0.0141"),
        (
            fault("\"CellPatternMode\":{\"value\":4}", "\"CellPatternMode\":{\"value\":5}"),
            "CellPatternMode is 5: must be 0, 1, 2, 3 or 4",
        ),
        (
            fault("\"CellPatternMode\":{\"value\":4}", "\"CellPatternMode\":3"),
            "subpixelCells has 2 entries: must have as many as CellPatternMode tells apart",
        ),
        (fault("\"GOffsetX\":-0.25,", ""), "GOffsetX is missing"),
        (Lenticular::from_visual_json("{").unwrap_err().to_string(), "EOF while parsing"),
        (Lenticular::from_visual_json("[]").unwrap_err().to_string(), "pitch is missing"),
    ] {
        assert!(found.contains(expected), "{found:?} does not say {expected:?}");
    }
    let lenses = Lenticular::from_visual_json(STRIPES).unwrap();
    let small = QuiltDisplay { quilt_size_px: [50, 60], ..display() };
    assert!(
        lenses
            .interlace(&small, &quilt(&display()))
            .unwrap_err()
            .to_string()
            .contains("the quilt is of 160x60")
    );
}
