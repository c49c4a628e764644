//! Small text files that users write or keep.

use crate::failure::Failure;
use std::path::Path;

/// What `parse` makes of the text of a file of at most so many bytes; `kind` says what is expected, with its article.
pub(crate) fn read_text_file<T, E: std::fmt::Display>(
    path: &Path,
    most_bytes: u64,
    kind: &str,
    parse: impl FnOnce(&str) -> Result<T, E>,
) -> Result<T, Failure> {
    let bad = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", path.display()));
    let metadata = std::fs::metadata(path).map_err(|error| bad(&error))?;
    if !metadata.is_file() || metadata.len() > most_bytes {
        return Err(bad(&format_args!("not {kind}")));
    }
    let text = std::fs::read_to_string(path).map_err(|error| bad(&error))?;
    parse(&text).map_err(|error| bad(&error))
}
