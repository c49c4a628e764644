//! Ctrl-C, and being told to end.

use crate::failure::Failure;
use anyhow::Context as _;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that was interrupted, as shells have it.
const INTERRUPTED: i32 = 130;

/// Whether the program has been told to end.
#[derive(Debug, Default)]
pub(crate) struct Interrupt {
    has_come: Arc<AtomicBool>,
}

impl Interrupt {
    /// From now on the first time is noted, and the second one ends the program at once.
    pub(crate) fn watch(&self) -> Result<(), Failure> {
        let has_come = Arc::clone(&self.has_come);
        let watching = ctrlc::set_handler(move || {
            if has_come.swap(true, Ordering::Relaxed) {
                process::exit(INTERRUPTED);
            }
        });
        Ok(watching.context("cannot watch for Ctrl-C")?)
    }

    pub(crate) fn has_come(&self) -> bool {
        self.has_come.load(Ordering::Relaxed)
    }
}
