//! MetaImage.

use super::build::{encode, load, refusal, sample_values, values_of, with_data, zlib};
use glam::DVec3;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Format::MetaImage as META, ReadError, Warning, read_bytes};

fn header(fields: &str) -> String {
    format!(
        "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nOffset = 0 0 0\nElementSpacing = 1 1 1\n{fields}\
         ElementDataFile = LOCAL\n"
    )
}

fn plain(fields: &str) -> Vec<u8> {
    with_data(&header(&format!("ElementType = MET_UCHAR\n{fields}")), &bytes())
}

fn bytes() -> Vec<u8> {
    (0..24).collect()
}

fn counted() -> Vec<f64> {
    (0..24).map(f64::from).collect()
}

#[test]
fn every_type_compression_and_byte_order_keeps_its_values() {
    for &voxel_type in VoxelType::ALL {
        let name = match voxel_type {
            VoxelType::U8 => "MET_UCHAR",
            VoxelType::I8 => "MET_CHAR",
            VoxelType::U16 => "MET_USHORT",
            VoxelType::I16 => "MET_SHORT",
            VoxelType::U32 => "MET_UINT",
            VoxelType::I32 => "MET_INT",
            VoxelType::F32 => "MET_FLOAT",
            VoxelType::F64 => "MET_DOUBLE",
        };
        let values = sample_values(voxel_type, 24);
        for (order, big_endian) in [("False", false), ("True", true)] {
            for key in ["BinaryDataByteOrderMSB", "ElementByteOrderMSB"] {
                let data = encode(&values, voxel_type, big_endian);
                let fields = format!("ElementType = {name}\n{key} = {order}\n");
                let text: String = values.iter().map(|value| format!("{value} ")).collect();
                let files = [
                    with_data(&header(&fields), &data),
                    with_data(&header(&format!("{fields}CompressedData = True\n")), &zlib(&data)),
                    with_data(&header(&format!("{fields}BinaryData = False\n")), text.as_bytes()),
                ];
                for file in files {
                    let loaded = load(META, &file);
                    assert_eq!(loaded.volume.voxels().voxel_type(), voxel_type);
                    assert_eq!(values_of(&loaded), values, "{name} {key} {order}");
                    assert_eq!(loaded.warnings, []);
                }
            }
        }
    }
}

#[test]
fn positions_are_lps_and_units_are_honoured() {
    let header = "NDims = 3\nDimSize = 4 3 2\nPosition = 1 2 3\nElementSize = 1 2 4\nDistanceUnits = cm\n\
                  ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    let grid = load(META, &with_data(header, &bytes())).volume.grid().clone();
    assert_eq!(grid.orientation_letters(), "LPS");
    assert_eq!(grid.patient_from_index().translation, DVec3::new(-10.0, -20.0, 30.0));
    assert_eq!(grid.spacing_mm(), DVec3::new(10.0, 20.0, 40.0));
}

#[test]
fn channels_and_frames_are_cut_to_the_first() {
    let data: Vec<u8> = (0..72).map(|i| if i % 3 == 0 { i / 3 } else { 200 }).collect();
    let fields = "ElementType = MET_UCHAR_ARRAY\nElementNumberOfChannels = 3\n";
    let loaded = load(META, &with_data(&header(fields), &data));
    assert_eq!(values_of(&loaded), counted());
    assert_eq!(loaded.warnings, [Warning::FirstComponentOnly { components: 3 }]);
    let series = "NDims = 4\nDimSize = 4 3 2 2\nElementSpacing = 1 1 1 1\nOffset = 0 0 0 0\n\
                  TransformMatrix = 0 1 0 0 1 0 0 0 0 0 1 0 0 0 0 1\nElementType = MET_UCHAR\n\
                  ElementDataFile = LOCAL\n";
    let loaded = load(META, &with_data(series, &[bytes(), bytes()].concat()));
    assert_eq!(values_of(&loaded), counted());
    assert_eq!(loaded.warnings, [Warning::FirstFrameOnly { frames: 2 }]);
    assert_eq!(loaded.volume.grid().orientation_letters(), "PLS");
}

#[test]
fn images_of_two_dimensions_get_a_third() {
    let header = "NDims = 2\nDimSize = 6 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
    let loaded = load(META, &with_data(header, &bytes()));
    assert_eq!(loaded.volume.grid().dims(), [6, 4, 1]);
    let expected = [
        Warning::SpacingAssumed { axis: 1 },
        Warning::SpacingAssumed { axis: 2 },
        Warning::OrientationUnknown { axes: "left, posterior, superior" },
    ];
    assert_eq!(loaded.warnings, expected);
    assert_eq!(loaded.volume.grid().orientation_letters(), "LPS", "what the warning says");
}

#[test]
fn wide_integers_become_f64() {
    let data: Vec<u8> = (0..24_u64).flat_map(u64::to_le_bytes).collect();
    let loaded =
        load(META, &with_data(&header("ElementType = MET_ULONG_LONG\nElementByteOrderMSB = False\n"), &data));
    assert_eq!(loaded.warnings, [Warning::ConvertedToFloat64 { from: "uint64" }]);
    assert_eq!(values_of(&loaded), counted());
}

#[test]
fn a_missing_byte_order_is_told() {
    let file = with_data(&header("ElementType = MET_SHORT\n").replace("4 3 2", "2 3 2"), &bytes());
    assert_eq!(load(META, &file).warnings, [Warning::ByteOrderAssumed]);
}

#[test]
fn a_header_before_the_voxels_is_skipped() {
    for size in ["8", "-1"] {
        let file = header(&format!("ElementType = MET_UCHAR\nHeaderSize = {size}\n"));
        let loaded = load(META, &with_data(&file, &[b"anything", bytes().as_slice()].concat()));
        assert_eq!(values_of(&loaded), counted());
    }
}

#[test]
fn a_detached_header_needs_its_data() {
    let header = header("ElementType = MET_UCHAR\n").replace("LOCAL", "voxels.raw");
    assert_eq!(values_of(&read_bytes(META, header.as_bytes(), Some(&bytes())).unwrap()), counted());
    assert!(matches!(refusal(META, header.as_bytes()), ReadError::Detached));
}

#[test]
fn bad_headers_are_refused() {
    type Check = fn(&ReadError) -> bool;
    let swap = |from: &str, to: &str| {
        let header = header("ElementType = MET_UCHAR\n");
        assert!(header.contains(from), "{from}");
        with_data(&header.replace(from, to), &bytes())
    };
    let compressed =
        |data: &[u8]| with_data(&header("ElementType = MET_UCHAR\nCompressedData = True\n"), data);
    let endless = format!("NDims = {}", "3".repeat(2 << 20)).into_bytes();
    let cases: Vec<(&str, Vec<u8>, Check)> = vec![
        ("empty", vec![], |e| matches!(e, ReadError::Empty)),
        ("no magic", b"hello world\n".to_vec(), |e| matches!(e, ReadError::WrongMagic { .. })),
        ("endless line", endless, |e| matches!(e, ReadError::HeaderTooLong { .. })),
        ("garbage", with_data("NDims = 3\n", b"\xff\xfe\x00garbage\n"), |e| {
            matches!(e, ReadError::BadLine { line: 2, .. })
        }),
        ("no data file", b"NDims = 3\n".to_vec(), |e| {
            matches!(e, ReadError::MissingField { field: "ElementDataFile", .. })
        }),
        ("not an image", swap("Image", "Tube"), |e| {
            matches!(e, ReadError::BadField { field: "ObjectType", .. })
        }),
        ("no dimension", swap("NDims = 3", "NDims = 0"), |e| matches!(e, ReadError::BadField { .. })),
        ("dimension", swap("NDims = 3", "NDims = 11"), |e| matches!(e, ReadError::BadField { .. })),
        ("zero size", swap("4 3 2", "4 0 2"), |e| matches!(e, ReadError::BadDimension { axis: 2, .. })),
        ("negative size", swap("4 3 2", "4 3 -2"), |e| matches!(e, ReadError::BadDimension { axis: 3, .. })),
        ("2^40 voxels", swap("4 3 2", "16384 8192 8192"), |e| matches!(e, ReadError::TooLarge { .. })),
        ("overflow", swap("4 3 2", "9223372036854775807 9223372036854775807 2"), |e| {
            matches!(e, ReadError::TooLarge { .. })
        }),
        ("truncated", swap("4 3 2", "5 3 2"), |e| {
            matches!(e, ReadError::Truncated { expected_bytes: 30, found_bytes: 24, .. })
        }),
        ("truncated zlib", compressed(&zlib(&bytes()[..20])), |e| {
            matches!(e, ReadError::Truncated { expected_bytes: 24, found_bytes: 20, .. })
        }),
        ("not zlib", compressed(&bytes()), |e| matches!(e, ReadError::Corrupt { encoding: "zlib", .. })),
        ("type", swap("MET_UCHAR", "MET_STRING"), |e| matches!(e, ReadError::Unsupported { .. })),
        ("channels", plain("ElementNumberOfChannels = 0\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("many channels", plain("ElementNumberOfChannels = 99999999999\n"), |e| {
            matches!(e, ReadError::BadField { .. })
        }),
        ("spacing zero", swap("ElementSpacing = 1 1 1", "ElementSpacing = 1 0 1"), |e| {
            matches!(e, ReadError::NotInvertible { .. })
        }),
        ("spacing NaN", swap("ElementSpacing = 1 1 1", "ElementSpacing = 1 nan 1"), |e| {
            matches!(e, ReadError::NotFinite { field: "ElementSpacing" })
        }),
        ("offset infinite", swap("Offset = 0 0 0", "Offset = 0 inf 0"), |e| {
            matches!(e, ReadError::NotFinite { field: "Offset" })
        }),
        ("singular", plain("TransformMatrix = 1 0 0 1 0 0 0 0 1\n"), |e| {
            matches!(e, ReadError::NotInvertible { field: "TransformMatrix", .. })
        }),
        ("short matrix", plain("TransformMatrix = 1 0 0 1\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("NaN matrix", plain("TransformMatrix = 1 0 0 0 nan 0 0 0 1\n"), |e| {
            matches!(e, ReadError::NotFinite { .. })
        }),
        ("flag", plain("CompressedData = perhaps\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("header size", plain("HeaderSize = -2\n"), |e| matches!(e, ReadError::BadField { .. })),
        ("header size beyond the end", plain("HeaderSize = 9223372036854775807\n"), |e| {
            matches!(e, ReadError::Truncated { .. })
        }),
        ("header size of compressed", plain("CompressedData = True\nHeaderSize = -1\n"), |e| {
            matches!(e, ReadError::BadField { field: "HeaderSize", .. })
        }),
        ("list", swap("LOCAL", "LIST"), |e| matches!(e, ReadError::Unsupported { .. })),
        ("pattern", swap("LOCAL", "slice%03d.raw 1 2 1"), |e| matches!(e, ReadError::Unsupported { .. })),
    ];
    for (name, file, check) in cases {
        let error = refusal(META, &file);
        assert!(check(&error), "{name}: {error:?}");
    }
}
