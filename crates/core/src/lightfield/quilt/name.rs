//! Names of files that tell how a quilt is laid out.

use super::QuiltDisplay;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// `NAME_qs{columns}x{rows}a{aspect}`, by which players know a quilt (<https://lookingglassfactory.com/tutorial/what-is-a-quilt>);
/// without the ending of the file's name. The maker's programs (its Unity plugin, its Blender add-on) look for that anywhere in a name
/// and some write more after it, as `z1.2f0` for zoom and focus.
#[derive(Debug, Clone, PartialEq)]
pub struct QuiltName {
    /// What precedes `_qs`.
    pub stem: String,
    /// Tiles beside each other.
    pub columns: u32,
    /// Tiles above each other.
    pub rows: u32,
    /// Width of the screen over its height.
    pub aspect: f64,
}

/// A name that does not tell how a quilt is laid out.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "{0:?} does not tell what quilts' names do, as _qs8x6a0.75: columns x rows and the screen's width over its height"
)]
pub struct NotAQuiltName(pub String);

impl QuiltName {
    /// The name of a display's quilt.
    pub fn of(display: &QuiltDisplay, stem: impl Into<String>) -> Self {
        Self { stem: stem.into(), columns: display.columns, rows: display.rows, aspect: display.aspect }
    }
}

impl fmt::Display for QuiltName {
    /// With four decimals of the aspect at most.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let aspect = (self.aspect * 1e4).round() / 1e4;
        write!(f, "{}_qs{}x{}a{aspect}", self.stem, self.columns, self.rows)
    }
}

impl FromStr for QuiltName {
    type Err = NotAQuiltName;

    /// Reads what the first `_qs` of a name tells that is followed by a layout, without regard to capitals, and leaves out what comes
    /// after the aspect.
    fn from_str(name: &str) -> Result<Self, NotAQuiltName> {
        let lower = name.to_ascii_lowercase();
        let mut layouts = lower.match_indices("_qs").filter_map(|(at, mark)| {
            let (columns, rows, aspect) = layout(&lower[at + mark.len()..])?;
            Some(Self { stem: name[..at].to_owned(), columns, rows, aspect })
        });
        layouts.next().ok_or_else(|| NotAQuiltName(name.to_owned()))
    }
}

/// Columns, rows and aspect at the beginning of a text.
fn layout(text: &str) -> Option<(u32, u32, f64)> {
    let (columns, rest) = text.split_once('x')?;
    let (rows, rest) = rest.split_once('a')?;
    let (columns, rows) = (whole_number(columns)?, whole_number(rows)?);
    let aspect = decimal_number(rest)?;
    (columns > 0 && rows > 0 && aspect > 0.0 && aspect.is_finite()).then_some((columns, rows, aspect))
}

/// Digits alone: no sign.
fn whole_number(text: &str) -> Option<u32> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

/// The number at the beginning of a text: digits, with one point at most.
fn decimal_number(text: &str) -> Option<f64> {
    let digits_end =
        |from: usize| text[from..].find(|c: char| !c.is_ascii_digit()).map_or(text.len(), |end| from + end);
    let whole = digits_end(0);
    let end = if text[whole..].starts_with('.') { digits_end(whole + 1) } else { whole };
    text[..end].parse().ok()
}
