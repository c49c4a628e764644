//! `demo`.
use crate::failure::Failure;
use clap::Args;

/// To do.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {}

/// Runs the command.
pub(crate) fn run(_: &DemoArgs) -> Result<(), Failure> {
    Ok(())
}
