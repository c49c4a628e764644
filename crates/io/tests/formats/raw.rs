//! Raw files.

use super::build::{encode, sample_values, values_of};
use glam::DVec3;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{RawLayout, ReadError, Warning, read_raw_bytes};

#[test]
fn every_type_and_byte_order_keeps_its_values() {
    for &voxel_type in VoxelType::ALL {
        for big_endian in [false, true] {
            let values = sample_values(voxel_type, 24);
            let mut bytes = vec![0; 7];
            bytes.extend(encode(&values, voxel_type, big_endian));
            let mut layout = RawLayout::new([2, 3, 4], voxel_type);
            layout.header_bytes = 7;
            layout.big_endian = big_endian;
            layout.spacing_mm = [1.0, 0.5, 2.0];
            let loaded = read_raw_bytes(&bytes, &layout).unwrap();
            assert_eq!(values_of(&loaded), values);
            assert_eq!(loaded.volume.voxels().voxel_type(), voxel_type);
            let grid = loaded.volume.grid();
            assert_eq!(grid.spacing_mm(), DVec3::new(1.0, 0.5, 2.0));
            assert_eq!(grid.patient_from_index().translation, DVec3::new(-0.5, -0.5, -3.0));
        }
    }
}

#[test]
fn spacings_that_are_too_different_for_steps_of_the_smallest_are_told() {
    let warnings = |spacing_mm| {
        let layout = RawLayout { spacing_mm, ..RawLayout::new([8; 3], VoxelType::U8) };
        read_raw_bytes(&[1; 512], &layout).unwrap().warnings
    };
    assert_eq!(warnings([0.1, 1.0, 100.0]), []);
    for spacing_mm in [[1e-6, 1.0, 1e6], [1e-3, 1.0, 1e3]] {
        let told = warnings(spacing_mm);
        assert!(matches!(told[..], [Warning::StepsLengthened { .. }]), "{told:?}");
        assert!(told[0].to_string().contains(&format!("{:.3e} mm", spacing_mm[0])), "{}", told[0]);
    }
}

#[test]
fn names_tell_layouts() {
    let layout = |dims, voxel_type| Some(RawLayout::new(dims, voxel_type));
    let from = RawLayout::from_file_name;
    assert_eq!(from("bonsai_256x256x256_uint8.raw"), layout([256, 256, 256], VoxelType::U8));
    assert_eq!(from("csafe_heptane_302x301x300_uint8.raw"), layout([302, 301, 300], VoxelType::U8));
    assert_eq!(from("a_1x2x3_float64.raw.gz"), layout([1, 2, 3], VoxelType::F64));
    assert_eq!(from("a_1X2X3_INT16.RAW"), layout([1, 2, 3], VoxelType::I16));
    let not_layouts = [
        "bonsai.raw",
        "a_1x2_uint8.raw",
        "a_1x2x3x4_uint8.raw",
        "a_1x2x3_uint9.raw",
        "a_1x2x_uint8.raw",
        "a_1x-2x3_uint8.raw",
        "a_99999999999999999999x1x1_uint8.raw",
        "",
    ];
    for name in not_layouts {
        assert_eq!(from(name), None, "{name}");
    }
}

#[test]
fn layouts_that_do_not_fit_are_refused() {
    let bytes = [0; 24];
    let refused = |dims, change: fn(&mut RawLayout)| {
        let mut layout = RawLayout::new(dims, VoxelType::U16);
        change(&mut layout);
        read_raw_bytes(&bytes, &layout).unwrap_err()
    };
    let none = |_: &mut RawLayout| {};
    assert!(matches!(refused([0, 1, 1], none), ReadError::BadDimension { axis: 1, .. }));
    assert!(matches!(refused([1 << 20, 1 << 20, 1], none), ReadError::TooLarge { .. }));
    assert!(matches!(refused([u64::MAX; 3], none), ReadError::TooLarge { .. }));
    let truncated = refused([13, 1, 1], none);
    assert!(matches!(truncated, ReadError::Truncated { expected_bytes: 26, found_bytes: 24, .. }));
    let skipped = refused([12, 1, 1], |layout| layout.header_bytes = u64::MAX);
    assert!(matches!(skipped, ReadError::Truncated { .. }), "{skipped:?}");
    let flat = refused([12, 1, 1], |layout| layout.spacing_mm[2] = 0.0);
    assert!(matches!(flat, ReadError::NotInvertible { .. }));
    let not_finite = refused([12, 1, 1], |layout| layout.spacing_mm[2] = f64::NAN);
    assert!(matches!(not_finite, ReadError::NotFinite { .. }));
    let empty = read_raw_bytes(&[], &RawLayout::new([1, 1, 1], VoxelType::U8)).unwrap_err();
    assert!(matches!(empty, ReadError::Empty));
    let longer = read_raw_bytes(&bytes, &RawLayout::new([2, 2, 2], VoxelType::U8)).unwrap();
    assert_eq!(longer.warnings, [Warning::ExtraData]);
}
