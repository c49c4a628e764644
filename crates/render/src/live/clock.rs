//! What pieces take.

use super::host_clock::HostClock;
use super::stamp_clock::StampClock;
use crate::gpu::{Gpu, GpuError, SUBMISSION_TIMEOUT};
use crate::stamps::Stamps;

/// Times the pieces of one submission after the other: by timestamps, or where the device has none by the host's clock.
#[derive(Debug)]
pub(super) enum PieceClock {
    Stamps(Box<StampClock>),
    Host(HostClock),
}

impl PieceClock {
    /// Most pieces of a submission.
    pub(super) const MOST_PIECES: usize = StampClock::MOST_PIECES;

    pub(super) fn new(gpu: &Gpu) -> Self {
        if gpu.capabilities().has_timestamps {
            Self::Stamps(Box::new(StampClock::new(gpu)))
        } else {
            Self::Host(HostClock::default())
        }
    }

    /// Timestamps of a piece of the submission.
    pub(super) fn stamps(&self, piece: usize) -> Stamps<'_> {
        match self {
            Self::Stamps(clock) => clock.stamps(piece),
            Self::Host(_) => Stamps::NONE,
        }
    }

    /// Encodes what is to be read of one or more pieces, after them.
    pub(super) fn encode_reading(&self, encoder: &mut wgpu::CommandEncoder, pieces: usize) {
        match self {
            Self::Stamps(clock) => clock.encode_reading(encoder, pieces),
            Self::Host(_) => {}
        }
    }

    /// Begins to read, after the submission.
    pub(super) fn begin_reading(&mut self, gpu: &Gpu, pieces: usize) {
        match self {
            Self::Stamps(clock) => clock.begin_reading(pieces),
            Self::Host(clock) => clock.begin_reading((&gpu.device, &gpu.queue), pieces, SUBMISSION_TIMEOUT),
        }
    }

    /// What the pieces took, seconds, once the device has finished them.
    pub(super) fn read(&mut self) -> Result<Option<Vec<f64>>, GpuError> {
        match self {
            Self::Stamps(clock) => clock.read(),
            Self::Host(clock) => Ok(clock.read()),
        }
    }
}
