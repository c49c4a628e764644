//! Pictures to be written.

use super::state::Camera;
use crate::output::numbered;
use std::fmt;
use std::path::PathBuf;

/// Most pictures of a turn.
const MOST_PICTURES: u32 = 10_000;

/// What of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Subject {
    /// The picture at rest, without handles.
    Picture,
    /// Everything, as it is.
    Window,
}

/// One file to write.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Capture {
    pub(crate) subject: Subject,
    pub(crate) path: PathBuf,
}

/// A full turn, picture by picture.
#[derive(Debug)]
pub(crate) struct Turntable {
    pictures: u32,
    taken: u32,
    path: PathBuf,
    /// From where the first picture is taken, once that is known.
    pub(crate) start: Option<Camera>,
}

impl fmt::Display for Turntable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a turntable ({}, {} of {} pictures)", self.path.display(), self.taken, self.pictures)
    }
}

impl Turntable {
    pub(crate) fn new(pictures: u32, path: PathBuf, start: Option<Camera>) -> Result<Self, String> {
        if (1..=MOST_PICTURES).contains(&pictures) {
            Ok(Self { pictures, taken: 0, path, start })
        } else {
            Err(format!("a turn of {pictures} pictures: must be from 1 to {MOST_PICTURES}"))
        }
    }

    /// The next picture.
    pub(crate) fn next_shot(&mut self) -> Option<Capture> {
        let index = (!self.is_over()).then_some(self.taken)?;
        self.taken += 1;
        Some(Capture { subject: Subject::Picture, path: numbered(&self.path, index) })
    }

    /// How far from the start the next picture is taken, degrees; 0 at the end.
    pub(crate) fn turned_deg(&self) -> f64 {
        360.0 * f64::from(self.taken % self.pictures) / f64::from(self.pictures)
    }

    /// Whether all pictures are taken.
    pub(crate) fn is_over(&self) -> bool {
        self.taken == self.pictures
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_ends_where_it_began() {
        let mut turntable = Turntable::new(5, "a/turn.png".into(), None).unwrap();
        let next = |turntable: &mut Turntable| Some((turntable.turned_deg(), turntable.next_shot()?));
        let shots: Vec<_> = std::iter::from_fn(|| next(&mut turntable)).collect();
        assert_eq!(shots.iter().map(|shot| shot.0).collect::<Vec<_>>(), [0.0, 72.0, 144.0, 216.0, 288.0]);
        assert_eq!(shots[4].1.path, PathBuf::from("a/turn_0004.png"));
        assert!(turntable.is_over() && turntable.turned_deg() == 0.0);
        assert!(Turntable::new(0, "a.png".into(), None).is_err());
    }
}
