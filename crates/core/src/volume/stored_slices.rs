//! Stored numbers of whole slices.

use super::{Encoding, StorageKind, StoredVoxels, Volume, Voxels};
use std::borrow::Cow;
use std::ops::Range;

/// Stored numbers of some slices of a volume, borrowed where the volume holds them as they are.
#[derive(Debug)]
pub(crate) enum StoredSlices<'a> {
    U8(Cow<'a, [u8]>),
    U16(Cow<'a, [u16]>),
    F32(Cow<'a, [f32]>),
}

impl<'a> StoredSlices<'a> {
    /// Of a volume at a precision.
    pub(crate) fn of_volume(
        volume: &'a Volume,
        kind: StorageKind,
        encoding: &Encoding,
        slices: Range<usize>,
    ) -> Self {
        let range = voxels_in(volume.grid().dims(), slices);
        let is_as_it_is = encoding.stored(0.0) == 0.0 && encoding.stored(1.0) == 1.0;
        match (kind, volume.voxels()) {
            (StorageKind::U8, Voxels::U8(v)) if is_as_it_is => Self::U8(Cow::Borrowed(&v[range])),
            (StorageKind::U16, Voxels::U16(v)) if is_as_it_is => Self::U16(Cow::Borrowed(&v[range])),
            (StorageKind::F32, Voxels::F32(v)) if is_as_it_is => Self::F32(Cow::Borrowed(&v[range])),
            (_, voxels) => match encoding.encode(voxels, range) {
                StoredVoxels::U8(v) => Self::U8(Cow::Owned(v)),
                StoredVoxels::U16(v) => Self::U16(Cow::Owned(v)),
                StoredVoxels::F32(v) => Self::F32(Cow::Owned(v)),
            },
        }
    }
}

fn voxels_in([width, height, _]: [usize; 3], slices: Range<usize>) -> Range<usize> {
    slices.start * width * height..slices.end * width * height
}
