//! Files on disk: formats by content and name, data files, writing.

use super::build::{Nifti, gzip, values_of};
use std::{
    fs,
    path::{Path, PathBuf},
};
use tempfile::TempDir;
use wheatstone_core::volume::{Grid, Volume, VoxelType, Voxels};
use wheatstone_io::{
    Cancel, Format, RawLayout, ReadError, Warning, WriteError, read_raw_unless, read_volume,
    read_volume_unless, write_atomically, write_nrrd,
};

const NRRD_FIELDS: &str = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n";
const META_FIELDS: &str = "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\n";

fn bytes() -> Vec<u8> {
    (0..24).collect()
}

fn nifti() -> Vec<u8> {
    Nifti::new([4, 3, 2]).file(&bytes())
}

/// A folder with one file.
fn folder_with(name: &str, content: &[u8]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, content).unwrap();
    (folder, path)
}

/// The problem of a path that must be refused; the message names a file in its folder.
fn refused(path: &Path) -> ReadError {
    let error = read_volume(path).expect_err("must be refused");
    let text = error.to_string();
    assert!(text.contains(&path.parent().unwrap().display().to_string()), "{text}");
    assert!(text.contains("expected"), "{text}");
    match error {
        ReadError::InFile { problem, .. } => *problem,
        other => panic!("no path: {other}"),
    }
}

#[test]
fn formats_follow_names_and_content() {
    let nrrd = [NRRD_FIELDS.as_bytes(), b"\n", &bytes()].concat();
    let meta = [META_FIELDS.as_bytes(), b"ElementDataFile = LOCAL\n", &bytes()].concat();
    let cases = [
        ("a.nii", nifti(), Format::Nifti, true),
        ("a.NII", nifti(), Format::Nifti, true),
        ("a.nii.gz", gzip(&nifti()), Format::Nifti, true),
        ("compressed without saying so.nii", gzip(&nifti()), Format::Nifti, true),
        ("a.nrrd", nrrd.clone(), Format::Nrrd, true),
        ("a.mha", meta.clone(), Format::MetaImage, true),
        ("b_4x3x2_uint8.raw", bytes(), Format::Raw, true),
        ("b_4x3x2_uint8.raw.gz", gzip(&bytes()), Format::Raw, true),
        ("nrrd.nii", nrrd, Format::Nrrd, false),
        ("nifti.mha", nifti(), Format::Nifti, false),
        ("meta.nrrd", meta, Format::MetaImage, false),
        ("nifti", nifti(), Format::Nifti, false),
        ("nifti.raw", nifti(), Format::Nifti, false),
    ];
    for (name, content, format, name_is_right) in cases {
        let (_folder, path) = folder_with(name, &content);
        let loaded = read_volume(&path).unwrap();
        assert_eq!(loaded.format, format, "{name}");
        assert_eq!(values_of(&loaded)[23], 23.0, "{name}");
        let mismatch = Warning::ExtensionMismatch { format };
        assert_eq!(loaded.warnings.contains(&mismatch), !name_is_right, "{name}");
    }
}

#[test]
fn raw_data_that_looks_compressed_is_taken_as_it_is() {
    let mut data = bytes();
    data[..2].copy_from_slice(&[0x1f, 0x8b]);
    let (_folder, path) = folder_with("b_4x3x2_uint8.raw", &data);
    assert_eq!(values_of(&read_volume(&path).unwrap())[..2], [31.0, 139.0]);
}

#[test]
fn nifti_pairs_are_found_from_either_file() {
    let header = Nifti { detached: true, ..Nifti::new([4, 3, 2]) }.header();
    for (image, content) in [("a.img", bytes()), ("a.img.gz", gzip(&bytes()))] {
        let (folder, path) = folder_with("a.hdr", &header);
        let problem = refused(&path);
        assert!(matches!(problem, ReadError::DataFile { fault: "does not exist", .. }), "{problem:?}");
        let image_path = folder.path().join(image);
        fs::write(&image_path, content).unwrap();
        for path in [path, image_path.clone()] {
            assert_eq!(values_of(&read_volume(&path).unwrap())[23], 23.0);
        }
        fs::write(&image_path, [1, 2, 3]).unwrap();
        let error = read_volume(&folder.path().join("a.hdr")).unwrap_err();
        assert!(error.to_string().contains(image), "{error}");
    }
}

#[test]
fn data_files_lie_beside_their_headers() {
    let nhdr = format!("{NRRD_FIELDS}data file: voxels.raw\n");
    let mhd = format!("{META_FIELDS}ElementDataFile = voxels.raw\n");
    for (name, header) in [("a.nhdr", nhdr), ("a.mhd", mhd)] {
        let (folder, path) = folder_with(name, header.as_bytes());
        let data_path = folder.path().join("voxels.raw");
        let fault = || match refused(&path) {
            ReadError::DataFile { fault, .. } => fault,
            other => panic!("{other:?}"),
        };
        assert_eq!(fault(), "does not exist");
        fs::create_dir(&data_path).unwrap();
        assert_eq!(fault(), "is not a regular file");
        fs::remove_dir(&data_path).unwrap();
        fs::write(&data_path, b"").unwrap();
        assert_eq!(fault(), "is empty");
        fs::write(&data_path, [0; 9]).unwrap();
        assert!(matches!(refused(&path), ReadError::Truncated { found_bytes: 9, .. }));
        fs::write(&data_path, bytes()).unwrap();
        assert_eq!(values_of(&read_volume(&path).unwrap())[23], 23.0);
        fs::write(&path, header.replace("voxels.raw", &format!("./{name}"))).unwrap();
        assert_eq!(fault(), "is the header itself");
    }
}

#[test]
fn paths_that_are_no_volumes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(refused(&folder.path().join("missing.nii")), ReadError::NotFound));
    let folder_named_as_volume = folder.path().join("folder.nrrd");
    fs::create_dir(&folder_named_as_volume).unwrap();
    assert!(matches!(refused(&folder_named_as_volume), ReadError::NotAFile { found: "directory" }));
    type Check = fn(&ReadError) -> bool;
    let cases: [(&str, &[u8], Check); 7] = [
        ("empty.nii", b"", |e| matches!(e, ReadError::Empty)),
        ("text.txt", b"hello", |e| matches!(e, ReadError::UnknownFormat)),
        ("unnamed.raw", b"hello", |e| matches!(e, ReadError::RawName)),
        ("text.nrrd", b"hello", |e| matches!(e, ReadError::WrongMagic { .. })),
        ("text.mha", b"hello", |e| matches!(e, ReadError::WrongMagic { .. })),
        ("analyze.hdr", &[0; 348], |e| matches!(e, ReadError::WrongMagic { .. })),
        ("cut.nii.gz", &[0x1f, 0x8b], |e| matches!(e, ReadError::Truncated { .. })),
    ];
    for (name, content, check) in cases {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        let problem = refused(&path);
        assert!(check(&problem), "{name}: {problem:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_device_is_refused_before_it_is_opened() {
    let error = read_volume(Path::new("/dev/zero")).unwrap_err();
    assert!(matches!(error.problem(), ReadError::NotAFile { found: "device or pipe" }), "{error}");
}

#[test]
fn writing_leaves_one_whole_file() {
    let grid = Grid::centred([4, 3, 2], [1.0, 2.0, 3.0]).unwrap();
    let volume = Volume::new(grid.clone(), Voxels::U8(bytes())).unwrap();
    let (folder, path) = folder_with("a.nrrd", b"old");
    write_nrrd(&path, &volume).unwrap();
    let loaded = read_volume(&path).unwrap();
    assert_eq!(loaded.volume.grid(), &grid);
    assert_eq!(loaded.volume.voxels(), volume.voxels());
    assert_eq!(loaded.warnings, []);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn failed_writing_leaves_the_old_file() {
    let (folder, path) = folder_with("a.nrrd", b"old");
    let failure = write_atomically(&path, |_| Err(std::io::Error::other("disk on fire"))).unwrap_err();
    assert!(matches!(failure, WriteError::Write { .. }));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    let nowhere = folder.path().join("missing/a.nrrd");
    assert!(matches!(write_atomically(&nowhere, |_| Ok(())), Err(WriteError::Folder { .. })));
    fs::create_dir(folder.path().join("taken")).unwrap();
    let taken = folder.path().join("taken");
    assert!(matches!(write_atomically(&taken, |_| Ok(())), Err(WriteError::Replace { .. })));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

#[test]
fn a_read_that_is_given_up_ends_as_such_whatever_the_format() {
    let nrrd = [NRRD_FIELDS.as_bytes(), b"\n", &bytes()].concat();
    let detached = [META_FIELDS.as_bytes(), b"ElementDataFile = a.dat\n"].concat();
    let cases = [
        ("a.nii", nifti()),
        ("a.nii.gz", gzip(&nifti())),
        ("a.nrrd", nrrd),
        ("a.mhd", detached),
        ("a_4x3x2_uint8.raw", bytes()),
        ("a_4x3x2_uint8.raw.gz", gzip(&bytes())),
    ];
    for (name, content) in cases {
        let (folder, path) = folder_with(name, &content);
        fs::write(folder.path().join("a.dat"), bytes()).unwrap();
        let cancel = Cancel::default();
        assert!(read_volume_unless(&path, &cancel).is_ok(), "{name}");
        cancel.cancel();
        let error = read_volume_unless(&path, &cancel).unwrap_err();
        assert!(matches!(error.problem(), ReadError::Cancelled), "{name}: {error}");
        let error = read_raw_unless(&path, &RawLayout::new([1; 3], VoxelType::U8), &cancel).unwrap_err();
        assert!(matches!(error.problem(), ReadError::Cancelled), "{name}: {error}");
    }
}
