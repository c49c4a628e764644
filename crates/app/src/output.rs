//! Standard output, and files that are checked before the work starts.

use crate::failure::Failure;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// Writes a text and a newline to standard output. A reader that has gone away is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout().lock();
    match writeln!(stdout, "{text}").and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Internal(anyhow::Error::new(error).context("cannot write to standard output")))
        }
        _ => Ok(()),
    }
}

/// Prints a JSON value on one line.
pub(crate) fn print_json(value: &serde_json::Value) -> Result<(), Failure> {
    print(&value.to_string())
}

/// Refuses an output file that could not be written: wrong extension, a folder in its place, a folder that is
/// missing or closed to writing.
pub(crate) fn check_writable(path: &Path, extension: &str) -> Result<(), Failure> {
    let has_extension = path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension));
    if !has_extension {
        return Err(Failure::input(format!(
            "{}: the output's name must end in .{extension}",
            path.display()
        )));
    }
    if path.is_dir() {
        return Err(Failure::input(format!("{}: a folder is in the output's place", path.display())));
    }
    check_folder(folder_of(path))
}

/// Refuses outputs in the place of files that are read, by whatever paths these are named.
pub(crate) fn check_apart<'p>(
    outputs: impl IntoIterator<Item = impl AsRef<Path>>,
    inputs: impl IntoIterator<Item = &'p Path>,
) -> Result<(), Failure> {
    let read: Vec<PathBuf> = inputs.into_iter().filter_map(|input| input.canonicalize().ok()).collect();
    for output in outputs {
        let output = output.as_ref();
        if output.canonicalize().is_ok_and(|written| read.contains(&written)) {
            return Err(Failure::input(format!(
                "{}: this file is read and would be replaced: the output must have another name",
                output.display()
            )));
        }
    }
    Ok(())
}

/// Makes a folder if it is missing, and refuses one that no file can be made in.
pub(crate) fn make_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Failure::input(format!("{}: cannot make this folder ({error})", folder.display()))
    })?;
    check_folder(folder)
}

/// The path of a file in a folder, with what is no letter, digit, `-`, `_` or `.` in its name replaced.
pub(crate) fn file_in(folder: &Path, name: &str) -> PathBuf {
    folder.join(name.replace(|c: char| !c.is_alphanumeric() && !"-_.".contains(c), "_"))
}

/// Refuses a folder that no file can be made in.
fn check_folder(folder: &Path) -> Result<(), Failure> {
    let probe = tempfile::Builder::new().prefix(".wheatstone-").suffix(".part").tempfile_in(folder);
    probe.map(drop).map_err(|error| {
        Failure::input(match error.kind() {
            ErrorKind::NotFound => format!("{}: no such folder", folder.display()),
            other => format!("{}: cannot create a file here ({other})", folder.display()),
        })
    })
}

/// The path of frame `index` of a sequence: `OUT.png` becomes `OUT_0000.png`.
pub(crate) fn numbered(path: &Path, index: u32) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}_{index:04}.{extension}"))
}

/// The path of a file that is not there and not taken: `OUT.png`, `OUT-2.png`, `OUT-3.png` and so on.
pub(crate) fn unused(path: &Path, is_taken: impl Fn(&Path) -> bool) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    let others = (2_u64..).map(|number| path.with_file_name(format!("{stem}-{number}.{extension}")));
    let is_free = |path: &PathBuf| path.symlink_metadata().is_err() && !is_taken(path);
    std::iter::once(path.to_owned()).chain(others).find(is_free).unwrap_or_else(|| path.to_owned())
}

/// Files in words.
pub(crate) fn described(outputs: &[PathBuf]) -> String {
    match outputs {
        [] => "nothing".to_owned(),
        [one] => one.display().to_string(),
        [first, .., last] => format!("{} … {}", first.display(), last.display()),
    }
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_before_the_extension() {
        assert_eq!(numbered(Path::new("a/b.c.png"), 7), Path::new("a/b.c_0007.png"));
        assert_eq!(numbered(Path::new("x.png"), 12345), Path::new("x_12345.png"));
    }

    #[test]
    fn a_name_that_is_taken_is_followed_by_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        assert_eq!(unused(&path("a.png"), |_| false), path("a.png"));
        std::fs::write(path("a.png"), []).unwrap();
        std::fs::write(path("a-3.png"), []).unwrap();
        assert_eq!(unused(&path("a.png"), |_| false), path("a-2.png"));
        assert_eq!(unused(&path("a.png"), |other| other == path("a-2.png")), path("a-4.png"));
    }

    #[test]
    fn outputs_are_other_files_than_inputs_whatever_they_are_called() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a.png"), []).unwrap();
        std::fs::create_dir(path("sub")).unwrap();
        let apart = |output: &str| check_apart([path("new.png"), path(output)], [path("a.png").as_path()]);
        for same in ["a.png", "./a.png", "sub/../a.png"] {
            let error = apart(same).unwrap_err().to_string();
            assert!(error.contains(same) && !error.contains("new.png"), "{error}");
        }
        assert!(apart("b.png").is_ok() && apart("sub/a.png").is_ok());
        assert!(check_apart([path("b.png")], [path("missing.png").as_path()]).is_ok());
    }
}
