//! `phantom`.
use crate::failure::Failure;
use clap::Args;

/// To do.
#[derive(Debug, Args)]
pub(crate) struct PhantomArgs {}

/// Runs the command.
pub(crate) fn run(_: &PhantomArgs) -> Result<(), Failure> {
    Ok(())
}
