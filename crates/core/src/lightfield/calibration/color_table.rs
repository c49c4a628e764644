//! Making the colours of projectors alike (LF §5, the second pass).

use crate::image::RgbImage;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// What a projector is to be sent for each level that is to be seen: a table for each channel, its entries spread evenly from level 0 to
/// level 1, interpolated between.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ColorTable {
    red: Vec<f32>,
    green: Vec<f32>,
    blue: Vec<f32>,
}

/// Numbers that are no table.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum NotATable {
    /// Fewer than two entries.
    #[error("the {channel} table has {found} entries: at least 2 are needed")]
    TooShort {
        /// Which channel.
        channel: &'static str,
        /// Entries that it has.
        found: usize,
    },
    /// An entry that is no level.
    #[error("entry {index} of the {channel} table is {value}: must be from 0 to 1")]
    NotALevel {
        /// Which channel.
        channel: &'static str,
        /// Counted from 0.
        index: usize,
        /// As it is.
        value: f32,
    },
}

impl ColorTable {
    /// A table from its entries for red, green and blue.
    ///
    /// # Errors
    /// Fewer than two entries, entries that are not from 0 to 1.
    pub fn new([red, green, blue]: [Vec<f32>; 3]) -> Result<Self, NotATable> {
        Self { red, green, blue }.checked()
    }

    /// The same if it can be one, as after reading it.
    ///
    /// # Errors
    /// As [`ColorTable::new`].
    pub fn checked(self) -> Result<Self, NotATable> {
        for (channel, table) in ["red", "green", "blue"].into_iter().zip(self.channels()) {
            if table.len() < 2 {
                return Err(NotATable::TooShort { channel, found: table.len() });
            }
            if let Some((index, &value)) = table.iter().enumerate().find(|(_, v)| !(0.0..=1.0).contains(*v)) {
                return Err(NotATable::NotALevel { channel, index, value });
            }
        }
        Ok(self)
    }

    fn channels(&self) -> [&[f32]; 3] {
        [&self.red, &self.green, &self.blue]
    }

    /// The colour that is sent for one that is to be seen.
    pub fn corrected(&self, rgb: [f32; 3]) -> [f32; 3] {
        let channels = self.channels();
        [0, 1, 2].map(|c| {
            let last = channels[c].len() - 1;
            let along = rgb[c].clamp(0.0, 1.0) * last as f32;
            let before = (along as usize).min(last - 1);
            let part = along - before as f32;
            channels[c][before] + (channels[c][before + 1] - channels[c][before]) * part
        })
    }

    /// The picture that is sent for one that is to be seen.
    pub fn apply(&self, picture: &RgbImage) -> RgbImage {
        RgbImage { rgb: picture.rgb.iter().map(|&rgb| self.corrected(rgb)).collect(), ..*picture }
    }
}
