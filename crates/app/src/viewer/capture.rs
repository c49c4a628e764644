//! Pictures to be written.

use crate::output::numbered;
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
}

impl Turntable {
    pub(crate) fn new(pictures: u32, path: PathBuf) -> Result<Self, String> {
        if (1..=MOST_PICTURES).contains(&pictures) {
            Ok(Self { pictures, taken: 0, path })
        } else {
            Err(format!("a turn of {pictures} pictures: must be from 1 to {MOST_PICTURES}"))
        }
    }

    /// The next picture, and by how many degrees to turn when it is taken.
    pub(crate) fn next_shot(&mut self) -> Option<(Capture, f64)> {
        let index = (self.taken < self.pictures).then_some(self.taken)?;
        self.taken += 1;
        let path = numbered(&self.path, index);
        Some((Capture { subject: Subject::Picture, path }, 360.0 / f64::from(self.pictures)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_ends_where_it_began() {
        let mut turntable = Turntable::new(5, "a/turn.png".into()).unwrap();
        let shots: Vec<_> = std::iter::from_fn(|| turntable.next_shot()).collect();
        assert_eq!(shots.len(), 5);
        assert_eq!(shots[4].0.path, PathBuf::from("a/turn_0004.png"));
        assert!((shots.iter().map(|shot| shot.1).sum::<f64>() - 360.0).abs() < 1e-9);
        assert!(Turntable::new(0, "a.png".into()).is_err());
    }
}
