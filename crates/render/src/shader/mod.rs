//! WGSL from small files: textual imports in WESL syntax, each file included once.
//!
//! The first lines of a file import others: `import package::lib::ray::{Ray, ray_at};`. Only the path counts; all
//! names share one space. A variant is chosen by naming the file that stands for a slot such as `lib/shade`.

#[cfg(test)]
mod layout;
mod library;

#[cfg(test)]
pub(crate) use layout::{assert_layout, struct_layout};
pub use library::FILES;

use std::fmt::Write as _;
use thiserror::Error;

/// A module put together from files.
#[derive(Debug, Clone)]
pub struct Source {
    /// WGSL text.
    pub text: String,
    /// First line of each file in the text, counted from 1, with the file's path.
    origins: Vec<(usize, String)>,
}

/// Why files do not make a module.
#[derive(Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum ComposeError {
    /// A file that is imported does not exist.
    #[error("{importer}: imports `{path}`, which is neither a file nor a chosen slot")]
    Missing {
        /// Path that was imported.
        path: String,
        /// File that imports it.
        importer: String,
    },
    /// Files import each other in a circle.
    #[error("import cycle: {0}")]
    Cycle(String),
    /// An import line that is not understood.
    #[error("{file}: cannot read import `{line}`")]
    Syntax {
        /// File with the line.
        file: String,
        /// The line.
        line: String,
    },
}

/// Puts a module together from its root file; `choices` name the file of each slot.
///
/// # Errors
/// Missing files, cycles, imports that are not understood.
pub fn compose(root: &str, choices: &[(&str, &str)]) -> Result<Source, ComposeError> {
    let mut composer = Composer { choices, done: Vec::new(), open: Vec::new(), source: Source::empty() };
    composer.include(root, root)?;
    Ok(composer.source)
}

struct Composer<'a> {
    choices: &'a [(&'a str, &'a str)],
    done: Vec<String>,
    open: Vec<String>,
    source: Source,
}

impl Composer<'_> {
    fn include(&mut self, path: &str, importer: &str) -> Result<(), ComposeError> {
        let path = self.choices.iter().find(|(slot, _)| *slot == path).map_or(path, |(_, file)| file);
        if self.done.iter().any(|done| done == path) {
            return Ok(());
        }
        if self.open.iter().any(|open| open == path) {
            return Err(ComposeError::Cycle(format!("{} → {path}", self.open.join(" → "))));
        }
        let missing = || ComposeError::Missing { path: path.to_owned(), importer: importer.to_owned() };
        let (_, text) = FILES.iter().find(|(name, _)| *name == path).ok_or_else(missing)?;
        self.open.push(path.to_owned());
        let is_import = |line: &&str| line.starts_with("import ");
        for line in text.lines().filter(is_import) {
            let imported = import_path(line)
                .ok_or_else(|| ComposeError::Syntax { file: path.to_owned(), line: line.to_owned() })?;
            self.include(&imported, path)?;
        }
        self.open.pop();
        self.done.push(path.to_owned());
        let first_line = self.source.text.lines().count() + 1;
        self.source.origins.push((first_line, path.to_owned()));
        for line in text.lines() {
            // An import stays as an empty line, so that line numbers hold.
            self.source.text.push_str(if is_import(&line) { "" } else { line });
            self.source.text.push('\n');
        }
        Ok(())
    }
}

/// `import package::lib::ray::{…};` → `lib/ray`.
fn import_path(line: &str) -> Option<String> {
    let (path, names) = line.strip_prefix("import package::")?.rsplit_once("::")?;
    let ok = names.starts_with('{') && names.ends_with("};");
    ok.then(|| path.replace("::", "/"))
}

impl Source {
    fn empty() -> Self {
        Self { text: String::new(), origins: Vec::new() }
    }

    /// File and line, from 1, of a line of the composed text.
    pub fn origin(&self, line: usize) -> (&str, usize) {
        self.origins
            .iter()
            .rev()
            .find(|(first, _)| *first <= line)
            .map_or(("", line), |(first, path)| (path.as_str(), line - first + 1))
    }

    /// The files that went into the module, in order.
    pub fn files(&self) -> String {
        self.origins.iter().fold(String::new(), |mut list, (_, path)| {
            let _ = write!(list, "{}{path}", if list.is_empty() { "" } else { ", " });
            list
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_map_back_to_their_file() {
        let source = compose("lib/ray", &[]).unwrap();
        for (index, line) in source.text.lines().enumerate() {
            let (file, line_in_file) = source.origin(index + 1);
            let (_, text) = FILES.iter().find(|(name, _)| *name == file).unwrap();
            let original = text.lines().nth(line_in_file - 1).unwrap();
            assert!(line == original || (line.is_empty() && original.starts_with("import ")));
        }
    }

    #[test]
    fn a_slot_without_a_choice_is_missing() {
        let error = compose("lib/gradient_central", &[]).unwrap_err();
        assert!(matches!(error, ComposeError::Missing { path, .. } if path == "lib/volume"));
    }

    #[test]
    fn a_cycle_is_named() {
        let error = compose("lib/ray", &[("lib/view", "lib/ray")]).unwrap_err();
        assert_eq!(error, ComposeError::Cycle("lib/ray → lib/ray".into()));
    }

    #[test]
    fn malformed_imports_have_no_path() {
        assert_eq!(import_path("import package::lib::ray::{Ray};").as_deref(), Some("lib/ray"));
        assert_eq!(import_path("import lib::ray;"), None);
        assert_eq!(import_path("import package::lib::ray;"), None);
    }
}
