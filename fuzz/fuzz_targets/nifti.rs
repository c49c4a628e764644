//! Any bytes as a NIfTI file, with and without a data file.

#![no_main]

use libfuzzer_sys::fuzz_target;
use wheatstone_io::{Format, read_bytes};

fuzz_target!(|bytes: &[u8]| {
    let _ = read_bytes(Format::Nifti, bytes, None);
    let _ = read_bytes(Format::Nifti, bytes, Some(&bytes[bytes.len() / 2..]));
});
