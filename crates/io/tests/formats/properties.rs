//! What holds for any input: readers end with a volume or an error, and what is written comes back.

use super::build::{Nifti, gzip, with_data, zlib};
use glam::{DAffine3, DMat3, DQuat, DVec3, EulerRot};
use proptest::prelude::*;
use wheatstone_core::volume::{Grid, Volume, VoxelType, Voxels};
use wheatstone_io::{Format, RawLayout, encode_nrrd, read_bytes, read_raw_bytes};

const FORMATS: [Format; 3] = [Format::Nifti, Format::Nrrd, Format::MetaImage];

fn nrrd(encoding: &str, data: &[u8]) -> Vec<u8> {
    let header = format!(
        "NRRD0005\ntype: uint16\ndimension: 4\nsizes: 2 3 2 2\nendian: big\nencoding: {encoding}\n\
         space: left-posterior-superior\nspace directions: none (1,0,0) (0,1.5,0) (0,0,-2)\n\
         space origin: (1,2,3)\nkinds: list domain domain domain\nbyte skip: 0\nline skip: 0\n\n"
    );
    with_data(&header, data)
}

fn metaimage(compressed: &str, data: &[u8]) -> Vec<u8> {
    let header = format!(
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\n\
         CompressedData = {compressed}\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\n\
         ElementSpacing = 1 1.5 2\nDimSize = 3 4 2\nElementNumberOfChannels = 2\nHeaderSize = 0\n\
         ElementType = MET_SHORT\nElementDataFile = LOCAL\n"
    );
    with_data(&header, data)
}

/// Valid files of each format.
fn valid_files() -> Vec<(Format, Vec<u8>)> {
    let data: Vec<u8> = (0..192).collect();
    let nifti = Nifti { slope: 2.0, ..Nifti::new([4, 3, 2]).of_type(VoxelType::I16) };
    let nifti_2 = Nifti { is_2: true, big_endian: true, s_form_code: 0, q_form_code: 1, ..nifti.clone() };
    vec![
        (Format::Nifti, nifti.file(&data[..48])),
        (Format::Nifti, nifti_2.file(&data[..48])),
        (Format::Nifti, gzip(&nifti.file(&data[..48]))),
        (Format::Nrrd, nrrd("raw", &data[..48])),
        (Format::Nrrd, nrrd("gzip", &gzip(&data[..48]))),
        (Format::Nrrd, nrrd("ascii", &b"12 ".repeat(24))),
        (Format::MetaImage, metaimage("False", &data[..96])),
        (Format::MetaImage, metaimage("True", &zlib(&data[..96]))),
    ]
}

/// Replacements for a byte that headers are likely to trip over.
fn odd_byte() -> impl Strategy<Value = u8> {
    prop_oneof![any::<u8>(), Just(b'-'), Just(b'9'), Just(b'e'), Just(b'\n'), Just(b' '), Just(0xff), Just(0)]
}

fn voxels() -> impl Strategy<Value = ([usize; 3], Voxels)> {
    let dims = [1..7_usize, 1..7, 1..7];
    (dims, 0..VoxelType::ALL.len()).prop_flat_map(|(dims, type_index)| {
        let voxel_type = VoxelType::ALL[type_index];
        let byte_count = dims.iter().product::<usize>() * voxel_type.byte_size();
        prop::collection::vec(any::<u8>(), byte_count)
            .prop_map(move |bytes| (dims, Voxels::from_le_bytes(voxel_type, &bytes)))
    })
}

fn matrix() -> impl Strategy<Value = DAffine3> {
    let angles = [-3.0..3.0, -3.0..3.0, -3.0..3.0_f64];
    let spacings_mm = [1e-4..1e4, 1e-4..1e4, -1e4..-1e-4_f64];
    let origin_mm = [-1e6..1e6, -1e6..1e6, -1e6..1e6_f64];
    (angles, spacings_mm, origin_mm).prop_map(|(angles, spacings_mm, origin_mm)| {
        let rotation = DMat3::from_quat(DQuat::from_euler(EulerRot::XYZ, angles[0], angles[1], angles[2]));
        let linear = rotation * DMat3::from_diagonal(DVec3::from(spacings_mm));
        DAffine3::from_mat3_translation(linear, DVec3::from(origin_mm))
    })
}

#[test]
fn the_files_to_be_damaged_are_valid() {
    for (format, file) in valid_files() {
        read_bytes(format, &file, None).unwrap_or_else(|error| panic!("{format}: {error}"));
    }
}

#[test]
fn every_truncation_is_an_error_or_a_warning() {
    for (format, file) in valid_files() {
        for length in 0..file.len() {
            if let Ok(loaded) = read_bytes(format, &file[..length], None) {
                let is_text = file.windows(5).any(|word| word == b"ascii");
                assert!(is_text || !loaded.warnings.is_empty(), "{format}, {length} of {}", file.len());
            }
        }
    }
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..700)) {
        for format in FORMATS {
            let _ = read_bytes(format, &bytes, None);
            let _ = read_bytes(format, &bytes, Some(&bytes));
        }
        let starts: [(Format, &[u8]); 3] =
            [(Format::Nrrd, b"NRRD0004\n"), (Format::MetaImage, b"NDims = 3\n"), (Format::Nifti, &[0x1f, 0x8b, 8, 0])];
        for (format, start) in starts {
            let _ = read_bytes(format, &[start, &bytes].concat(), None);
        }
    }

    #[test]
    fn arbitrary_layouts_never_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        dims in [prop_oneof![0..9_u64, any::<u64>()], prop_oneof![0..9_u64, any::<u64>()], prop_oneof![0..9_u64, any::<u64>()]],
        spacing_mm in [any::<f64>(), any::<f64>(), any::<f64>()],
        type_index in 0..VoxelType::ALL.len(),
        header_bytes in prop_oneof![0..99_u64, any::<u64>()],
        big_endian: bool,
        name in "[a-z_0-9x.]{0,40}",
    ) {
        let voxel_type = VoxelType::ALL[type_index];
        let layout = RawLayout { dims, voxel_type, spacing_mm, big_endian, header_bytes };
        let _ = read_raw_bytes(&bytes, &layout);
        let _ = RawLayout::from_file_name(&name);
    }

    #[test]
    fn damaged_files_never_panic(
        which in 0..8_usize,
        damage in prop::collection::vec((any::<prop::sample::Index>(), odd_byte()), 1..6),
        length in any::<prop::sample::Index>(),
        is_cut: bool,
    ) {
        let (format, mut file) = valid_files().swap_remove(which);
        for (at, byte) in damage {
            let at = at.index(file.len());
            file[at] = byte;
        }
        if is_cut {
            file.truncate(length.index(file.len()));
        }
        let _ = read_bytes(format, &file, Some(&[1; 64]));
    }

    #[test]
    fn written_volumes_come_back_exactly(((dims, voxels), matrix) in (voxels(), matrix())) {
        let grid = Grid::new(dims, matrix).unwrap();
        let Ok(volume) = Volume::new(grid, voxels) else { return Ok(()) };
        let mut file = Vec::new();
        encode_nrrd(&mut file, &volume).unwrap();
        let loaded = read_bytes(Format::Nrrd, &file, None).unwrap();
        prop_assert_eq!(loaded.volume.grid(), volume.grid());
        prop_assert_eq!(loaded.volume.voxels(), volume.voxels());
        prop_assert_eq!(loaded.warnings, []);
    }
}

#[test]
#[ignore = "writes seeds for the fuzz targets into fuzz/corpus"]
fn write_fuzz_seeds() {
    let corpus = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus");
    for (number, (format, file)) in valid_files().into_iter().enumerate() {
        let folder = corpus.join(format.to_string().to_ascii_lowercase());
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(format!("seed-{number}")), file).unwrap();
    }
}
