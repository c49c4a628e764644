//! `doctor`.
use crate::failure::Failure;
use clap::Args;

/// To do.
#[derive(Debug, Args)]
pub(crate) struct DoctorArgs {}

/// Runs the command.
pub(crate) fn run(_: &DoctorArgs) -> Result<(), Failure> {
    Ok(())
}
