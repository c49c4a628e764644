//! Reads transfer functions: Wheatstone's JSON form, ParaView's colour maps, Slicer's volume properties.
//!
//! The format is recognised by content. Files are not trusted: size and point counts are bounded, and every malformed
//! file ends in a [`TransferReadError`].

mod normalise;
mod paraview;
mod slicer;

use std::fs;
use std::io::{self, Read};
use std::path::Path;
use thiserror::Error;
use wheatstone_core::transfer::{TransferError, TransferFile, TransferJsonError};

/// Largest file that is read, bytes.
pub const MAX_TRANSFER_BYTES: u64 = 16 << 20;
/// Most points that a colour or an opacity may have in a file.
pub const MAX_TRANSFER_POINTS: usize = 1 << 16;

/// Why a file does not give a transfer function.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TransferReadError {
    /// There is no such file.
    #[error("no such file")]
    NotFound,
    /// A directory, a device or a pipe.
    #[error("not a file")]
    NotAFile,
    /// The file is larger than [`MAX_TRANSFER_BYTES`].
    #[error("larger than {MAX_TRANSFER_BYTES} bytes, the limit for a transfer function")]
    TooLarge,
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[source] io::Error),
    /// The bytes are not UTF-8.
    #[error("not a transfer function: the file is not text")]
    NotText,
    /// Neither JSON nor the lines that a Slicer volume property starts with.
    #[error(
        "not a transfer function: neither Wheatstone's JSON form, nor a ParaView colour map (JSON), nor a Slicer volume property (.vp)"
    )]
    Unrecognised,
    /// Malformed JSON, or a malformed transfer function in Wheatstone's form.
    #[error(transparent)]
    Json(#[from] TransferJsonError),
    /// A list in Wheatstone's form that is longer than [`MAX_TRANSFER_POINTS`].
    #[error("{part} holds {count} points: at most {MAX_TRANSFER_POINTS} are read")]
    TooManyPoints {
        /// The list's field.
        part: &'static str,
        /// Points in it.
        count: usize,
    },
    /// A ParaView colour map with a field that is missing or malformed.
    #[error("ParaView colour map: {problem}")]
    ParaView {
        /// What is wrong.
        problem: String,
    },
    /// A Slicer volume property with a line that is missing or malformed.
    #[error("Slicer volume property, line {line}: {problem}")]
    Slicer {
        /// Line number from 1.
        line: usize,
        /// What is wrong.
        problem: String,
    },
    /// Points out of bounds.
    #[error(transparent)]
    Points(#[from] TransferError),
}

/// Reads a transfer-function file.
///
/// # Errors
/// [`TransferReadError`] for a file that is missing, too large, not a regular file, or not a transfer function in a
/// known form.
pub fn read_transfer(path: &Path) -> Result<TransferFile, TransferReadError> {
    let by_kind = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => TransferReadError::NotFound,
        _ => TransferReadError::Io(error),
    };
    // Opening a pipe may block, so what the path names is looked at first.
    if !fs::metadata(path).map_err(by_kind)?.is_file() {
        return Err(TransferReadError::NotAFile);
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(by_kind)?;
    file.take(MAX_TRANSFER_BYTES + 1).read_to_end(&mut bytes).map_err(TransferReadError::Io)?;
    if bytes.len() as u64 > MAX_TRANSFER_BYTES {
        return Err(TransferReadError::TooLarge);
    }
    let text = String::from_utf8(bytes).map_err(|_| TransferReadError::NotText)?;
    parse_transfer(&text)
}

/// Reads a transfer function from the text of a file.
///
/// # Errors
/// As [`read_transfer`], but for the file itself.
pub fn parse_transfer(text: &str) -> Result<TransferFile, TransferReadError> {
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.starts_with(['{', '[']) {
        let value: serde_json::Value = serde_json::from_str(text).map_err(TransferJsonError::from)?;
        return if value.get("wheatstone_transfer_function").is_some() {
            check_point_counts(&value)?;
            Ok(TransferFile::from_json(text)?)
        } else if let Some(map) = paraview::find_map(&value) {
            paraview::parse(map)
        } else {
            Err(TransferReadError::Unrecognised)
        };
    }
    if slicer::is_volume_property(text) { slicer::parse(text) } else { Err(TransferReadError::Unrecognised) }
}

/// Bounds the lists of Wheatstone's own form.
fn check_point_counts(form: &serde_json::Value) -> Result<(), TransferReadError> {
    for part in ["color", "opacity", "gradient_opacity"] {
        let count = form.get(part).and_then(serde_json::Value::as_array).map_or(0, Vec::len);
        if count > MAX_TRANSFER_POINTS {
            return Err(TransferReadError::TooManyPoints { part, count });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
