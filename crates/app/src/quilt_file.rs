//! Names and metadata of quilts' files, by which players know how they are laid out.

use crate::failure::Failure;
use exif::experimental::Writer;
use exif::{Field, In, Tag, Value};
use serde_json::json;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use wheatstone_core::lightfield::QuiltDisplay;
use wheatstone_core::lightfield::quilt::QuiltName;

/// By how much of itself the aspect in a name may differ from that of the display: two decimals are usual.
const ASPECT_TOLERANCE: f64 = 0.02;

/// Where the quilts of one run are written.
#[derive(Debug, Clone)]
pub(crate) struct QuiltPaths {
    folder: PathBuf,
    /// What precedes the suffix.
    stem: String,
    /// From `_qs` to the end, with whatever else follows the layout.
    suffix: String,
}

impl QuiltPaths {
    /// Files named after `output`; the suffix is added where it lacks one.
    pub(crate) fn new(output: &Path, display: &QuiltDisplay) -> Result<Self, Failure> {
        let folder = output.parent().unwrap_or(Path::new("")).to_owned();
        let name = output.file_stem().and_then(|name| name.to_str());
        let name =
            name.ok_or_else(|| Failure::input(format!("{}: the name is no text", output.display())))?;
        check_name(name, display)?;
        let (stem, suffix) = match name.parse::<QuiltName>() {
            Ok(named) => (named.stem.clone(), name[named.stem.len()..].to_owned()),
            Err(_) => (name.to_owned(), QuiltName::of(display, "").to_string()),
        };
        Ok(Self { folder, stem, suffix })
    }

    /// The quilt, or that of a frame of a turntable.
    pub(crate) fn quilt(&self, frame: Option<u32>) -> PathBuf {
        self.path(frame, &self.suffix)
    }

    /// The interlaced picture that belongs to it.
    pub(crate) fn interlaced(&self, frame: Option<u32>) -> PathBuf {
        self.path(frame, "_interlaced")
    }

    fn path(&self, frame: Option<u32>, suffix: &str) -> PathBuf {
        let number = frame.map_or_else(String::new, |frame| format!("_{frame:04}"));
        self.folder.join(format!("{}{number}{suffix}.png", self.stem))
    }
}

/// Refuses the name of another display's quilt; a name that tells nothing is anybody's.
pub(crate) fn check_name(name: &str, display: &QuiltDisplay) -> Result<(), Failure> {
    let Ok(named) = name.parse::<QuiltName>() else { return Ok(()) };
    if is_named(&named, display) {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{name} is the name of a quilt of {}x{} views and aspect {}: the display's are called {}",
        named.columns,
        named.rows,
        named.aspect,
        QuiltName::of(display, named.stem),
    )))
}

/// Whether a name is that of a display's quilt.
pub(crate) fn is_named(named: &QuiltName, display: &QuiltDisplay) -> bool {
    (named.columns, named.rows) == (display.columns, display.rows)
        && (named.aspect / display.aspect - 1.0).abs() <= ASPECT_TOLERANCE
}

/// Exif's mark of plain text.
const PLAIN_TEXT: &[u8] = b"ASCII\0\0\0";

/// What Looking Glass' programs look for in a picture: JSON in the `UserComment` of its Exif metadata
/// (<https://docs.lookingglassfactory.com/keyconcepts/quilts>).
pub(crate) fn metadata(display: &QuiltDisplay) -> Result<Vec<u8>, Failure> {
    let layout = json!({
        "LKGNumViews": display.view_count(),
        "LKGRows": display.rows,
        "LKGColumns": display.columns,
        "LKGAspect": (display.aspect * 1e4).round() / 1e4,
        "LKGType": "Image",
    });
    let comment = Field {
        tag: Tag::UserComment,
        ifd_num: In::PRIMARY,
        value: Value::Undefined([PLAIN_TEXT, layout.to_string().as_bytes()].concat(), 0),
    };
    let mut writer = Writer::new();
    writer.push_field(&comment);
    let mut exif = Cursor::new(Vec::new());
    writer.write(&mut exif, true).map_err(|error| anyhow::anyhow!("cannot write Exif metadata: {error}"))?;
    Ok(exif.into_inner())
}
