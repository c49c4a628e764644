//! Reads and writes volume files.
//!
//! [`read_volume`] reads NIfTI, NRRD, MetaImage and raw files; [`write_nrrd`] writes NRRD. Every reader gives a
//! [`Volume`] whose index-to-patient matrix is RAS+ in millimetres, whatever the file's convention was.
//!
//! Files are not trusted. Declared sizes are compared with the bytes that are present and with
//! [`MAX_VOXEL_BYTES`] before memory is allocated, compressed data is read up to the declared size and no
//! further, and every malformed file ends in a [`ReadError`] that names the field.

mod atomic;
mod cancel;
mod error;
mod geometry;
mod metaimage;
mod nifti;
mod nrrd;
mod open;
mod raw;
mod siblings;
mod stream;
mod text_header;
pub mod transfer;
mod voxel_data;
mod warning;

pub use atomic::write_atomically;
pub use cancel::Cancel;
pub use error::{ReadError, WriteError};
pub use nrrd::{encode_nrrd, write_nrrd};
pub use open::{read_bytes, read_raw, read_raw_bytes, read_raw_unless, read_volume, read_volume_unless};
pub use raw::RawLayout;
pub use voxel_data::MAX_VOXEL_BYTES;
pub use warning::Warning;

use std::fmt;
use wheatstone_core::volume::{Grid, Volume, VolumeError, Voxels};

/// The file formats that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// NIfTI-1 or NIfTI-2: `.nii`, `.nii.gz`, `.hdr` with `.img`.
    Nifti,
    /// NRRD: `.nrrd`, `.nhdr` with a data file.
    Nrrd,
    /// MetaImage: `.mha`, `.mhd` with a data file.
    MetaImage,
    /// Voxels without a header.
    Raw,
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nifti => "NIfTI",
            Self::Nrrd => "NRRD",
            Self::MetaImage => "MetaImage",
            Self::Raw => "raw",
        })
    }
}

/// A volume from a file, and what the user should know about it.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The volume.
    pub volume: Volume,
    /// What the reader assumed or left out.
    pub warnings: Vec<Warning>,
    /// The format that the file turned out to be in.
    pub format: Format,
}

impl Loaded {
    fn new(
        grid: Grid,
        voxels: Voxels,
        mut warnings: Vec<Warning>,
        format: Format,
    ) -> Result<Self, ReadError> {
        let count = grid.voxel_count();
        let volume = Volume::new(grid, voxels).map_err(|error| match error {
            VolumeError::NothingFinite { count } => ReadError::NothingFinite { count },
            _ => ReadError::Truncated { what: "voxel data", expected_bytes: count as u64, found_bytes: 0 },
        })?;
        if volume.non_finite_count() > 0 {
            warnings.push(Warning::NonFiniteVoxels { count: volume.non_finite_count() });
        }
        let (spacing_mm, step_mm) =
            (volume.grid().spacing_mm().min_element(), volume.grid().voxel_length_mm());
        if step_mm > spacing_mm {
            let [x, y, z] = volume.grid().size_mm().to_array();
            let size_mm = format!("{x:.3e} × {y:.3e} × {z:.3e} mm");
            warnings.push(Warning::StepsLengthened { size_mm, step_mm, spacing_mm });
        }
        Ok(Self { volume, warnings, format })
    }
}
