//! What a head and two hands did, to be played back.

mod check;
mod error;
mod line;
mod recorder;

pub use check::TickError;
pub use error::{LineError, RecordingError};
pub use recorder::Recorder;

use super::{Eye, Hand, Pinch, Tick};
use crate::head::{Display, Pose};
use line::{Header, TickLine};
use std::io::{BufRead, Read, Write};

/// Most ticks of a recording: an hour at 90 Hz.
pub(super) const MOST_TICKS: usize = 324_000;

/// Longest line that is read, bytes: several times what a tick takes.
const LONGEST_LINE: usize = 8192;

/// Ticks in order of time, at least one.
///
/// The written form is JSON Lines. The first line is the header: `wheatstone_recording` (version of the form), `units`, `period_s`
/// (from refresh to refresh) and `frusta` (of the left and the right eye: tangents `left`, `right`, `down`, `up`, depths `near_m`
/// and `far_m`, without the latter if it is infinite). Each further line is a tick: `time_s` (when it is displayed), `eyes` (left
/// and right pose: `position_m`, and `orientation` as x, y, z, w; without `eyes` where there are none) and `hands` (left and right:
/// `grip` and `aim` if tracked, `squeeze`, `trigger`, `stick`, `menu`). A tick has a `period_s` or `frusta` of its own if they
/// differ from the header's.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    ticks: Vec<Tick>,
}

impl Recording {
    /// A recording of some ticks.
    ///
    /// # Errors
    /// No ticks or too many, a tick that is not after the one before, numbers that are not finite or out of bounds.
    pub fn new(ticks: Vec<Tick>) -> Result<Self, RecordingError> {
        let mut recording = Self { ticks: Vec::new() };
        for (index, tick) in ticks.into_iter().enumerate() {
            recording.push(tick).map_err(|fault| RecordingError::Tick { index, fault })?;
        }
        recording.unless_empty()
    }

    /// Reads the written form. Orientations are made to have unit length again.
    ///
    /// # Errors
    /// What cannot be read, is of a later version, or as of [`Recording::new`], each with the number of its line.
    pub fn read(mut reader: impl BufRead) -> Result<Self, RecordingError> {
        let mut recording = Self { ticks: Vec::new() };
        let mut header: Option<Header> = None;
        let mut text = Vec::new();
        for line in 1.. {
            text.clear();
            let read = reader.by_ref().take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut text);
            if read.map_err(|error| RecordingError::Read { line, error })? == 0 {
                break;
            }
            let fault = |fault| RecordingError::Line { line, fault };
            if text.len() > LONGEST_LINE {
                return Err(fault(LineError::TooLong));
            }
            match &header {
                None => header = Some(Header::parse(&text).map_err(fault)?),
                Some(header) => {
                    let tick = TickLine::parse(&text).and_then(|line| line.tick(header)).map_err(fault)?;
                    recording.push(tick).map_err(|error| fault(error.into()))?;
                }
            }
        }
        recording.unless_empty()
    }

    /// Writes the form that [`Recording::read`] reads.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn write(&self, writer: impl Write) -> Result<(), RecordingError> {
        let mut recorder = Recorder::new(writer);
        self.ticks.iter().try_for_each(|tick| recorder.record(tick))?;
        recorder.finish()
    }

    /// The ticks as they have been recorded.
    pub fn ticks(&self) -> &[Tick] {
        &self.ticks
    }

    /// From the first tick to the last, seconds.
    pub fn duration_s(&self) -> f64 {
        self.ticks[self.ticks.len() - 1].display_time_s - self.ticks[0].display_time_s
    }

    /// What there is at a time between the first tick and the last; `None` at another. Positions are interpolated evenly,
    /// orientations along the shorter arc. Poses that are missing in the tick before or after are missing; what is pressed, the
    /// period and the frusta are those of the newest tick before.
    pub fn tick_at(&self, time_s: f64) -> Option<Tick> {
        let after = self.ticks.partition_point(|tick| tick.display_time_s <= time_s);
        let before = &self.ticks[after.checked_sub(1)?];
        let Some(after) = self.ticks.get(after) else {
            return (before.display_time_s == time_s).then_some(*before);
        };
        let share = (time_s - before.display_time_s) / (after.display_time_s - before.display_time_s);
        if share == 0.0 {
            return Some(*before);
        }
        let between = |before: Option<Pose>, after: Option<Pose>| Some(before?.between(&after?, share));
        let eyes = before.eyes.zip(after.eyes).map(|(before, after)| {
            [0, 1].map(|side: usize| Eye {
                pose: before[side].pose.between(&after[side].pose, share),
                ..before[side]
            })
        });
        let hands = [0, 1].map(|side: usize| {
            let (before, after) = (before.hands[side], after.hands[side]);
            let pinch = before.pinch.zip(after.pinch).map(|(before, after)| Pinch {
                position_m: before.position_m.lerp(after.position_m, share),
                ..before
            });
            let (grip, aim) = (between(before.grip, after.grip), between(before.aim, after.aim));
            Hand { grip, aim, pinch, ..before }
        });
        Some(Tick { display_time_s: time_s, eyes, hands, ..*before })
    }

    /// The ticks of another display's refreshes, the first at the recording's first.
    pub fn replay(&self, display: Display) -> impl Iterator<Item = Tick> {
        let first_s = self.ticks[0].display_time_s;
        (0..).map_while(move |refresh| {
            let tick = self.tick_at(first_s + display.refresh_s(refresh))?;
            Some(Tick { period_s: display.period_s(), ..tick })
        })
    }

    fn push(&mut self, tick: Tick) -> Result<(), TickError> {
        if self.ticks.len() >= MOST_TICKS {
            return Err(TickError::TooMany { most: MOST_TICKS });
        }
        self.ticks.push(check::checked(tick, self.ticks.last())?);
        Ok(())
    }

    fn unless_empty(self) -> Result<Self, RecordingError> {
        if self.ticks.is_empty() { Err(RecordingError::Empty) } else { Ok(self) }
    }
}
