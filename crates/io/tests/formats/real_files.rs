//! Public volumes that may lie beside the checkout; see `SOURCES.md` there.

use std::path::PathBuf;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Format, read_volume};

#[test]
fn public_volumes_load_with_their_known_sizes_and_types() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    if !folder.is_dir() {
        println!("skipped: there is no {}", folder.display());
        return;
    }
    let expected = [
        ("bonsai.nii.gz", [256, 256, 256], Some(VoxelType::U8)),
        ("engine.nii.gz", [256, 256, 128], Some(VoxelType::U8)),
        ("heptane.nii.gz", [302, 302, 302], Some(VoxelType::U8)),
        ("fuel.nii.gz", [64, 33, 32], Some(VoxelType::U8)),
        ("seg3d_mr.nii.gz", [160, 232, 160], None),
        ("avm.nii.gz", [337, 319, 154], None),
    ];
    for (name, dims, voxel_type) in expected {
        let loaded = read_volume(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        let volume = &loaded.volume;
        let found = volume.voxels().voxel_type();
        println!("{name}: {found} {:?} {:?} {:?}", volume.range(), volume.grid(), loaded.warnings);
        assert_eq!(loaded.format, Format::Nifti, "{name}");
        assert_eq!(volume.grid().dims(), dims, "{name}");
        assert!(voxel_type.is_none_or(|expected| expected == found), "{name}: {found}");
        let (lo, hi) = volume.range();
        assert!(lo < hi, "{name}: {lo}..{hi}");
    }
}
