//! Files that appear whole or not at all.

use crate::WriteError;
use std::{
    io::{self, BufWriter, Write},
    path::Path,
};
use tempfile::Builder;

/// Writes a file by way of a temporary one in the same folder, which takes the path's place when it is complete.
///
/// # Errors
/// [`WriteError`]; the temporary file is gone then, and a file that was at the path before is as it was.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = Builder::new();
    builder.prefix(".wheatstone-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let temporary = builder
        .tempfile_in(folder)
        .map_err(|error| WriteError::Folder { folder: folder.to_owned(), error })?;

    let write_all = || {
        let mut writer = BufWriter::new(temporary.as_file());
        write(&mut writer)?;
        writer.flush()?;
        temporary.as_file().sync_all()
    };
    write_all().map_err(|error| WriteError::Write { path: path.to_owned(), error })?;
    temporary
        .persist(path)
        .map_err(|failure| WriteError::Replace { path: path.to_owned(), error: failure.error })?;
    Ok(())
}
