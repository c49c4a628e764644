use super::*;
use proptest::prelude::*;

fn paraview(fields: &str) -> Result<TransferFile, TransferReadError> {
    parse_transfer(&format!(r#"[{{"Name": "a map", {fields}}}]"#))
}

fn assert_rgb(found: [f32; 3], expected: [f32; 3]) {
    let close = found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 0.006);
    assert!(close, "{found:?} is not {expected:?}");
}

#[test]
fn wheatstones_own_form_is_recognised() {
    let text = "\u{feff}\n {\"wheatstone_transfer_function\": 1, \"color\": \"gray\", \"opacity\": [[0, 0], [1, 1]], \"window\": [2, 4]}";
    let file = parse_transfer(text).unwrap();
    assert_eq!(file.window.unwrap().hi(), 4.0);
    let misspelt = r#"{"wheatstone_transfer_function": 1, "colour": "gray", "opacity": [[0, 1]]}"#;
    assert!(parse_transfer(misspelt).unwrap_err().to_string().contains("`colour`"));
}

#[test]
fn wheatstones_own_form_is_bounded_too() {
    let with = |part: &str, count: usize| {
        let point = if part == "color" { "[0, 1, 1, 1]" } else { "[0, 1]" };
        let points = vec![point; count].join(", ");
        let others =
            ["color", "opacity"].into_iter().filter(|&other| other != part).map(|other| match other {
                "color" => r#""color": "gray""#.to_owned(),
                _ => r#""opacity": [[0, 1]]"#.to_owned(),
            });
        let fields: Vec<String> = others.chain([format!("\"{part}\": [{points}]")]).collect();
        parse_transfer(&format!("{{\"wheatstone_transfer_function\": 1, {}}}", fields.join(", ")))
    };
    for part in ["color", "opacity", "gradient_opacity"] {
        let message = with(part, MAX_TRANSFER_POINTS + 1).unwrap_err().to_string();
        assert!(message.starts_with(part) && message.contains("65537"), "{message}");
        assert!(with(part, MAX_TRANSFER_POINTS).is_ok(), "{part}");
    }
}

#[test]
fn paraview_data_values_become_a_window() {
    let file = paraview(
        r#""ColorSpace": "RGB", "RGBPoints": [-50, 0, 0, 0, 150, 1, 0.5, 0],
           "Points": [-50, 0, 0.5, 0, 50, 0.4, 0.5, 0, 150, 0.6, 0.5, 0]"#,
    )
    .unwrap();
    let window = file.window.unwrap();
    assert_eq!((window.lo(), window.hi()), (-50.0, 150.0));
    assert!((file.transfer.opacity_at(0.25) - 0.2).abs() < 1e-6);
    assert_rgb(file.transfer.color_at(0.5), [0.5, 0.25, 0.0]);
}

#[test]
fn paraview_maps_over_one_need_no_window_and_get_a_ramp() {
    let file = paraview(r#""RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1]"#).unwrap();
    assert_eq!(file.window, None);
    assert!((file.transfer.opacity_at(0.3) - 0.3).abs() < 1e-6);
}

#[test]
fn paraview_colour_spaces_are_resampled() {
    let color_at = |space: &str, at: f32| {
        let fields = format!(r#""ColorSpace": "{space}", "RGBPoints": [0, 1, 0, 0, 1, 0, 0, 1]"#);
        paraview(&fields).unwrap().transfer.color_at(at)
    };
    assert_rgb(color_at("RGB", 0.5), [0.5, 0.0, 0.5]);
    assert_rgb(color_at("Lab", 0.5), [0.792, 0.0, 0.536]);
    assert_rgb(color_at("HSV", 0.5), [0.0, 1.0, 0.0]);
    assert_rgb(color_at("Step", 0.001), [0.0, 0.0, 1.0]);
    let cool_warm = r#""ColorSpace": "Diverging", "RGBPoints":
        [0, 0.23137254902, 0.298039215686, 0.752941176471, 1, 0.705882352941, 0.0156862745098, 0.149019607843]"#;
    let middle = paraview(cool_warm).unwrap().transfer.color_at(0.5);
    assert_rgb(middle, [0.866, 0.866, 0.866]);
    let wrapped = r#""ColorSpace": "HSV", "HSVWrap": true, "RGBPoints": [0, 1, 0, 0, 1, 0, 0, 1]"#;
    assert_rgb(paraview(wrapped).unwrap().transfer.color_at(0.5), [1.0, 0.0, 1.0]);
}

#[test]
fn paraview_steps_in_opacity_are_kept() {
    let file =
        paraview(r#""RGBPoints": [0, 0, 0, 0, 1, 1, 1, 1], "Points": [0, 0, 0.25, 1, 1, 0.8, 0.5, 0]"#)
            .unwrap();
    assert_eq!(file.transfer.opacity_at(0.24), 0.0);
    assert_eq!(file.transfer.opacity_at(0.26), 0.8);
}

#[test]
fn paraview_errors_name_the_field() {
    let message = |fields: &str| paraview(fields).unwrap_err().to_string();
    assert!(message(r#""RGBPoints": [0, 1, 1]"#).contains("RGBPoints holds 3 numbers"));
    assert!(message(r#""RGBPoints": [0, 1, 1, "x"]"#).contains("RGBPoints[3]"));
    assert!(message(r#""RGBPoints": [0, 1, 1, 1]"#).contains("span no range"));
    assert!(message(r#""RGBPoints": [5, 1, 1, 1, 5, 0, 0, 0]"#).contains("span no range"));
    assert!(message(r#""RGBPoints": [-1e308, 1, 1, 1, 1e308, 0, 0, 0]"#).contains("span no range"));
    assert!(message(r#""RGBPoints": [0, 1, 1, 7, 1, 0, 0, 0]"#).contains('7'));
    assert!(message(r#""ColorSpace": "XYZ", "RGBPoints": [0, 1, 1, 1]"#).contains("XYZ"));
    assert!(message(r#""IndexedColors": [1, 0, 0]"#).contains("indexed"));
    for on in ["1", "1.0", "true"] {
        let points = r#""RGBPoints": [1, 0, 0, 0, 100, 1, 1, 1]"#;
        assert!(message(&format!(r#""UseLogScale": {on}, {points}"#)).contains("UseLogScale"), "{on}");
        assert!(paraview(&format!(r#""UseLogScale": 0, {points}"#)).is_ok());
        assert!(paraview(&format!(r#""UseLogScale": false, {points}"#)).is_ok());
    }
}

const BONE: &str = "1\n1\n0.9\n0.1\n0.2\n10\n8 -1000 0 100 0 500 0.6 3000 0.7\n4 0 1 255 1\n\
                    12 -1000 0 0 0 500 0.9 0.8 0.6 3000 1 1 1\n";

#[test]
fn slicer_volume_properties_are_read() {
    let file = parse_transfer(BONE).unwrap();
    let window = file.window.unwrap();
    assert_eq!((window.lo(), window.hi()), (-1000.0, 3000.0));
    let at_hu = |hu: f64| window.normalise(hu) as f32;
    assert_eq!(file.transfer.opacity_at(at_hu(90.0)), 0.0);
    assert!((file.transfer.opacity_at(at_hu(300.0)) - 0.3).abs() < 1e-3);
    assert_rgb(file.transfer.color_at(at_hu(500.0)), [0.9, 0.8, 0.6]);
    assert!(!file.transfer.is_2d(), "a gradient opacity of 1 everywhere is none");
    let two_dimensional = parse_transfer(&BONE.replace("4 0 1 255 1", "4 0 0 400 1")).unwrap();
    assert!((two_dimensional.transfer.gradient_opacity_at(0.05) - 0.5).abs() < 1e-5);
    assert_eq!(parse_transfer(&BONE.replace('\n', "\r\n")).unwrap(), file);
}

#[test]
fn slicer_errors_name_the_line() {
    let message = |text: &str| parse_transfer(text).unwrap_err().to_string();
    assert!(message("1\n1\n0.9\n0.1\n0.2\n10").contains("line 7: missing"));
    assert!(message(&BONE.replace("8 -1000", "9 -1000")).contains("line 7"));
    assert!(message(&BONE.replace("8 -1000", "800000000000 -1000")).contains("line 7"));
    assert!(message(&BONE.replace("3000 0.7", "3000")).contains("line 7: 7 of 8"));
    assert!(message(&BONE.replace("500 0.9", "nan 0.9")).contains("line 9"));
    assert!(message(&BONE.replace("500 0.6", "500 6")).contains('6'));
}

#[test]
fn other_files_are_refused() {
    assert!(matches!(parse_transfer(""), Err(TransferReadError::Unrecognised)));
    assert!(matches!(parse_transfer("[1, 2]"), Err(TransferReadError::Unrecognised)));
    assert!(matches!(parse_transfer("NRRD0004"), Err(TransferReadError::Unrecognised)));
    assert!(matches!(parse_transfer("{\"a\":"), Err(TransferReadError::Json(_))));
    let numbers: String = (1..100).map(|i| format!("{i}\n")).collect();
    for no_preset in
        ["42", "1 2 3\n4 5 6\n", "1\n1\n0.9", "2024-01-01", "nan", "infinity and beyond", "1, 2\n", &numbers]
    {
        assert!(matches!(parse_transfer(no_preset), Err(TransferReadError::Unrecognised)), "{no_preset:?}");
    }
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(read_transfer(folder.path()), Err(TransferReadError::NotAFile)));
    let path = folder.path().join("map.json");
    assert!(matches!(read_transfer(&path), Err(TransferReadError::NotFound)));
    fs::write(&path, [0xff, 0xfe, 0]).unwrap();
    assert!(matches!(read_transfer(&path), Err(TransferReadError::NotText)));
    fs::File::create(&path).unwrap().set_len(MAX_TRANSFER_BYTES + 1).unwrap();
    assert!(matches!(read_transfer(&path), Err(TransferReadError::TooLarge)));
    fs::write(&path, BONE).unwrap();
    assert!(read_transfer(&path).is_ok());
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in "\\PC{0,80}") {
        let _ = parse_transfer(&text);
    }

    #[test]
    fn damaged_files_never_panic(at in 0..BONE.len(), length in 0..8_usize, by in "[-0-9.eE \n]{0,6}") {
        let end = (at + length).min(BONE.len());
        let _ = parse_transfer(&[&BONE[..at], &by, &BONE[end..]].concat());
    }

    #[test]
    fn arbitrary_points_never_panic(
        space in prop::sample::select(vec!["RGB", "Lab", "Diverging", "HSV", "Step", "None"]),
        colors in prop::collection::vec(prop_oneof![0.0..1.0_f64, any::<f64>()], 0..24),
        opacities in prop::collection::vec(prop_oneof![0.0..1.0_f64, -2.0..2.0_f64, any::<f64>()], 0..24),
    ) {
        let text = serde_json::json!({ "ColorSpace": space, "RGBPoints": colors, "Points": opacities }).to_string();
        let _ = parse_transfer(&text);
    }
}
