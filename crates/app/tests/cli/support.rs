//! Runs the binary.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// A folder that goes away, with a small phantom in it.
pub(crate) struct Bench {
    folder: TempDir,
}

/// What a run left: exit code and both streams.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Bench {
    /// A folder with `sphere.nrrd` of 24³ voxels.
    pub(crate) fn new() -> Self {
        let bench = Self { folder: tempfile::tempdir().unwrap() };
        let run = bench.run(&["phantom", "sphere", "--size", "24", "-o", "sphere.nrrd"]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        bench
    }

    /// Runs the binary in the folder.
    pub(crate) fn run(&self, args: &[&str]) -> Run {
        self.run_in(args, &[])
    }

    /// Runs the binary in the folder with some environment variables.
    pub(crate) fn run_in(&self, args: &[&str], environment: &[(&str, &str)]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_wheatstone"))
            .args(args)
            .current_dir(self.folder.path())
            .envs(environment.iter().copied())
            .output()
            .unwrap();
        Run::from(output)
    }

    /// `render sphere.nrrd` on the CPU at 32×24 with some more flags, which must succeed.
    pub(crate) fn render(&self, output: &str, flags: &[&str]) -> Run {
        let run = self.try_render(output, flags);
        assert_eq!(run.code, 0, "{flags:?}: {}", run.stderr);
        run
    }

    /// The same, whatever comes of it.
    pub(crate) fn try_render(&self, output: &str, flags: &[&str]) -> Run {
        let has_size = flags.contains(&"--size");
        let size: &[&str] = if has_size { &[] } else { &["--size", "32x24"] };
        self.run(&[&["render", "sphere.nrrd", "-o", output, "--backend", "cpu"], size, flags].concat())
    }

    /// A path in the folder.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Names of the files in the folder, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.folder.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Width, height and colour type of a PNG file.
    pub(crate) fn png(&self, name: &str) -> (u32, u32, image::ColorType) {
        let picture = image::open(self.path(name)).unwrap();
        (picture.width(), picture.height(), picture.color())
    }
}

impl Run {
    /// The one JSON object on standard output.
    pub(crate) fn json(&self) -> serde_json::Value {
        assert_eq!(self.stdout.lines().count(), 1, "{}", self.stdout);
        serde_json::from_str(&self.stdout).unwrap()
    }
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

/// A file of the repository.
pub(crate) fn repository_file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}
