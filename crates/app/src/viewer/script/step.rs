//! The steps of a script, one JSON value each.

use super::chord::Chord;
use super::drag::Drag;
use crate::failure::Failure;
use crate::text_file::read_text_file;
use crate::viewer::command::Command;
use crate::viewer::state::Edit;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};
use std::path::{Path, PathBuf};

/// Largest script that is read, bytes.
const MOST_BYTES: u64 = 16 << 20;

/// Longest that one step lasts: an hour.
const LONGEST_MS: u64 = 3_600_000;

/// One step; the next one follows when it is done.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Step {
    /// Waits so many milliseconds.
    WaitMs(#[serde(deserialize_with = "duration_ms")] u64),
    /// Waits for something, at most two minutes.
    WaitFor(Goal),
    /// Does a command, as a panel would.
    Do(Command),
    /// Does an edit of some point of the transfer function, whichever it has then.
    #[serde(skip)]
    DoToSome(Edit),
    /// Drags the mouse.
    Drag(Drag),
    /// Presses a key and releases it at once.
    Press(Chord),
    /// Holds a key for some time.
    Hold {
        key: Chord,
        #[serde(deserialize_with = "duration_ms")]
        ms: u64,
    },
    /// Turns the wheel by so many points at a place of the window (points).
    Scroll { at: [f32; 2], points: f32 },
    /// Drops a file.
    Drop(PathBuf),
    /// Resizes the window to so many points.
    Resize([u32; 2]),
}

/// What a script waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Goal {
    /// No volume is on its way.
    Volume,
    /// The picture is at rest, and every file is written.
    Rest,
}

/// Reads a script: a step a line, empty lines and lines after `#` left out.
pub(crate) fn read_steps(path: &Path) -> Result<Vec<Step>, Failure> {
    read_text_file(path, MOST_BYTES, "a script", parse)
}

/// Reads a time, milliseconds.
pub(super) fn duration_ms<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    let ms = u64::deserialize(deserializer)?;
    if ms <= LONGEST_MS {
        Ok(ms)
    } else {
        Err(D::Error::custom(format!("{ms} ms are too long: at most {LONGEST_MS}, an hour")))
    }
}

fn parse(text: &str) -> Result<Vec<Step>, String> {
    let is_step = |line: &str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    let step = |(number, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|error| format!("line {}: {error}", number + 1))
    };
    text.lines().enumerate().filter(|(_, line)| is_step(line)).map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_script_is_a_step_a_line() {
        let steps = parse(
            "# a comment\n{\"wait_for\": \"volume\"}\n\n{\"do\": {\"zoom\": 2.0}}\n{\"press\": \"Ctrl+S\"}\n\
             {\"drag\": {\"from\": [10, 20], \"to\": [30, 40], \"ms\": 50}}\n{\"do\": \"quit\"}\n",
        )
        .unwrap();
        assert_eq!(steps.len(), 5);
        assert_eq!(steps[0], Step::WaitFor(Goal::Volume));
        assert_eq!(steps[1], Step::Do(Edit::Zoom(2.0).into()));
    }

    #[test]
    fn a_bad_line_is_named() {
        for bad in [
            "{\"hold\": {\"key\": \"Hyper\", \"ms\": 5}}",
            "{\"wait\": 5}",
            "{\"do\": {\"zoom\": \"x\"}}",
            "{\"press\": \"Any\"}",
            "{\"drag\": {\"from\": [0, 0], \"to\": [1, 1], \"ms\": 18446744073709551615}}",
            "{",
            "7",
        ] {
            let error = parse(&format!("{{\"wait_ms\": 5}}\n{bad}")).unwrap_err();
            assert!(error.starts_with("line 2:"), "{error}");
        }
    }

    #[test]
    fn no_step_lasts_for_more_than_an_hour() {
        for step in [
            "{\"wait_ms\": TIME}",
            "{\"hold\": {\"key\": \"W\", \"ms\": TIME}}",
            "{\"drag\": {\"from\": [0, 0], \"to\": [1, 1], \"ms\": TIME}}",
        ] {
            assert_eq!(parse(&step.replace("TIME", "3600000")).unwrap().len(), 1);
            for ms in ["3600001", "200000000000", "18446744073709551615"] {
                let error = parse(&step.replace("TIME", ms)).unwrap_err();
                assert!(error.contains(ms) && error.contains("an hour"), "{error}");
            }
        }
    }
}
