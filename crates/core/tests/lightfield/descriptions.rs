//! Descriptions of projector arrays are read back as written, and each fault gives one clear error.

use crate::scene::display;
use wheatstone_core::lightfield::{ProjectorArray, QuiltDisplay};

/// The written form of a display with a part replaced.
fn with(part: &str, replacement: &str) -> String {
    let text = display(8, 2.0, [16, 12]).to_json();
    assert!(text.contains(part), "{part} is not in {text}");
    text.replacen(part, replacement, 1)
}

fn fault(text: &str) -> String {
    ProjectorArray::from_json(text).unwrap_err().to_string()
}

#[test]
fn a_display_is_read_as_it_was_written() {
    for array in [display(8, 2.0, [16, 12]), ProjectorArray::of_paper()] {
        assert_eq!(ProjectorArray::from_json(&array.to_json()).unwrap(), array);
    }
}

#[test]
fn the_display_of_the_paper_is_one() {
    let paper = ProjectorArray::of_paper();
    assert_eq!(ProjectorArray::new(paper.description().clone()).unwrap(), paper);
    assert_eq!(paper.projectors().len(), 96);
    assert_eq!(paper.description().image_size_px, [320, 240]);
    let batches = paper.batches();
    assert_eq!(batches.len(), 6);
    assert!(batches.iter().all(|batch| batch.len() == 16));
    let beams: u32 =
        paper.views(glam::DAffine3::IDENTITY).iter().map(|view| view.size[0] * view.size[1]).sum();
    assert_eq!(beams, 7_372_800);
    let reversed = paper.projectors().iter().filter(|p| p.image.left_m > p.image.right_m).count();
    assert_eq!(reversed, 32);
    let resolution = paper.resolution();
    assert_eq!(resolution.size_m(0.0), 0.001_25);
    assert!((resolution.size_m(-0.1) - (0.001_25 + 0.2 * 0.4_f64.to_radians().tan())).abs() < 1e-12);
    assert_eq!(resolution.size_m(0.1), resolution.size_m(-0.1));
}

#[test]
fn each_fault_is_named_with_what_was_expected() {
    let number = |part: &str, replacement: &str| fault(&with(part, replacement));
    let cases = [
        (fault("{"), "EOF while parsing an object (line 1, column 1)"),
        (fault(&with("\"beam_angle_deg\": 2.0,", "")), "missing field `beam_angle_deg`"),
        (fault(&with("\"beam_angle_deg\"", "\"beam_angle_rad\"")), "unknown field `beam_angle_rad`"),
        (
            fault(&with("\"wheatstone_projector_array\": 1", "\"wheatstone_projector_array\": 7")),
            "version 7 of the description; this program reads version 1",
        ),
        (number("\"distance_m\": 0.6", "\"distance_m\": 0"), "viewer.distance_m is 0: must be above 0"),
        (number("\"distance_m\": 0.6", "\"distance_m\": -1"), "viewer.distance_m is -1: must be above 0"),
        (number("\"distance_m\": 0.6", "\"distance_m\": 1e999"), "number out of range"),
        (
            number("-0.5\n", "0.0\n"),
            "projectors[0].emitter_m[2] is 0: must be at most -0.000001 m: emitters are behind the screen",
        ),
        (number("-0.5\n", "0.5\n"), "projectors[0].emitter_m[2] is 0.5: must be at most -0.000001 m"),
        (number("-0.5\n", "-1e-300\n"), "projectors[0].emitter_m[2] is -1e-300: must be at most -0.000001 m"),
        (
            number("-0.5\n", "-1.5e300\n"),
            "projectors[0].emitter_m[2] is -1.5e300: must be from -1000 to 1000 m",
        ),
        (number("\"id\": 5", "\"id\": 1e300"), "invalid type: floating point `1e+300`, expected u32"),
        (
            number("\"beam_angle_deg\": 2.0", "\"beam_angle_deg\": 0"),
            "beam_angle_deg is 0: must be above 0 and below 90",
        ),
        (number("\"pixel_size_m\": 0.0125", "\"pixel_size_m\": 0"), "pixel_size_m is 0: must be above 0"),
        (
            number("\"up_m\": 0.075", "\"up_m\": -0.075"),
            "projectors[0].image.up_m is -0.075: must be at least 0.000001 m above down_m",
        ),
        (
            number("\"right_m\": -0.1", "\"right_m\": 0.1"),
            "projectors[0].image.right_m is 0.1: must be at least 0.000001 m from left_m",
        ),
        (
            number("\"right_m\": -0.1", "\"right_m\": 0.1000001"),
            "projectors[0].image.right_m is 0.1000001: must be at least 0.000001 m from left_m",
        ),
        (number("\"id\": 5", "\"id\": 2"), "projectors[5].id is 2, as of projectors[2]: ids must differ"),
        (number("\"id\": 5", "\"id\": 16777215"), "projectors[5].id is 16777215: must be at most 16777214"),
        (
            number("\"header_rows\": 8", "\"header_rows\": 40"),
            "packing.frame_size_px is 64x44 with 40 header rows: there is no room for an image of 16x12",
        ),
        (
            number("\"header_rows\": 8", "\"header_rows\": 0"),
            "packing.frame_size_px is 64x44 with 0 header rows",
        ),
        (
            number("    16,\n    12\n", "    1,\n    1\n"),
            "packing.frame_size_px[0] is 64: must be at least 2304, a column of the header for each image",
        ),
        (
            fault("[1, [0.2, 0.15], 0.01, 2.0, [0.0, 0.6], [16, 12], [], [[64, 44], 8]]"),
            "invalid type: sequence, expected a map",
        ),
        (
            QuiltDisplay::from_json("[8, 6, [336, 336], 0.75, 40, 0.654, 0.16]").unwrap_err().to_string(),
            "invalid type: sequence, expected a map",
        ),
        (number("    12\n", "    0\n"), "image_size_px[1] is 0: must be from 1 to 32768 pixels"),
        (
            number("    12\n", "    12000000\n"),
            "image_size_px[1] is 12000000: must be from 1 to 32768 pixels",
        ),
    ];
    for (found, expected) in cases {
        assert!(found.contains(expected), "{found:?} does not say {expected:?}");
        assert_eq!(found.lines().count(), 1, "{found:?}");
    }
}

#[test]
fn constructed_displays_are_checked_as_read_ones_are() {
    let described = display(8, 2.0, [16, 12]).description().clone();
    let fault = |change: fn(&mut wheatstone_core::lightfield::projectors::Description)| {
        let mut description = described.clone();
        change(&mut description);
        ProjectorArray::new(description).unwrap_err().to_string()
    };
    assert!(fault(|d| d.pixel_size_m = f64::NAN).contains("pixel_size_m is NaN"));
    assert!(
        fault(|d| d.projectors[3].emitter_m[0] = f64::INFINITY).contains("projectors[3].emitter_m[0] is inf")
    );
    assert!(fault(|d| d.projectors.clear()).contains("projectors has 0 entries: must have from 1 to 4096"));
    assert!(
        fault(|d| d.image_size_px = [8192; 2])
            .contains("the pixels of all projectors: 536870912 in all, must be at most 134217728")
    );
}
