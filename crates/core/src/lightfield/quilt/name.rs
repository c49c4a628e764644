//! Names of files that tell how a quilt is laid out.

use super::QuiltDisplay;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// `NAME_qs{columns}x{rows}a{aspect}`, by which players know a quilt (<https://lookingglassfactory.com/tutorial/what-is-a-quilt>);
/// without the ending of the file's name.
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
    "{0:?} does not end as quilts' names do: in _qs8x6a0.75, columns x rows and the screen's width over its height"
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

    /// Reads the last `_qs` of a name, without regard to capitals. What follows the aspect from a letter on (as in `z1.2f0`) is left
    /// out.
    fn from_str(name: &str) -> Result<Self, NotAQuiltName> {
        parse(name).ok_or_else(|| NotAQuiltName(name.to_owned()))
    }
}

fn parse(name: &str) -> Option<QuiltName> {
    let lower = name.to_ascii_lowercase();
    let at = lower.rfind("_qs")?;
    let (columns, rest) = lower[at + 3..].split_once('x')?;
    let (rows, rest) = rest.split_once('a')?;
    let end = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
    let aspect: f64 = rest[..end].trim_end_matches('.').parse().ok()?;
    let [columns, rows] = [columns, rows].map(whole_number);
    let (columns, rows) = (columns?, rows?);
    let is_sound = columns > 0 && rows > 0 && aspect > 0.0 && aspect.is_finite();
    is_sound.then(|| QuiltName { stem: name[..at].to_owned(), columns, rows, aspect })
}

/// Digits alone: no sign.
fn whole_number(text: &str) -> Option<u32> {
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}
