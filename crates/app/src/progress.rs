//! Progress on standard error; hidden where that is no terminal.

use indicatif::{ProgressBar, ProgressStyle};
use std::time::Duration;

/// A bar for a known number of steps; it goes away when it is dropped.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// A bar with a word for what is done.
    pub(crate) fn new(what: impl Into<std::borrow::Cow<'static, str>>, steps: u64) -> Self {
        let bar = ProgressBar::new(steps);
        if let Ok(style) = ProgressStyle::with_template("{msg:>8} {wide_bar} {pos}/{len} {eta}") {
            bar.set_style(style);
        }
        bar.set_message(what);
        Self(bar)
    }

    /// A spinner for work of unknown length.
    pub(crate) fn spinner(what: impl Into<String>) -> Self {
        let bar = ProgressBar::new_spinner();
        bar.set_message(what.into());
        bar.enable_steady_tick(Duration::from_millis(100));
        Self(bar)
    }

    /// Steps done so far, of a total that may have become known only now.
    pub(crate) fn set(&self, done: u64, total: u64) {
        self.0.set_length(total);
        self.0.set_position(done);
    }

    /// One step more.
    pub(crate) fn advance(&self) {
        self.0.inc(1);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
