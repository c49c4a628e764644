//! Projectors by the ids that a display knows them by.

use crate::lightfield::projectors::ProjectorArray;
use thiserror::Error;

/// Why an entry is of no projector of a display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum IdError {
    /// An entry of what the display does not have.
    #[error("projectors[{index}].id is {id}: the display has no projector of that id")]
    Unknown {
        /// Counted from 0.
        index: usize,
        /// The id.
        id: u32,
    },
    /// Two entries of one projector.
    #[error("projectors[{index}].id is {id}, as of another entry: ids must differ")]
    Repeated {
        /// Of the second entry, counted from 0.
        index: usize,
        /// The id.
        id: u32,
    },
}

/// The place in a display of the projector that an entry is of, if no entry before is of the same.
pub(super) fn place_of(
    id_of: impl Fn(usize) -> u32,
    index: usize,
    display: &ProjectorArray,
) -> Result<usize, IdError> {
    let id = id_of(index);
    let place = display.projectors().iter().position(|projector| projector.id == id);
    let place = place.ok_or(IdError::Unknown { index, id })?;
    if (0..index).any(|before| id_of(before) == id) {
        Err(IdError::Repeated { index, id })
    } else {
        Ok(place)
    }
}
