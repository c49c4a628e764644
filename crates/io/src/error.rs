//! Why a file could not be read or written.

use crate::cancel::is_cancelled;
use std::{
    io,
    path::{Path, PathBuf},
};
use thiserror::Error;

/// Why a volume could not be read.
///
/// Each message states the fault first and ends with what was expected. Errors of whole files come as
/// [`ReadError::InFile`]; [`ReadError::problem`] looks through it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// A problem in a file with a known path: the header, or the data file that it names.
    #[error("{}: {problem}", path.display())]
    InFile {
        /// The file that the problem is in.
        path: PathBuf,
        /// The problem; never itself [`ReadError::InFile`].
        problem: Box<Self>,
    },
    /// The path leads nowhere.
    #[error("no such file; expected the path of an existing volume file")]
    NotFound,
    /// The path is a directory or a device.
    #[error("this is a {found}; expected a regular file")]
    NotAFile {
        /// What the path leads to.
        found: &'static str,
    },
    /// The file has no bytes.
    #[error("the file is empty; expected a volume with at least one voxel")]
    Empty,
    /// The operating system refused to open or read.
    #[error("cannot read: {error}; expected a readable file")]
    Io {
        /// The system's answer.
        error: io::Error,
    },
    /// Neither the extension nor the first bytes belong to a known format.
    #[error(
        "unknown format; expected .nii, .nii.gz, .hdr/.img (NIfTI), .nrrd, .nhdr, .mha, .mhd or \
         NAME_WIDTHxHEIGHTxDEPTH_TYPE.raw"
    )]
    UnknownFormat,
    /// The first bytes are not those of the format that the extension promises.
    #[error("the first bytes are {found:?}; expected {expected}")]
    WrongMagic {
        /// The first bytes, escaped.
        found: String,
        /// The signature of the format.
        expected: &'static str,
    },
    /// Fewer bytes than the header promises.
    #[error("the {what} ends early: expected at least {expected_bytes} bytes, found {found_bytes}")]
    Truncated {
        /// The part that ends early.
        what: &'static str,
        /// Bytes needed. Where they were compressed: after decompression.
        expected_bytes: u64,
        /// Bytes present, or an upper bound of them where a compressed file is too short to be worth reading.
        found_bytes: u64,
    },
    /// A text that holds fewer numbers than the header promises.
    #[error("the text of the voxel values ends early: found {found} values, expected {expected}")]
    TruncatedText {
        /// Values needed.
        expected: u64,
        /// Values present.
        found: u64,
    },
    /// A text header without an end.
    #[error("the header goes on beyond {limit_bytes} bytes; expected its end before that")]
    HeaderTooLong {
        /// Most bytes that a header may have.
        limit_bytes: usize,
    },
    /// The header lacks a field.
    #[error("the header lacks the field `{field}`; expected {expected}")]
    MissingField {
        /// Name of the field.
        field: &'static str,
        /// What it should hold.
        expected: &'static str,
    },
    /// A field that cannot be understood.
    #[error("field `{field}` is {value:?}; expected {expected}")]
    BadField {
        /// Name of the field.
        field: &'static str,
        /// What it holds, shortened.
        value: String,
        /// What it should hold.
        expected: &'static str,
    },
    /// A line of a text header that is neither a field nor a comment.
    #[error("header line {line} is {text:?}; expected {expected}")]
    BadLine {
        /// Number of the line, from 1.
        line: usize,
        /// The line, shortened.
        text: String,
        /// The shape of a line.
        expected: &'static str,
    },
    /// A dimension that is zero, negative or out of range.
    #[error("field `{field}` gives axis {axis} the size {value}; expected at least 1")]
    BadDimension {
        /// Name of the field.
        field: &'static str,
        /// The axis, from 1.
        axis: usize,
        /// Its size in the file.
        value: i64,
    },
    /// More voxels than Wheatstone loads, or than can be counted.
    #[error(
        "{}×{}×{} voxels of {bytes_per_voxel} bytes are too many; expected at most {limit_bytes} bytes",
        dims[0], dims[1], dims[2]
    )]
    TooLarge {
        /// Dimensions in the file.
        dims: [u64; 3],
        /// Bytes of one voxel in memory.
        bytes_per_voxel: u64,
        /// [`MAX_VOXEL_BYTES`](crate::MAX_VOXEL_BYTES).
        limit_bytes: u64,
    },
    /// The volume is within limits, but the memory is not there.
    #[error("no memory for {bytes} bytes of voxels; expected that much to be free")]
    OutOfMemory {
        /// Bytes asked for.
        bytes: u64,
    },
    /// A voxel type, encoding or file layout that is not read.
    #[error("{what} is not supported; expected {expected}")]
    Unsupported {
        /// What the file has.
        what: String,
        /// What is supported.
        expected: &'static str,
    },
    /// NaN or infinity in the spacing, origin or direction.
    #[error("field `{field}` holds NaN or infinity; expected finite numbers")]
    NotFinite {
        /// Name of the field.
        field: &'static str,
    },
    /// Directions or spacings that flatten the volume.
    #[error("field `{field}` gives the index-to-patient matrix {matrix}; expected one that can be inverted")]
    NotInvertible {
        /// Name of the field.
        field: &'static str,
        /// The matrix, column by column.
        matrix: String,
    },
    /// A compressed stream that cannot be decoded.
    #[error("the {encoding} stream is damaged ({detail}); expected valid {encoding} data")]
    Corrupt {
        /// `gzip` or `zlib`.
        encoding: &'static str,
        /// The decoder's answer.
        detail: String,
    },
    /// The header names a data file that cannot serve as one.
    #[error("field `{field}` names {}, which {fault}; expected a file of voxel data", data_path.display())]
    DataFile {
        /// Name of the field, or the rule by which the data file was looked for.
        field: &'static str,
        /// The data file.
        data_path: PathBuf,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// The header says that the voxels are in another file, but it was read from memory.
    #[error("the voxels are in another file; expected them after the header, or given along with it")]
    Detached,
    /// A raw file whose name does not tell its layout.
    #[error(
        "the name does not tell the size and type of this raw file; expected NAME_WIDTHxHEIGHTxDEPTH_TYPE.raw, \
         such as bonsai_256x256x256_uint8.raw"
    )]
    RawName,
    /// [`Cancel::cancel`](crate::Cancel::cancel) was called.
    #[error("reading was given up before its end")]
    Cancelled,
    /// Every voxel is NaN or infinite.
    #[error("all {count} voxels are NaN or infinite; expected at least one finite value")]
    NothingFinite {
        /// Voxels in the volume.
        count: usize,
    },
}

impl ReadError {
    /// The problem itself, without the path.
    pub fn problem(&self) -> &Self {
        match self {
            Self::InFile { problem, .. } => problem.problem(),
            other => other,
        }
    }

    /// Names the file that the problem is in, unless it is named already.
    pub(crate) fn in_file(self, path: &Path) -> Self {
        match self {
            Self::InFile { .. } => self,
            problem => Self::InFile { path: path.to_owned(), problem: Box::new(problem) },
        }
    }

    /// A field with a value that may be long.
    pub(crate) fn bad_field(field: &'static str, value: &str, expected: &'static str) -> Self {
        Self::BadField { field, value: shorten(value), expected }
    }

    pub(crate) fn io(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::NotFound => Self::NotFound,
            _ if is_cancelled(&error) => Self::Cancelled,
            _ => Self::Io { error },
        }
    }
}

/// Why a file could not be written. The file that was at the path before, if any, is as it was.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The folder of the path is missing or cannot be written to.
    #[error("{}: cannot create a file here ({}); expected a writable folder", folder.display(), error.kind())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// The system's answer.
        error: io::Error,
    },
    /// Writing the bytes failed.
    #[error("{}: cannot write ({error}); expected enough space", path.display())]
    Write {
        /// The file to be written.
        path: PathBuf,
        /// The system's answer.
        error: io::Error,
    },
    /// The finished file could not take its place.
    #[error("{}: cannot replace ({}); expected a path that a file can have", path.display(), error.kind())]
    Replace {
        /// The file to be written.
        path: PathBuf,
        /// The system's answer.
        error: io::Error,
    },
}

/// At most 60 characters of a text from a file.
pub(crate) fn shorten(text: &str) -> String {
    const MOST: usize = 60;
    let mut short: String = text.chars().take(MOST).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
