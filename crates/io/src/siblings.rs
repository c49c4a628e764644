//! The other file, where a header and its voxels are apart.

use crate::{
    Cancel, ReadError,
    stream::{Compression, Stream},
};
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Where to look for the voxels that a header places outside itself.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Siblings<'a> {
    /// Beside the header file with this path, to be read until that is given up.
    File(&'a Path, &'a Cancel),
    /// In memory, if they were given along.
    Bytes(Option<&'a [u8]>),
}

impl<'a> Siblings<'a> {
    /// Reads voxels with `read` from the data file that a header field names; errors carry the data file's path.
    pub(crate) fn read_named<T>(
        self,
        field: &'static str,
        name: &str,
        read: impl FnOnce(Stream<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        match self {
            Self::Bytes(bytes) => read(Stream::of_bytes(bytes.ok_or(ReadError::Detached)?)?),
            Self::File(header_path, cancel) => {
                let data_path = header_path.with_file_name("").join(name);
                read_data_file(field, (header_path, &data_path), cancel, read)
            }
        }
    }

    /// Reads voxels from the `.img` file that belongs to a NIfTI `.hdr` file.
    pub(crate) fn read_nifti_image<T>(
        self,
        read: impl FnOnce(Stream<'_>) -> Result<T, ReadError>,
    ) -> Result<T, ReadError> {
        match self {
            Self::Bytes(bytes) => read(Stream::of_bytes(bytes.ok_or(ReadError::Detached)?)?),
            Self::File(header_path, cancel) => {
                let candidates = with_extensions(header_path, &["img", "img.gz", "IMG"]);
                let image_path = candidates.iter().find(|path| path.exists()).unwrap_or(&candidates[0]);
                let is_gz = image_path.extension().is_some_and(|extension| extension == "gz");
                read_data_file("magic", (header_path, image_path), cancel, |stream| {
                    read(if is_gz { stream.decompress(Compression::Gzip) } else { stream })
                })
            }
        }
    }

    /// The `.hdr` file that belongs to a NIfTI `.img` file.
    pub(crate) fn nifti_header(self) -> Option<PathBuf> {
        let Self::File(image_path, _) = self else { return None };
        with_extensions(image_path, &["hdr", "hdr.gz", "HDR"]).into_iter().find(|path| path.is_file())
    }
}

fn with_extensions(path: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let is_gz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    let path = if is_gz { path.with_extension("") } else { path.to_owned() };
    extensions.iter().map(|extension| path.with_extension(extension)).collect()
}

fn read_data_file<T>(
    field: &'static str,
    (header_path, data_path): (&Path, &Path),
    cancel: &Cancel,
    read: impl FnOnce(Stream<'_>) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    let unusable = |fault| ReadError::DataFile { field, data_path: data_path.to_owned(), fault };
    let resolved = (fs::canonicalize(header_path), fs::canonicalize(data_path));
    if let (Ok(header), Ok(data)) = resolved
        && header == data
    {
        return Err(unusable("is the header itself"));
    }
    let stream = Stream::open(data_path, cancel).map_err(|error| match error {
        ReadError::NotFound => unusable("does not exist"),
        ReadError::NotAFile { .. } => unusable("is not a regular file"),
        ReadError::Empty => unusable("is empty"),
        other => other.in_file(data_path),
    })?;
    read(stream).map_err(|error| error.in_file(data_path))
}
