//! Writes volumes as NRRD.

use crate::{WriteError, write_atomically};
use flate2::{Compression, write::GzEncoder};
use glam::DVec3;
use std::{
    io::{self, Write},
    path::Path,
};
use wheatstone_core::volume::{Volume, VoxelType};

/// Writes a volume as NRRD with gzip encoding. Type, dimensions and matrix come back exactly when it is read.
///
/// # Errors
/// [`WriteError`]; a file that was at the path before is as it was.
pub fn write_nrrd(path: &Path, volume: &Volume) -> Result<(), WriteError> {
    write_atomically(path, |writer| encode_nrrd(writer, volume))
}

/// Writes a volume as NRRD to a stream.
///
/// # Errors
/// Those of the writer.
pub fn encode_nrrd(writer: &mut dyn Write, volume: &Volume) -> io::Result<()> {
    writer.write_all(header(volume).as_bytes())?;
    let mut encoder = GzEncoder::new(writer, Compression::fast());
    encoder.write_all(volume.voxels().as_bytes())?;
    encoder.finish()?;
    Ok(())
}

fn header(volume: &Volume) -> String {
    let type_name = match volume.voxels().voxel_type() {
        VoxelType::F32 => "float",
        VoxelType::F64 => "double",
        integer => integer.name(),
    };
    let endian = if cfg!(target_endian = "big") { "big" } else { "little" };
    let [width, height, depth] = volume.grid().dims();
    let matrix = volume.grid().patient_from_index();
    let vector = |v: DVec3| format!("({:?},{:?},{:?})", v.x, v.y, v.z);
    format!(
        "NRRD0004\n\
         type: {type_name}\n\
         dimension: 3\n\
         space: right-anterior-superior\n\
         sizes: {width} {height} {depth}\n\
         space directions: {} {} {}\n\
         kinds: domain domain domain\n\
         endian: {endian}\n\
         encoding: gzip\n\
         space units: \"mm\" \"mm\" \"mm\"\n\
         space origin: {}\n\n",
        vector(matrix.matrix3.x_axis),
        vector(matrix.matrix3.y_axis),
        vector(matrix.matrix3.z_axis),
        vector(matrix.translation),
    )
}
