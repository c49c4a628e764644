//! A file, dropped by a script.

use egui::DroppedFile;
use std::path::{Path, PathBuf, absolute};

/// A file as windows tell of it.
#[derive(Debug)]
pub(crate) struct Dropped(PathBuf);

impl Dropped {
    pub(crate) fn new(path: &Path) -> Self {
        Self(absolute(path).unwrap_or_else(|_| path.to_owned()))
    }
}

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}
