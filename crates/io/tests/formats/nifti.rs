//! NIfTI-1 and NIfTI-2.

use super::build::{Nifti, encode, gzip, load, refusal, sample_values, values_of};
use glam::DVec3;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Format::Nifti as NIFTI, ReadError, Warning, read_bytes};

const DIMS: [i64; 3] = [4, 3, 2];

fn bytes() -> Vec<u8> {
    (0..24).collect()
}

#[test]
fn every_type_version_and_byte_order_keeps_its_values() {
    for &voxel_type in VoxelType::ALL {
        for (is_2, big_endian) in [(false, false), (false, true), (true, false), (true, true)] {
            let header = Nifti { is_2, big_endian, ..Nifti::new(DIMS).of_type(voxel_type) };
            let values = sample_values(voxel_type, 24);
            let file = header.file(&encode(&values, voxel_type, big_endian));
            for file in [gzip(&file), file] {
                let loaded = load(NIFTI, &file);
                assert_eq!(loaded.volume.voxels().voxel_type(), voxel_type);
                assert_eq!(values_of(&loaded), values, "{voxel_type} v2:{is_2} big:{big_endian}");
                assert_eq!(loaded.volume.grid().dims(), [4, 3, 2]);
                assert_eq!(loaded.warnings, []);
            }
        }
    }
}

#[test]
fn voxels_of_a_pair_come_from_the_second_file() {
    for is_2 in [false, true] {
        let header = Nifti { is_2, detached: true, ..Nifti::new(DIMS) }.header();
        let loaded = read_bytes(NIFTI, &header, Some(&bytes())).unwrap();
        assert_eq!(values_of(&loaded)[23], 23.0);
        assert!(matches!(refusal(NIFTI, &header), ReadError::Detached));
    }
}

#[test]
fn slope_and_intercept_make_floats_unless_whole_numbers_stay_whole() {
    let load_scaled =
        |slope, intercept| load(NIFTI, &Nifti { slope, intercept, ..Nifti::new(DIMS) }.file(&bytes()));
    let type_and_last = |slope, intercept| {
        let loaded = load_scaled(slope, intercept);
        (loaded.volume.voxels().voxel_type(), values_of(&loaded)[23])
    };
    assert_eq!(type_and_last(0.0, 7.0), (VoxelType::U8, 23.0));
    assert_eq!(type_and_last(1.0, 0.0), (VoxelType::U8, 23.0));
    assert_eq!(type_and_last(1.0, 100.0), (VoxelType::U8, 123.0));
    assert_eq!(type_and_last(1.0, -1024.0), (VoxelType::I16, -1001.0));
    assert_eq!(type_and_last(1.0, 60000.0), (VoxelType::U16, 60023.0));
    assert_eq!(type_and_last(1.0, 0.5), (VoxelType::F32, 23.5));
    assert_eq!(type_and_last(2.0, 1.0), (VoxelType::F32, 47.0));
    let odd = load_scaled(f64::NAN, 0.0);
    assert!(matches!(odd.warnings[..], [Warning::ScalingIgnored { .. }]));
    assert_eq!(odd.volume.voxels().voxel_type(), VoxelType::U8);
}

#[test]
fn wide_integers_become_f64_and_components_are_cut_to_the_first() {
    let wide: Vec<u8> = (0..24_i64).flat_map(|i| (i << 40).to_le_bytes()).collect();
    for (datatype, from) in [(1024, "int64"), (1280, "uint64")] {
        let loaded = load(NIFTI, &Nifti { datatype, ..Nifti::new(DIMS) }.file(&wide));
        assert_eq!(loaded.warnings, [Warning::ConvertedToFloat64 { from }]);
        assert_eq!(values_of(&loaded)[23], 23.0 * 40_f64.exp2());
    }
    for (datatype, components) in [(128, 3_u8), (2304, 4)] {
        let colours: Vec<u8> =
            (0..24).flat_map(|i| (0..components).map(move |c| i + 100 * c.min(1))).collect();
        let loaded = load(NIFTI, &Nifti { datatype, ..Nifti::new(DIMS) }.file(&colours));
        assert_eq!(loaded.warnings, [Warning::FirstComponentOnly { components: components.into() }]);
        assert_eq!(values_of(&loaded), (0..24).map(f64::from).collect::<Vec<_>>());
    }
    let complex: Vec<u8> = (0..24_u8).flat_map(|i| [f32::from(i), 1e9]).flat_map(f32::to_le_bytes).collect();
    let loaded = load(NIFTI, &Nifti { datatype: 32, ..Nifti::new(DIMS) }.file(&complex));
    assert_eq!(values_of(&loaded)[23], 23.0);
}

#[test]
fn a_series_gives_its_first_frame_even_if_later_ones_are_missing() {
    let mut header = Nifti { rank: 4, ..Nifti::new(DIMS) };
    header.sizes[3] = 5;
    let loaded = load(NIFTI, &header.file(&bytes()));
    assert_eq!(loaded.warnings, [Warning::FirstFrameOnly { frames: 5 }]);
    assert_eq!(values_of(&loaded).len(), 24);
}

#[test]
fn units_scale_to_millimetres() {
    for (units, mm) in [(0, 2.0), (1, 2000.0), (2, 2.0), (3, 0.002)] {
        let mut header = Nifti { units, ..Nifti::new(DIMS) };
        header.s_form_rows[0] = [2.0, 0.0, 0.0, 2.0];
        let grid = load(NIFTI, &header.file(&bytes())).volume.grid().clone();
        assert!((grid.spacing_mm().x - mm).abs() < 1e-9);
        assert!((grid.patient_from_index().translation.x - mm).abs() < 1e-9);
    }
}

#[test]
fn without_a_form_the_spacing_counts_and_the_user_is_told() {
    let mut header = Nifti { s_form_code: 0, ..Nifti::new(DIMS) };
    header.pixdim = [1.0, 0.5, -2.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let loaded = load(NIFTI, &header.file(&bytes()));
    assert_eq!(loaded.volume.grid().spacing_mm(), DVec3::new(0.5, 2.0, 1.0));
    assert_eq!(
        loaded.warnings,
        [
            Warning::SpacingAssumed { axis: 3 },
            Warning::OrientationUnknown { axes: "right, anterior, superior" }
        ]
    );
}

#[test]
fn a_quaternion_turns_as_the_standard_says() {
    let mut header = Nifti { s_form_code: 0, q_form_code: 1, ..Nifti::new(DIMS) };
    header.quaternion = [0.5_f64.sqrt(), 0.0, 0.0];
    assert_eq!(load(NIFTI, &header.file(&bytes())).volume.grid().orientation_letters(), "RSP");
    header.pixdim[0] = -1.0;
    assert_eq!(load(NIFTI, &header.file(&bytes())).volume.grid().orientation_letters(), "RSA");
}

#[test]
fn voxels_may_start_after_an_extension() {
    let header = Nifti { data_offset_bytes: Some(368.0), ..Nifti::new(DIMS) }.header();
    let loaded = load(NIFTI, &[header.as_slice(), &[9; 20], &bytes()].concat());
    assert_eq!(values_of(&loaded)[..3], [0.0, 1.0, 2.0]);
}

#[test]
fn unusable_voxels_and_left_over_bytes_are_told() {
    let mut values = sample_values(VoxelType::F32, 24);
    values[5] = f64::NAN;
    values[6] = f64::INFINITY;
    let header = Nifti::new(DIMS).of_type(VoxelType::F32);
    let loaded = load(NIFTI, &header.file(&encode(&values, VoxelType::F32, false)));
    assert_eq!(loaded.warnings, [Warning::NonFiniteVoxels { count: 2 }]);
    let nothing = header.file(&encode(&[f64::NAN; 24], VoxelType::F32, false));
    assert!(matches!(refusal(NIFTI, &nothing), ReadError::NothingFinite { count: 24 }));
    let longer = Nifti::new(DIMS).file(&[0; 30]);
    assert_eq!(load(NIFTI, &longer).warnings, [Warning::ExtraData]);
}

#[test]
fn a_damaged_end_of_the_compressed_stream_is_told() {
    let mut file = gzip(&Nifti::new(DIMS).file(&bytes()));
    let checksum_at = file.len() - 8;
    file[checksum_at] ^= 1;
    assert!(matches!(load(NIFTI, &file).warnings[..], [Warning::Unverified { .. }]));
}

#[test]
fn bad_headers_are_refused() {
    let sized = |sizes: [i64; 3]| Nifti::new(sizes).file(&bytes());
    let version_2 = |sizes| Nifti { is_2: true, ..Nifti::new(sizes) }.file(&bytes());
    let with = |change: fn(&mut Nifti)| {
        let mut header = Nifti::new(DIMS);
        change(&mut header);
        header.file(&bytes())
    };
    type Check = fn(&ReadError) -> bool;
    let cases: [(&str, Vec<u8>, Check); 24] = [
        ("empty", vec![], |e| matches!(e, ReadError::Empty)),
        ("short", vec![1; 40], |e| matches!(e, ReadError::Truncated { what: "header", .. })),
        ("no magic", vec![7; 400], |e| matches!(e, ReadError::WrongMagic { .. })),
        ("short NIfTI-2", version_2(DIMS)[..400].to_vec(), |e| {
            matches!(e, ReadError::Truncated { what: "header", expected_bytes: 540, found_bytes: 400 })
        }),
        ("zero size", sized([4, 0, 2]), |e| matches!(e, ReadError::BadDimension { axis: 2, value: 0, .. })),
        ("negative size", sized([4, 3, -2]), |e| {
            matches!(e, ReadError::BadDimension { axis: 3, value: -2, .. })
        }),
        ("rank 0", with(|h| h.rank = 0), |e| matches!(e, ReadError::BadField { field: "dim[0]", .. })),
        ("rank 8", with(|h| h.rank = 8), |e| matches!(e, ReadError::BadField { field: "dim[0]", .. })),
        ("2^40 voxels", version_2([1 << 14, 1 << 13, 1 << 13]), |e| matches!(e, ReadError::TooLarge { .. })),
        ("overflow", version_2([i64::MAX, i64::MAX, i64::MAX]), |e| matches!(e, ReadError::TooLarge { .. })),
        ("more voxels than bytes", sized([300, 300, 300]), |e| {
            matches!(
                e,
                ReadError::Truncated { what: "voxel data", expected_bytes: 27_000_000, found_bytes: 24 }
            )
        }),
        ("compressed, far too short", gzip(&sized([2000, 2000, 1000])), |e| {
            matches!(e, ReadError::Truncated { what: "voxel data", expected_bytes: 4_000_000_000, .. })
        }),
        ("compressed, too short", gzip(&sized([5, 3, 2])), |e| {
            matches!(e, ReadError::Truncated { what: "voxel data", expected_bytes: 30, found_bytes: 24 })
        }),
        ("broken off", gzip(&sized(DIMS))[..40].to_vec(), |e| matches!(e, ReadError::Truncated { .. })),
        ("1 bit", with(|h| h.datatype = 1), |e| matches!(e, ReadError::Unsupported { .. })),
        ("128-bit float", with(|h| h.datatype = 1536), |e| matches!(e, ReadError::Unsupported { .. })),
        ("type unknown", with(|h| h.datatype = 999), |e| matches!(e, ReadError::Unsupported { .. })),
        ("singular", with(|h| h.s_form_rows[1] = [1.0, 0.0, 0.0, 0.0]), |e| {
            matches!(e, ReadError::NotInvertible { field: "srow_x, srow_y, srow_z", .. })
        }),
        ("all zero", with(|h| h.s_form_rows = [[0.0; 4]; 3]), |e| {
            matches!(e, ReadError::NotInvertible { .. })
        }),
        ("NaN", with(|h| h.s_form_rows[2][1] = f64::NAN), |e| matches!(e, ReadError::NotFinite { .. })),
        ("infinite", with(|h| h.s_form_rows[2][3] = f64::INFINITY), |e| {
            matches!(e, ReadError::NotFinite { .. })
        }),
        ("NaN spacing", with(|h| (h.s_form_code, h.pixdim[1]) = (0, f64::NAN)), |e| {
            matches!(e, ReadError::NotFinite { field: "pixdim" })
        }),
        ("offset NaN", with(|h| h.data_offset_bytes = Some(f64::NAN)), |e| {
            matches!(e, ReadError::BadField { field: "vox_offset", .. })
        }),
        ("offset beyond the end", with(|h| h.data_offset_bytes = Some(1e12)), |e| {
            matches!(e, ReadError::Truncated { what: "part before the voxel data", .. })
        }),
    ];
    for (name, file, check) in cases {
        let error = refusal(NIFTI, &file);
        assert!(check(&error), "{name}: {error:?}");
    }
}

#[test]
fn a_gzip_bomb_is_read_up_to_the_declared_size() {
    let bomb = gzip(&Nifti::new(DIMS).file(&vec![1; 64 << 20]));
    assert!(bomb.len() < 1 << 19);
    let loaded = load(NIFTI, &bomb);
    assert_eq!(values_of(&loaded).len(), 24);
    assert_eq!(loaded.warnings, [Warning::ExtraData]);
}

#[test]
fn a_damaged_gzip_stream_is_refused() {
    let noise: Vec<u8> = (0..60_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let mut file = gzip(&Nifti::new([60, 50, 20]).file(&noise));
    let middle = file.len() / 2;
    file[middle - 200..middle].fill(0xff);
    let error = refusal(NIFTI, &file);
    assert!(matches!(error, ReadError::Corrupt { .. } | ReadError::Truncated { .. }), "{error:?}");
}
