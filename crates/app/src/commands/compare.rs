//! `compare`.
use crate::failure::Failure;
use clap::Args;

/// To do.
#[derive(Debug, Args)]
pub(crate) struct CompareArgs {}

/// Runs the command.
pub(crate) fn run(_: &CompareArgs) -> Result<(), Failure> {
    Ok(())
}
