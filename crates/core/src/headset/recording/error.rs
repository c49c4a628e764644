//! Why there is no recording.

use super::check::TickError;
use super::{LONGEST_LINE, line};
use std::io;
use thiserror::Error;

/// What cannot be recorded, written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The reader failed.
    #[error("line {line} cannot be read: {error}")]
    Read {
        /// Counted from 1.
        line: usize,
        /// Why.
        error: io::Error,
    },
    /// The writer failed.
    #[error("a recording cannot be written: {0}")]
    Write(#[from] io::Error),
    /// A line that is none of a recording.
    #[error("line {line}: {fault}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        fault: LineError,
    },
    /// A tick that is none.
    #[error("tick {index}: {fault}")]
    Tick {
        /// Counted from 0.
        index: usize,
        /// What is wrong with it.
        fault: TickError,
    },
    /// A recording without ticks.
    #[error("a recording needs at least one tick")]
    Empty,
}

/// What is wrong with a line.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum LineError {
    /// Of too many bytes.
    #[error("longer than {LONGEST_LINE} bytes")]
    TooLong,
    /// Not JSON, or a field missing, unknown or of another shape.
    #[error("{reason} (column {column})")]
    Syntax {
        /// What was expected.
        reason: String,
        /// Counted from 1.
        column: usize,
    },
    /// Of a later program.
    #[error("version {found} of the form of recordings; this program reads version {}", line::VERSION)]
    Version {
        /// Version in the line.
        found: u64,
    },
    /// Numbers in other units.
    #[error("units are {found:?}: must be {:?}", line::UNITS)]
    Units {
        /// Units in the line.
        found: String,
    },
    /// Eyes that no frusta are known of.
    #[error("eyes without frusta, neither here nor in the header")]
    NoFrusta,
    /// A tick that is none.
    #[error(transparent)]
    Tick(#[from] TickError),
}

impl From<serde_json::Error> for LineError {
    fn from(error: serde_json::Error) -> Self {
        let text = error.to_string();
        // The line is counted within the text that was parsed, which is one.
        let reason = text.split(" at line ").next().unwrap_or(&text).to_owned();
        Self::Syntax { reason, column: error.column() }
    }
}
