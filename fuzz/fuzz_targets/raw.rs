//! Any name, any layout and any bytes as a raw file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{RawLayout, read_raw_bytes};

fuzz_target!(|input: (&str, [u64; 3], u8, [f64; 3], bool, u64, &[u8])| {
    let (name, dims, type_index, spacing_mm, big_endian, header_bytes, bytes) = input;
    if let Some(layout) = RawLayout::from_file_name(name) {
        let _ = read_raw_bytes(bytes, &layout);
    }
    let voxel_type = VoxelType::ALL[usize::from(type_index) % VoxelType::ALL.len()];
    for dims in [dims, dims.map(|size| size % 8)] {
        let layout = RawLayout { dims, voxel_type, spacing_mm, big_endian, header_bytes: header_bytes % 16 };
        let _ = read_raw_bytes(bytes, &layout);
        let _ = read_raw_bytes(bytes, &RawLayout { header_bytes, ..layout });
    }
});
