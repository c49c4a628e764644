//! Why a command failed, and the exit code that says so.

use std::fmt;
use std::process::ExitCode;
use wheatstone_io::{ReadError, WriteError};
use wheatstone_render::GpuError;
use wheatstone_render::live::LiveError;

/// A command's failure, sorted by who can do something about it.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Bad input, bad usage or an output that cannot be written: exit code 2.
    Input(anyhow::Error),
    /// The GPU refused, failed or is missing: exit code 1. `--backend auto` falls back to the CPU.
    Gpu(GpuError),
    /// Anything else: exit code 1.
    Internal(anyhow::Error),
}

impl Failure {
    /// Bad input in words.
    pub(crate) fn input(message: impl fmt::Display) -> Self {
        Self::Input(anyhow::anyhow!("{message}"))
    }

    /// Whether it is that of a device that is gone.
    pub(crate) fn is_end_of_device(&self) -> bool {
        matches!(self, Self::Gpu(GpuError::Lost { .. } | GpuError::Hung { .. }))
    }

    /// The process's exit code.
    pub(crate) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Input(_) => ExitCode::from(2),
            Self::Gpu(_) | Self::Internal(_) => ExitCode::from(1),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(error) | Self::Internal(error) => write!(f, "{error:#}"),
            Self::Gpu(error) => error.fmt(f),
        }
    }
}

impl From<LiveError> for Failure {
    fn from(error: LiveError) -> Self {
        match error {
            LiveError::Gpu(error) => Self::Gpu(error),
            other => Self::input(other),
        }
    }
}

impl From<anyhow::Error> for Failure {
    fn from(error: anyhow::Error) -> Self {
        Self::Internal(error)
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Self::Input(error.into())
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        Self::Input(error.into())
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}
