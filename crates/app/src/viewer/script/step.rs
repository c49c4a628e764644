//! The steps of a script, one JSON value each.

use super::chord::Chord;
use super::drag::Drag;
use crate::failure::Failure;
use crate::text_file::read_text_file;
use crate::viewer::command::Command;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Largest script that is read, bytes.
const MOST_BYTES: u64 = 16 << 20;

/// One step; the next one follows when it is done.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Step {
    /// Waits so many milliseconds.
    WaitMs(u64),
    /// Waits for something, at most two minutes.
    WaitFor(Goal),
    /// Does a command, as a panel would.
    Do(Command),
    /// Drags the mouse.
    Drag(Drag),
    /// Presses a key and releases it at once.
    Press(Chord),
    /// Holds a key for some time.
    Hold { key: Chord, ms: u64 },
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
    use crate::viewer::state::Edit;

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
            "{",
            "7",
        ] {
            let error = parse(&format!("{{\"wait_ms\": 5}}\n{bad}")).unwrap_err();
            assert!(error.starts_with("line 2:"), "{error}");
        }
    }
}
