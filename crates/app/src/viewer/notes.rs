//! Messages that the window shows for a while.

use crate::failure::Failure;
use std::time::{Duration, Instant};

/// How long a message is shown.
const SHOWN_FOR: Duration = Duration::from_secs(6);

/// Most messages at a time.
const MOST: usize = 5;

/// Most failures that are kept.
const MOST_FAILURES: usize = 100;

/// Whether something went well.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    Done,
    Warning,
    Failed,
}

/// One message.
#[derive(Debug, Clone)]
pub(crate) struct Note {
    pub(crate) tone: Tone,
    pub(crate) text: String,
    since: Instant,
}

/// The latest messages, and the first failures.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    latest: Vec<Note>,
    failures: Vec<String>,
}

impl Notes {
    /// Something that has been done.
    pub(crate) fn done(&mut self, text: impl Into<String>) {
        self.push(Tone::Done, text.into());
    }

    /// Something that has been done otherwise than may be thought.
    pub(crate) fn warn(&mut self, text: impl Into<String>) {
        self.push(Tone::Warning, text.into());
    }

    /// Something that has failed.
    pub(crate) fn failed(&mut self, text: impl Into<String>) {
        let text = text.into();
        if self.failures.len() < MOST_FAILURES {
            self.failures.push(text.clone());
        }
        self.push(Tone::Failed, text);
    }

    /// Notes a failure; that of a device that is gone comes back.
    pub(crate) fn survive<T>(&mut self, outcome: Result<T, Failure>) -> Result<Option<T>, Failure> {
        match outcome {
            Err(failure) if failure.is_end_of_device() => Err(failure),
            Err(failure) => {
                self.failed(failure.to_string());
                Ok(None)
            }
            Ok(made) => Ok(Some(made)),
        }
    }

    /// What is to be shown now.
    pub(crate) fn latest(&mut self) -> &[Note] {
        self.latest.retain(|note| note.since.elapsed() < SHOWN_FOR);
        &self.latest
    }

    /// The failures of the session.
    pub(crate) fn failures(&self) -> &[String] {
        &self.failures
    }

    fn push(&mut self, tone: Tone, text: String) {
        self.latest.retain(|note| note.text != text);
        self.latest.push(Note { tone, text, since: Instant::now() });
        let surplus = self.latest.len().saturating_sub(MOST);
        self.latest.drain(..surplus);
    }
}
