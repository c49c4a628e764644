//! Recorded eyes and hands, into a file that is there when it is whole.

use super::room::{Beside, Room};
use crate::failure::Failure;
use crate::output::check_writable;
use anyhow::Context as _;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;
use wheatstone_core::headset::{Recorder, RecordingError};

/// A recording that is being made.
pub(crate) struct Record {
    path: PathBuf,
    file: NamedTempFile,
    recorder: Recorder<BufWriter<std::fs::File>>,
    last_s: Option<f64>,
    has_left_out: bool,
}

impl Record {
    /// Begins beside the file that it will be.
    pub(crate) fn begin(path: &Path) -> Result<Self, Failure> {
        check_writable(path, "jsonl")?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let begun = || -> anyhow::Result<_> {
            let file = NamedTempFile::new_in(folder)?;
            let writer = BufWriter::new(file.reopen()?);
            Ok((file, writer))
        };
        let (file, writer) =
            begun().with_context(|| format!("cannot write {}", path.display())).map_err(Failure::Input)?;
        Ok(Self {
            path: path.to_owned(),
            file,
            recorder: Recorder::new(writer),
            last_s: None,
            has_left_out: false,
        })
    }

    /// Ends: what there is takes the file's name; where there is nothing, there is no file.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self { path, file, recorder, .. } = self;
        match recorder.finish() {
            Ok(()) => {}
            Err(RecordingError::Empty) => {
                eprintln!("nothing to record: {} is not written", path.display());
                return Ok(());
            }
            Err(error) => return Err(failed(&path, error)),
        }
        let kept = file.persist(&path).map(drop);
        Ok(kept.with_context(|| format!("cannot write {}", path.display()))?)
    }
}

impl Beside for Record {
    fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure> {
        let Some(tick) =
            room.tick().filter(|tick| self.last_s.is_none_or(|last_s| tick.display_time_s > last_s))
        else {
            return Ok(());
        };
        self.last_s = Some(tick.display_time_s);
        match self.recorder.record(tick) {
            Err(error @ RecordingError::Tick { .. }) => {
                if !std::mem::replace(&mut self.has_left_out, true) {
                    eprintln!("left out of {}: {error}", self.path.display());
                }
                Ok(())
            }
            recorded => recorded.map_err(|error| failed(&self.path, error)),
        }
    }

    fn has_quit(&self) -> bool {
        false
    }
}

fn failed(path: &Path, error: RecordingError) -> Failure {
    Failure::Internal(anyhow::Error::from(error).context(format!("recording to {}", path.display())))
}
