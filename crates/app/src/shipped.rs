//! The volume that ships with the program.

use crate::failure::Failure;
use anyhow::Context as _;
use wheatstone_io::{Format, Loaded, read_bytes};

/// The MNI152 T1 template; `assets/README.md` has its licence.
const BRAIN: &[u8] = include_bytes!("../../../assets/mni152_t1_1mm.nii.gz");

/// Where it lies in the repository, for commands that are shown.
pub(crate) const BRAIN_PATH: &str = "assets/mni152_t1_1mm.nii.gz";

/// Reads it.
pub(crate) fn brain() -> Result<Loaded, Failure> {
    Ok(read_bytes(Format::Nifti, BRAIN, None).context("the shipped volume")?)
}
