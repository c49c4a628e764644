//! Finds out what a file is, and hands it to the reader of its format.

use crate::{
    Cancel, Format, Loaded, RawLayout, ReadError, Warning, metaimage, nifti, nrrd, raw,
    siblings::Siblings,
    stream::{Compression, Stream},
};
use std::path::Path;

/// Bytes at the start of a file that tell its format.
const MAGIC_BYTES: usize = 512;

/// Reads a volume file.
///
/// The format follows from the first bytes. Only raw files, which have none of their own, are known by their name
/// (`NAME_WIDTHxHEIGHTxDEPTH_TYPE.raw`, as in `bonsai_256x256x256_uint8.raw`).
///
/// # Errors
/// Any [`ReadError`], always as [`ReadError::InFile`].
pub fn read_volume(path: &Path) -> Result<Loaded, ReadError> {
    read_volume_unless(path, &Cancel::default())
}

/// The same, unless it is given up.
///
/// # Errors
/// Any [`ReadError`], always as [`ReadError::InFile`].
pub fn read_volume_unless(path: &Path, cancel: &Cancel) -> Result<Loaded, ReadError> {
    read_by_content(path, cancel).map_err(|error| error.in_file(path))
}

/// Reads a raw file with a known layout.
///
/// # Errors
/// Any [`ReadError`], always as [`ReadError::InFile`].
pub fn read_raw(path: &Path, layout: &RawLayout) -> Result<Loaded, ReadError> {
    read_raw_unless(path, layout, &Cancel::default())
}

/// The same, unless it is given up.
///
/// # Errors
/// Any [`ReadError`], always as [`ReadError::InFile`].
pub fn read_raw_unless(path: &Path, layout: &RawLayout, cancel: &Cancel) -> Result<Loaded, ReadError> {
    read_raw_file(path, layout, cancel).map_err(|error| error.in_file(path))
}

/// Reads a volume from memory. `detached` holds the voxels where the header says that they are in another file.
///
/// # Errors
/// Any [`ReadError`] but [`ReadError::InFile`]; [`ReadError::RawName`] for [`Format::Raw`], which needs
/// [`read_raw_bytes`].
pub fn read_bytes(format: Format, bytes: &[u8], detached: Option<&[u8]>) -> Result<Loaded, ReadError> {
    let stream = Stream::of_bytes(bytes)?.gunzip_by_magic()?;
    read_format(format, stream, Siblings::Bytes(detached))
}

/// Reads raw voxels from memory.
///
/// # Errors
/// Any [`ReadError`] but [`ReadError::InFile`].
pub fn read_raw_bytes(bytes: &[u8], layout: &RawLayout) -> Result<Loaded, ReadError> {
    raw::read(Stream::of_bytes(bytes)?, layout)
}

fn read_raw_file(path: &Path, layout: &RawLayout, cancel: &Cancel) -> Result<Loaded, ReadError> {
    let stream = Stream::open(path, cancel)?;
    let is_gz = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gz"));
    raw::read(if is_gz { stream.decompress(Compression::Gzip) } else { stream }, layout)
}

fn read_by_content(path: &Path, cancel: &Cancel) -> Result<Loaded, ReadError> {
    let extension = Extension::of(path);
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if extension == Extension::Raw
        && let Some(layout) = RawLayout::from_file_name(&name)
    {
        return read_raw_file(path, &layout, cancel);
    }
    let mut stream = Stream::open(path, cancel)?.gunzip_by_magic()?;
    if extension == Extension::NiftiImage
        && let Some(header_path) = Siblings::File(path, cancel).nifti_header()
    {
        let stream = Stream::open(&header_path, cancel).and_then(Stream::gunzip_by_magic);
        return stream
            .and_then(|stream| nifti::read(stream, Siblings::File(&header_path, cancel)))
            .map_err(|error| error.in_file(&header_path));
    }
    let start = stream.peek(MAGIC_BYTES)?;
    let by_magic = format_by_magic(&start);
    let by_extension = extension.format();
    let format = by_magic.or(by_extension).ok_or(match extension {
        Extension::Raw => ReadError::RawName,
        _ => ReadError::UnknownFormat,
    })?;
    let mut loaded = read_format(format, stream, Siblings::File(path, cancel))?;
    if by_extension != Some(format) {
        loaded.warnings.insert(0, Warning::ExtensionMismatch { format });
    }
    Ok(loaded)
}

fn read_format(format: Format, stream: Stream<'_>, siblings: Siblings<'_>) -> Result<Loaded, ReadError> {
    match format {
        Format::Nifti => nifti::read(stream, siblings),
        Format::Nrrd => nrrd::read(stream, siblings),
        Format::MetaImage => metaimage::read(stream, siblings),
        Format::Raw => Err(ReadError::RawName),
    }
}

fn format_by_magic(start: &[u8]) -> Option<Format> {
    if nrrd::is_magic(start) {
        Some(Format::Nrrd)
    } else if nifti::is_magic(start) {
        Some(Format::Nifti)
    } else if metaimage::is_magic(start) {
        Some(Format::MetaImage)
    } else {
        None
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Extension {
    Nifti,
    NiftiImage,
    Nrrd,
    MetaImage,
    Raw,
    Other,
}

impl Extension {
    fn of(path: &Path) -> Self {
        let name =
            path.file_name().map(|name| name.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        match name.rsplit_once('.').map(|(_, extension)| extension) {
            Some("nii" | "hdr") => Self::Nifti,
            Some("img") => Self::NiftiImage,
            Some("nrrd" | "nhdr") => Self::Nrrd,
            Some("mha" | "mhd") => Self::MetaImage,
            Some("raw" | "bin" | "dat") => Self::Raw,
            _ => Self::Other,
        }
    }

    fn format(self) -> Option<Format> {
        match self {
            Self::Nifti | Self::NiftiImage => Some(Format::Nifti),
            Self::Nrrd => Some(Format::Nrrd),
            Self::MetaImage => Some(Format::MetaImage),
            Self::Raw | Self::Other => None,
        }
    }
}
