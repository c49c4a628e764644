//! Cells that have been given out by the schedule and are not yet measured.

use super::piece::Piece;
use std::collections::VecDeque;
use wheatstone_core::budget::Batch;

/// A batch under way.
#[derive(Debug)]
pub(super) struct OpenBatch {
    pub(super) batch: Batch,
    /// What each cell has taken so far.
    seconds: Vec<f64>,
    /// What has not been handed to the device.
    pieces: VecDeque<Piece>,
    /// Whether it is not too dear for one refresh.
    fits: bool,
}

impl OpenBatch {
    pub(super) fn new(batch: Batch, pieces: VecDeque<Piece>, fits: bool) -> Self {
        Self { seconds: vec![0.0; batch.cells().len()], batch, pieces, fits }
    }

    /// The next pieces, no more than given: all, or one if the batch is too dear for one refresh.
    pub(super) fn take(&mut self, most: usize) -> Vec<Piece> {
        let count = if self.fits { most } else { 1 };
        self.pieces.drain(..count.min(self.pieces.len())).collect()
    }

    pub(super) fn is_handed_over(&self) -> bool {
        self.pieces.is_empty()
    }

    /// The pieces of some places took some time each.
    pub(super) fn add(&mut self, places: &[usize], seconds: &[f64]) {
        for (&place, s) in places.iter().zip(seconds) {
            self.seconds[place] += s;
        }
    }

    /// What the cells took, seconds.
    pub(super) fn seconds(&self) -> &[f64] {
        &self.seconds
    }
}
