//! NRRD.

use super::build::{encode, gzip, load, refusal, sample_values, values_of, with_data};
use glam::DVec3;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Format::Nrrd as NRRD, ReadError, Warning, read_bytes};

const GEOMETRY: &str = "space: RAS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n";

/// A header of u8 4×3×2 voxels with more fields.
fn header(fields: &str) -> String {
    format!("NRRD0005\n# a comment\ntype: uint8\ndimension: 3\nsizes: 4 3 2\n{fields}\n")
}

fn plain(fields: &str) -> Vec<u8> {
    with_data(&header(&format!("encoding: raw\n{fields}")), &bytes())
}

fn bytes() -> Vec<u8> {
    (0..24).collect()
}

fn counted() -> Vec<f64> {
    (0..24).map(f64::from).collect()
}

#[test]
fn every_type_encoding_and_byte_order_keeps_its_values() {
    for &voxel_type in VoxelType::ALL {
        let name = match voxel_type {
            VoxelType::F32 => "float",
            VoxelType::F64 => "double",
            integer => integer.name(),
        };
        let values = sample_values(voxel_type, 24);
        for (endian, big_endian) in [("little", false), ("big", true)] {
            let data = encode(&values, voxel_type, big_endian);
            let text: String = values.iter().map(|value| format!("{value}\n")).collect();
            let encodings = [
                ("raw", data.clone()),
                ("gzip", gzip(&data)),
                ("gz", gzip(&data)),
                ("ascii", text.clone().into_bytes()),
                ("txt", text.into_bytes()),
            ];
            for (encoding, data) in encodings {
                let header = format!(
                    "NRRD0004\r\ntype: {name}\r\ndimension: 3\r\nsizes: 4 3 2\r\nendian: {endian}\r\n\
                     encoding: {encoding}\r\nkey:=value: with colon\r\n{GEOMETRY}\r\n"
                );
                let loaded = load(NRRD, &with_data(&header, &data));
                assert_eq!(loaded.volume.voxels().voxel_type(), voxel_type);
                assert_eq!(values_of(&loaded), values, "{name} {endian} {encoding}");
                assert_eq!(loaded.warnings, []);
            }
        }
    }
}

#[test]
fn type_synonyms_are_known() {
    let names =
        ["signed char", "unsigned char", "short int", "unsigned short", "int", "unsigned int", "longlong"];
    for (name, size) in names.into_iter().zip([1, 1, 2, 2, 4, 4, 8]) {
        let header = format!(
            "NRRD0001\ntype: {name}\ndimension: 1\nsizes: 3\nendian: little\nencoding: raw\nspacings: 2\n\n"
        );
        let loaded = load(NRRD, &with_data(&header, &vec![0; 3 * size]));
        assert_eq!(loaded.volume.grid().dims(), [3, 1, 1], "{name}");
        assert_eq!(loaded.volume.grid().spacing_mm().x, 2.0);
    }
}

#[test]
fn components_are_cut_to_the_first_wherever_their_axis_is() {
    let components = |axes: &str, directions: &str, value: &dyn Fn(usize) -> u8| {
        let header = format!(
            "NRRD0005\ntype: uint8\ndimension: 4\nsizes: {axes}\nencoding: raw\nspace: LPS\n\
             space directions: {directions}\n\n"
        );
        let data: Vec<u8> = (0..72).map(value).collect();
        load(NRRD, &with_data(&header, &data))
    };
    let first = components("3 4 3 2", "none (1,0,0) (0,1,0) (0,0,1)", &|i| {
        if i % 3 == 0 { (i / 3) as u8 } else { 200 }
    });
    assert_eq!(values_of(&first), counted());
    assert_eq!(first.warnings, [Warning::FirstComponentOnly { components: 3 }]);
    assert_eq!(first.volume.grid().orientation_letters(), "LPS");
    let middle = components("4 3 3 2", "(1,0,0) (0,1,0) none (0,0,1)", &|i| {
        if i % 36 < 12 { (i % 36 + 12 * (i / 36)) as u8 } else { 200 }
    });
    assert_eq!(values_of(&middle), counted());
    let last = components("4 3 2 3", "(1,0,0) (0,1,0) (0,0,1) none", &|i| i.min(23) as u8);
    assert_eq!(values_of(&last), counted());
    assert_eq!(last.warnings, [Warning::FirstFrameOnly { frames: 3 }]);
}

#[test]
fn kinds_tell_components_where_there_are_no_directions() {
    let header = "NRRD0005\ntype: uint8\ndimension: 4\nsizes: 3 4 3 2\nencoding: raw\n\
                  kinds: RGB-color domain domain domain\nspacings: nan 2 3 nan\n\n";
    let data: Vec<u8> = (0..72).map(|i| if i % 3 == 0 { i / 3 } else { 200 }).collect();
    let loaded = load(NRRD, &with_data(header, &data));
    assert_eq!(values_of(&loaded), counted());
    assert_eq!(loaded.volume.grid().spacing_mm(), DVec3::new(2.0, 3.0, 1.0));
    let expected = [
        Warning::OrientationUnknown { axes: "right, anterior, superior" },
        Warning::SpacingAssumed { axis: 4 },
        Warning::FirstComponentOnly { components: 3 },
    ];
    assert_eq!(loaded.warnings, expected);
}

#[test]
fn units_scale_to_millimetres() {
    let fields = "space: RAS\nspace directions: (2,0,0) (0,1,0) (0,0,1)\nspace units: \"m\" \"um\" \"mm\"\n";
    let grid = load(NRRD, &plain(fields)).volume.grid().clone();
    assert!((grid.spacing_mm() - DVec3::new(2000.0, 0.001, 1.0)).length() < 1e-9);
}

#[test]
fn images_of_two_dimensions_get_a_third() {
    let header = "NRRD0005\ntype: uint8\ndimension: 2\nsizes: 6 4\nencoding: raw\nspace: RAS\n\
                  space directions: (0,2,0) (0,0,2)\n\n";
    let grid = load(NRRD, &with_data(header, &bytes())).volume.grid().clone();
    assert_eq!(grid.dims(), [6, 4, 1]);
    assert_eq!(grid.orientation_letters(), "ASR");
}

#[test]
fn a_space_without_anatomy_is_told() {
    let fields = "space: 3D-right-handed\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
    let space = "3d-right-handed".to_owned();
    assert_eq!(load(NRRD, &plain(fields)).warnings, [Warning::SpaceAssumedRas { space }]);
    let fields = "space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
    assert_eq!(
        load(NRRD, &plain(fields)).warnings,
        [Warning::OrientationUnknown { axes: "right, anterior, superior" }]
    );
}

#[test]
fn lines_and_bytes_are_skipped() {
    let with_skips = |skips: &str, data: &[u8]| {
        let header = header(&format!("encoding: raw\n{GEOMETRY}{skips}"));
        values_of(&load(NRRD, &with_data(&header, data)))
    };
    let after = |start: &[u8]| [start, &bytes()].concat();
    assert_eq!(with_skips("line skip: 2\nbyte skip: 3\n", &after(b"one\ntwo\n123")), counted());
    assert_eq!(with_skips("byteskip: -1\n", &after(b"anything")), counted());
    let compressed = header(&format!("encoding: gzip\nbyte skip: 3\n{GEOMETRY}"));
    let loaded = load(NRRD, &with_data(&compressed, &gzip(&after(b"123"))));
    assert_eq!(values_of(&loaded), counted());
}

#[test]
fn a_detached_header_needs_its_data() {
    let header = header(&format!("encoding: raw\n{GEOMETRY}datafile: voxels.raw\n"));
    let header = header.trim_end().as_bytes();
    assert_eq!(values_of(&read_bytes(NRRD, header, Some(&bytes())).unwrap()), counted());
    assert!(matches!(refusal(NRRD, header), ReadError::Detached));
}

#[test]
fn a_missing_byte_order_is_told() {
    let header = format!("NRRD0004\ntype: short\ndimension: 3\nsizes: 2 3 2\nencoding: raw\n{GEOMETRY}\n");
    assert_eq!(load(NRRD, &with_data(&header, &bytes())).warnings, [Warning::ByteOrderAssumed]);
}

#[test]
fn bad_headers_are_refused() {
    type Check = fn(&ReadError) -> bool;
    let whole = |text: &str| with_data(text, &bytes());
    let sized = |sizes: &str| {
        whole(&format!("NRRD0004\ntype: uint8\ndimension: 3\nsizes: {sizes}\nencoding: gzip\n\n"))
    };
    let directions = |text: &str| plain(&format!("space: RAS\nspace directions: {text}\n"));
    let endless = format!("NRRD0004\n# {}", "x".repeat(2 << 20)).into_bytes();
    let cases: Vec<(&str, Vec<u8>, Check)> = vec![
        ("empty", vec![], |e| matches!(e, ReadError::Empty)),
        ("no magic", whole("NRRX0004\n"), |e| matches!(e, ReadError::WrongMagic { .. })),
        ("no version", whole("NRRD000x\n"), |e| matches!(e, ReadError::WrongMagic { .. })),
        ("magic only", b"NRRD0004".to_vec(), |e| {
            matches!(e, ReadError::MissingField { field: "dimension", .. })
        }),
        ("endless line", endless, |e| matches!(e, ReadError::HeaderTooLong { .. })),
        ("garbage", with_data("NRRD0004\n", b"\xff\xfe\x00garbage\n"), |e| {
            matches!(e, ReadError::BadLine { line: 2, .. })
        }),
        ("invalid UTF-8", with_data("NRRD0004\ndimension: ", b"\xff\xfe\n\n"), |e| {
            matches!(e, ReadError::BadField { field: "dimension", .. })
        }),
        ("dimension 0", whole("NRRD0004\ndimension: 0\n\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("dimension 17", whole("NRRD0004\ndimension: 17\n\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("zero size", sized("4 0 2"), |e| matches!(e, ReadError::BadDimension { axis: 2, value: 0, .. })),
        ("negative size", sized("-4 3 2"), |e| {
            matches!(e, ReadError::BadDimension { axis: 1, value: -4, .. })
        }),
        ("too few sizes", sized("4 3"), |e| matches!(e, ReadError::BadField { field: "sizes", .. })),
        ("size beyond i64", sized("4 3 99999999999999999999"), |e| {
            matches!(e, ReadError::BadField { field: "sizes", .. })
        }),
        ("2^40 voxels", sized("16384 8192 8192"), |e| matches!(e, ReadError::TooLarge { .. })),
        ("overflow", sized("9223372036854775807 9223372036854775807 2"), |e| {
            matches!(e, ReadError::TooLarge { .. })
        }),
        ("bomb cut short", sized("2000 2000 1000"), |e| {
            matches!(e, ReadError::Truncated { expected_bytes: 4_000_000_000, .. })
        }),
        ("not gzip", sized("4 3 2"), |e| matches!(e, ReadError::Corrupt { encoding: "gzip", .. })),
        ("truncated", with_data(&header("encoding: raw\n"), &[0; 23]), |e| {
            matches!(e, ReadError::Truncated { expected_bytes: 24, found_bytes: 23, .. })
        }),
        ("truncated text", with_data(&header("encoding: ascii\n"), b"1 2 3"), |e| {
            matches!(e, ReadError::TruncatedText { expected: 24, .. })
        }),
        ("text with gaps", with_data(&header("encoding: ascii\n"), &b"1 ,\n".repeat(12)), |e| {
            matches!(e, ReadError::TruncatedText { expected: 24, found: 12 })
        }),
        ("text out of range", with_data(&header("encoding: text\n"), &b"300 ".repeat(24)), |e| {
            matches!(e, ReadError::BadField { field: "voxel data", .. })
        }),
        ("bzip2", with_data(&header("encoding: bz2\n"), &[]), |e| matches!(e, ReadError::Unsupported { .. })),
        ("block", whole("NRRD0004\ntype: block\ndimension: 1\nsizes: 24\nencoding: raw\n\n"), |e| {
            matches!(e, ReadError::Unsupported { .. })
        }),
        ("list of files", plain("data file: LIST\na\nb\n"), |e| matches!(e, ReadError::BadLine { .. })),
        ("list", plain("data file: LIST 2\n"), |e| matches!(e, ReadError::Unsupported { .. })),
        ("pattern", plain("data file: x%03d.raw 1 9 1\n"), |e| matches!(e, ReadError::Unsupported { .. })),
        ("singular", directions("(1,0,0) (2,0,0) (0,0,1)"), |e| matches!(e, ReadError::NotInvertible { .. })),
        ("NaN", directions("(1,0,0) (0,nan,0) (0,0,1)"), |e| {
            matches!(e, ReadError::NotFinite { field: "space directions" })
        }),
        ("infinite", directions("(1,0,0) (0,1,0) (0,0,inf)"), |e| matches!(e, ReadError::NotFinite { .. })),
        ("two directions", directions("(1,0,0) (0,1,0)"), |e| matches!(e, ReadError::BadField { .. })),
        ("short vector", directions("(1,0,0) (0,1) (0,0,1)"), |e| matches!(e, ReadError::BadField { .. })),
        ("open vector", directions("(1,0,0) (0,1,0) (0,0,1"), |e| matches!(e, ReadError::BadField { .. })),
        ("no axis in space", directions("none none none"), |e| matches!(e, ReadError::MissingField { .. })),
        ("no space", plain("space directions: (1,0,0) (0,1,0) (0,0,1)\n"), |e| {
            matches!(e, ReadError::MissingField { field: "space", .. })
        }),
        ("odd space", plain("space: mars\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"), |e| {
            matches!(e, ReadError::BadField { field: "space", .. })
        }),
        ("odd origin", plain(&format!("{GEOMETRY}space origin: (nan,0,0)\n")), |e| {
            matches!(e, ReadError::NotFinite { field: "space origin" })
        }),
        ("odd byte order", plain("endian: middle\n"), |e| {
            matches!(e, ReadError::BadField { field: "endian", .. })
        }),
        ("byte skip -2", plain("byte skip: -2\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("byte skip -1 in text", with_data(&header("encoding: text\nbyte skip: -1\n"), &[0; 99]), |e| {
            matches!(e, ReadError::BadField { field: "byte skip", .. })
        }),
        ("byte skip -1, too short", with_data(&header("encoding: raw\nbyte skip: -1\n"), &[0; 9]), |e| {
            matches!(e, ReadError::Truncated { expected_bytes: 24, found_bytes: 9, .. })
        }),
        ("byte skip beyond the end", plain("byte skip: 9223372036854775807\n"), |e| {
            matches!(e, ReadError::Truncated { .. })
        }),
        ("line skip beyond the end", plain("line skip: 18446744073709551615\n"), |e| {
            matches!(e, ReadError::Truncated { .. })
        }),
    ];
    for (name, file, check) in cases {
        let error = refusal(NRRD, &file);
        assert!(check(&error), "{name}: {error:?}");
    }
}
