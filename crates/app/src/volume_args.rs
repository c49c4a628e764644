//! The volume file that a command reads.

use crate::failure::Failure;
use crate::progress::Bar;
use crate::spec;
use clap::Args;
use std::path::{Path, PathBuf};
use wheatstone_core::volume::VoxelType;
use wheatstone_io::{Loaded, RawLayout, read_raw, read_volume};

/// Which file, and what a raw file does not say itself.
#[derive(Debug, Clone, Args)]
pub(crate) struct VolumeArgs {
    /// Volume file: .nii, .nii.gz, .hdr/.img, .nrrd, .nhdr, .mha, .mhd, or raw with size and type in its name or given by
    /// flags.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,

    #[command(flatten)]
    pub(crate) raw: RawArgs,
}

/// The layout of a raw file.
#[derive(Debug, Clone, Args)]
#[command(next_help_heading = "Raw files")]
pub(crate) struct RawArgs {
    /// Read FILE as raw voxels: how many along each axis, the fastest first.
    #[arg(long, value_name = "XxYxZ", value_parser = spec::voxel_dims, requires = "raw_type")]
    raw_size: Option<[u64; 3]>,

    /// Type of a raw voxel: uint8, int8, uint16, int16, uint32, int32, float32, float64.
    #[arg(long, value_name = "TYPE", value_parser = spec::voxel_type, requires = "raw_size")]
    raw_type: Option<VoxelType>,

    /// Distance of raw voxels along each axis, mm [default: 1,1,1].
    #[arg(long, value_name = "SX,SY,SZ", value_parser = spec::spacing, requires = "raw_size")]
    raw_spacing: Option<[f64; 3]>,

    /// Bytes before the first raw voxel.
    #[arg(long, value_name = "BYTES", default_value_t = 0, requires = "raw_size")]
    raw_header: u64,

    /// Raw voxels have their most significant byte first.
    #[arg(long, requires = "raw_size")]
    raw_big_endian: bool,
}

impl VolumeArgs {
    /// Reads the file; warnings go to standard error.
    pub(crate) fn load(&self) -> Result<Loaded, Failure> {
        let loaded = {
            let _spinner = Bar::spinner(format!("reading {}", self.file.display()));
            match self.raw.layout() {
                Some(layout) => read_raw(&self.file, &layout)?,
                None => read_volume(&self.file)?,
            }
        };
        print_warnings(&self.file, &loaded);
        Ok(loaded)
    }
}

/// Tells what the reader assumed or left out.
pub(crate) fn print_warnings(file: &Path, loaded: &Loaded) {
    for warning in &loaded.warnings {
        eprintln!("warning: {}: {warning}", file.display());
    }
}

impl RawArgs {
    /// The layout, if it is given.
    pub(crate) fn layout(&self) -> Option<RawLayout> {
        let (dims, voxel_type) = (self.raw_size?, self.raw_type?);
        Some(RawLayout {
            spacing_mm: self.raw_spacing.unwrap_or([1.0; 3]),
            big_endian: self.raw_big_endian,
            header_bytes: self.raw_header,
            ..RawLayout::new(dims, voxel_type)
        })
    }
}
