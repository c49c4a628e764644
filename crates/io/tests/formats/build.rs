//! Builds files in memory.

use flate2::{
    Compression,
    write::{GzEncoder, ZlibEncoder},
};
use std::io::Write;
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Format, Loaded, ReadError, read_bytes};

/// Values as bytes of a type.
pub(crate) fn encode(values: &[f64], voxel_type: VoxelType, big_endian: bool) -> Vec<u8> {
    let little_endian = |&value: &f64| match voxel_type {
        VoxelType::U8 => (value as u8).to_le_bytes().to_vec(),
        VoxelType::I8 => (value as i8).to_le_bytes().to_vec(),
        VoxelType::U16 => (value as u16).to_le_bytes().to_vec(),
        VoxelType::I16 => (value as i16).to_le_bytes().to_vec(),
        VoxelType::U32 => (value as u32).to_le_bytes().to_vec(),
        VoxelType::I32 => (value as i32).to_le_bytes().to_vec(),
        VoxelType::F32 => (value as f32).to_le_bytes().to_vec(),
        VoxelType::F64 => value.to_le_bytes().to_vec(),
    };
    let mut bytes: Vec<u8> = values.iter().flat_map(little_endian).collect();
    if big_endian {
        for voxel in bytes.chunks_mut(voxel_type.byte_size()) {
            voxel.reverse();
        }
    }
    bytes
}

/// Values that a type holds, its extremes among them.
pub(crate) fn sample_values(voxel_type: VoxelType, count: usize) -> Vec<f64> {
    let (lo, hi) = match voxel_type {
        VoxelType::U8 => (0.0, 255.0),
        VoxelType::I8 => (-128.0, 127.0),
        VoxelType::U16 => (0.0, 65535.0),
        VoxelType::I16 => (-32768.0, 32767.0),
        VoxelType::U32 => (0.0, f64::from(u32::MAX)),
        VoxelType::I32 => (f64::from(i32::MIN), f64::from(i32::MAX)),
        VoxelType::F32 | VoxelType::F64 => (-1.5, 1024.25),
    };
    (0..count)
        .map(|i| {
            if i == 0 {
                lo
            } else if i == 1 {
                hi
            } else {
                i as f64
            }
        })
        .collect()
}

pub(crate) fn values_of(loaded: &Loaded) -> Vec<f64> {
    let voxels = loaded.volume.voxels();
    (0..voxels.len()).map(|i| voxels.value(i)).collect()
}

pub(crate) fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub(crate) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

pub(crate) fn load(format: Format, bytes: &[u8]) -> Loaded {
    read_bytes(format, bytes, None).unwrap_or_else(|error| panic!("{format}: {error}"))
}

/// The error of bytes that must be refused; its message ends with what was expected.
pub(crate) fn refusal(format: Format, bytes: &[u8]) -> ReadError {
    let error = read_bytes(format, bytes, None).expect_err("must be refused");
    assert!(error.to_string().contains("expected"), "{error}");
    error
}

/// A text header with the voxels after it.
pub(crate) fn with_data(header: &str, data: &[u8]) -> Vec<u8> {
    [header.as_bytes(), data].concat()
}

/// Fields of a NIfTI header; the defaults make a plain 1 mm grid of u8.
#[derive(Clone)]
pub(crate) struct Nifti {
    pub(crate) is_2: bool,
    pub(crate) big_endian: bool,
    pub(crate) detached: bool,
    pub(crate) rank: i64,
    pub(crate) sizes: [i64; 7],
    pub(crate) datatype: i16,
    pub(crate) pixdim: [f64; 8],
    pub(crate) slope: f64,
    pub(crate) intercept: f64,
    pub(crate) q_form_code: i16,
    pub(crate) s_form_code: i16,
    pub(crate) quaternion: [f64; 3],
    pub(crate) q_offset: [f64; 3],
    pub(crate) s_form_rows: [[f64; 4]; 3],
    pub(crate) units: u8,
    pub(crate) data_offset_bytes: Option<f64>,
}

impl Nifti {
    pub(crate) fn new(dims: [i64; 3]) -> Self {
        Self {
            is_2: false,
            big_endian: false,
            detached: false,
            rank: 3,
            sizes: [dims[0], dims[1], dims[2], 1, 1, 1, 1],
            datatype: 2,
            pixdim: [1.0; 8],
            slope: 0.0,
            intercept: 0.0,
            q_form_code: 0,
            s_form_code: 1,
            quaternion: [0.0; 3],
            q_offset: [0.0; 3],
            s_form_rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]],
            units: 2,
            data_offset_bytes: None,
        }
    }

    pub(crate) fn of_type(mut self, voxel_type: VoxelType) -> Self {
        self.datatype = match voxel_type {
            VoxelType::U8 => 2,
            VoxelType::I16 => 4,
            VoxelType::I32 => 8,
            VoxelType::F32 => 16,
            VoxelType::F64 => 64,
            VoxelType::I8 => 256,
            VoxelType::U16 => 512,
            VoxelType::U32 => 768,
        };
        self
    }

    pub(crate) fn header(&self) -> Vec<u8> {
        if self.is_2 { self.header_2() } else { self.header_1() }
    }

    /// Header, empty extension block and voxels.
    pub(crate) fn file(&self, data: &[u8]) -> Vec<u8> {
        [self.header().as_slice(), &[0; 4], data].concat()
    }

    fn header_1(&self) -> Vec<u8> {
        let mut h = Writer { bytes: vec![0; 348], big_endian: self.big_endian };
        h.put(0, 348_i32.to_le_bytes());
        h.put(40, (self.rank as i16).to_le_bytes());
        for (i, &size) in self.sizes.iter().enumerate() {
            h.put(42 + 2 * i, (size as i16).to_le_bytes());
        }
        h.put(70, self.datatype.to_le_bytes());
        h.floats(76, &self.pixdim);
        h.floats(108, &[self.data_offset_bytes.unwrap_or(if self.detached { 0.0 } else { 352.0 })]);
        h.floats(112, &[self.slope, self.intercept]);
        h.bytes[123] = self.units;
        h.put(252, self.q_form_code.to_le_bytes());
        h.put(254, self.s_form_code.to_le_bytes());
        h.floats(256, &self.quaternion);
        h.floats(268, &self.q_offset);
        h.floats(280, &self.s_form_rows.concat());
        h.bytes[344..348].copy_from_slice(if self.detached { b"ni1\0" } else { b"n+1\0" });
        h.bytes
    }

    fn header_2(&self) -> Vec<u8> {
        let mut h = Writer { bytes: vec![0; 540], big_endian: self.big_endian };
        h.put(0, 540_i32.to_le_bytes());
        h.bytes[4..12].copy_from_slice(if self.detached { b"ni2\0\r\n\x1a\n" } else { b"n+2\0\r\n\x1a\n" });
        h.put(12, self.datatype.to_le_bytes());
        h.put(16, self.rank.to_le_bytes());
        for (i, &size) in self.sizes.iter().enumerate() {
            h.put(24 + 8 * i, size.to_le_bytes());
        }
        h.doubles(104, &self.pixdim);
        let offset = self.data_offset_bytes.unwrap_or(if self.detached { 0.0 } else { 544.0 });
        h.put(168, (offset as i64).to_le_bytes());
        h.doubles(176, &[self.slope, self.intercept]);
        h.put(344, i32::from(self.q_form_code).to_le_bytes());
        h.put(348, i32::from(self.s_form_code).to_le_bytes());
        h.doubles(352, &self.quaternion);
        h.doubles(376, &self.q_offset);
        h.doubles(400, &self.s_form_rows.concat());
        h.put(500, i32::from(self.units).to_le_bytes());
        h.bytes
    }
}

struct Writer {
    bytes: Vec<u8>,
    big_endian: bool,
}

impl Writer {
    fn put<const N: usize>(&mut self, at: usize, mut little_endian: [u8; N]) {
        if self.big_endian {
            little_endian.reverse();
        }
        self.bytes[at..at + N].copy_from_slice(&little_endian);
    }

    fn floats(&mut self, at: usize, values: &[f64]) {
        for (i, &value) in values.iter().enumerate() {
            self.put(at + 4 * i, (value as f32).to_le_bytes());
        }
    }

    fn doubles(&mut self, at: usize, values: &[f64]) {
        for (i, value) in values.iter().enumerate() {
            self.put(at + 8 * i, value.to_le_bytes());
        }
    }
}
