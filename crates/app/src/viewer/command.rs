//! What the viewer can be told to do, by a panel, a key or a script.

use super::state::Edit;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use std::path::PathBuf;

/// One thing to do.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case", remote = "Self")]
pub(crate) enum Command {
    /// Opens a volume, or a saved view with the volume that it shows.
    Open(PathBuf),
    /// Opens the first of the files that have been dropped together.
    Drop(Vec<PathBuf>),
    /// Opens the volume that ships with the program.
    OpenShipped,
    /// Reads the volume again and keeps everything else.
    Reload,
    /// Saves what is shown, as JSON.
    Save(PathBuf),
    /// The same by a name that no file has: a.json, a-2.json, a-3.json and so on.
    SaveNew(PathBuf),
    /// Writes the picture, once it is at rest: PNG.
    Picture(PathBuf),
    /// Writes the whole window as it is now: PNG.
    Screenshot(PathBuf),
    /// The same by a name that no file has.
    ScreenshotNew(PathBuf),
    /// Writes so many pictures at rest of a full turn, numbered before the extension: PNG.
    Turntable { pictures: u32, path: PathBuf },
    /// Takes a transfer function by name or from a file, as `--tf` does.
    Preset(String),
    /// Fills the whole screen with the window, or no longer.
    FullScreen,
    /// Ends the program.
    Quit,
    /// Changes what is shown.
    #[serde(skip)]
    Edit(Edit),
}

impl<'de> Deserialize<'de> for Command {
    /// Edits are written as commands are. What is neither is told as what it looks like.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let read = match Self::deserialize(&value) {
            Err(error) if error.to_string().starts_with("unknown variant") => {
                Edit::deserialize(&value).map(Self::Edit)
            }
            read => read,
        };
        read.map_err(D::Error::custom)
    }
}

impl From<Edit> for Command {
    fn from(edit: Edit) -> Self {
        Self::Edit(edit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_and_edits_are_written_alike() {
        let parse = |text: &str| serde_json::from_str::<Command>(text);
        assert_eq!(parse(r#"{"save": "a.json"}"#).unwrap(), Command::Save("a.json".into()));
        assert_eq!(parse(r#""quit""#).unwrap(), Command::Quit);
        let orbit = Edit::Orbit { right_deg: 5.0, up_deg: 0.0 };
        assert_eq!(parse(r#"{"orbit": {"right_deg": 5, "up_deg": 0}}"#).unwrap(), orbit.into());
        assert_eq!(parse(r#"{"shading": "directional:4"}"#).unwrap(), {
            let directions = 4;
            Edit::Shading(wheatstone_core::scene::Shading::Directional { directions }).into()
        });
    }

    #[test]
    fn what_is_wrong_with_a_command_is_told() {
        for (text, says) in [
            (r#"{"shading": "gouraud"}"#, "none, phong"),
            (r#"{"dance": 1}"#, "`dance`"),
            (r#"{"mode": "mri"}"#, "`mri`"),
            (r#"{"save": 5}"#, "path string"),
            (r#"{"turntable": {"path": "a.png"}}"#, "`pictures`"),
            (r#"{"display": "mine.json"}"#, "mine.json: files of displays"),
            (r#"{"display": "folder/mine.JSON"}"#, "mine.JSON: files of displays"),
            ("7", "7"),
        ] {
            let error = serde_json::from_str::<Command>(text).unwrap_err().to_string();
            assert!(error.contains(says) && !error.contains("untagged"), "{text}: {error}");
        }
    }
}
