//! `info`.
use crate::failure::Failure;
use clap::Args;

/// To do.
#[derive(Debug, Args)]
pub(crate) struct InfoArgs {}

/// Runs the command.
pub(crate) fn run(_: &InfoArgs) -> Result<(), Failure> {
    Ok(())
}
