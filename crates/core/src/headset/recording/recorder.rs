//! Ticks written as they come.

use super::check::{TickError, checked};
use super::line::{Header, TickLine};
use super::{MOST_TICKS, RecordingError};
use crate::headset::Tick;
use std::io::{self, Write};

/// Writes the form that [`Recording::read`](super::Recording::read) reads, tick by tick; the header with the first of them.
#[derive(Debug)]
pub struct Recorder<W> {
    writer: W,
    header: Option<Header>,
    last: Option<Tick>,
    written: usize,
}

impl<W: Write> Recorder<W> {
    /// Writes nothing yet.
    pub fn new(writer: W) -> Self {
        Self { writer, header: None, last: None, written: 0 }
    }

    /// Writes a tick.
    ///
    /// # Errors
    /// What cannot be written, and a tick that no recording may have: it is left out, and recording can go on (after a gap that is too long
    /// only anew).
    pub fn record(&mut self, tick: &Tick) -> Result<(), RecordingError> {
        let index = self.written;
        if index >= MOST_TICKS {
            let fault = TickError::TooMany { most: MOST_TICKS };
            return Err(RecordingError::Tick { index, fault });
        }
        let tick =
            checked(*tick, self.last.as_ref()).map_err(|fault| RecordingError::Tick { index, fault })?;
        if self.header.is_none() {
            write_line(&mut self.writer, &Header::of(&tick))?;
        }
        let header = self.header.get_or_insert_with(|| Header::of(&tick));
        write_line(&mut self.writer, &TickLine::of(&tick, header))?;
        self.last = Some(tick);
        self.written += 1;
        Ok(())
    }

    /// Hands everything to the writer.
    ///
    /// # Errors
    /// What cannot be written, and a recording without ticks.
    pub fn finish(mut self) -> Result<(), RecordingError> {
        self.writer.flush()?;
        if self.written == 0 { Err(RecordingError::Empty) } else { Ok(()) }
    }
}

fn write_line(writer: &mut impl Write, line: &impl serde::Serialize) -> Result<(), io::Error> {
    let mut text = serde_json::to_vec(line)?;
    text.push(b'\n');
    writer.write_all(&text)
}
