//! Reading that is given up from elsewhere.

use std::{
    io::{self, Read},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
};

/// Gives up reading, from any thread: the reader ends with [`ReadError::Cancelled`](crate::ReadError::Cancelled) before the next
/// bytes of the file.
#[derive(Debug, Clone, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Gives up whatever looks at this or at a clone of it.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether it has been given up.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// A reader that fails once this is given up.
    pub(crate) fn watch<R>(&self, reader: R) -> Watched<R> {
        Watched { reader, cancel: self.clone() }
    }
}

/// A reader that fails once it is given up.
pub(crate) struct Watched<R> {
    reader: R,
    cancel: Cancel,
}

impl<R: Read> Read for Watched<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.cancel.is_cancelled() { Err(io::Error::other(Cancelled)) } else { self.reader.read(buffer) }
    }
}

#[derive(Debug, thiserror::Error)]
#[error("given up")]
struct Cancelled;

/// Whether an error is that of a [`Watched`] reader.
pub(crate) fn is_cancelled(error: &io::Error) -> bool {
    error.get_ref().is_some_and(|inner| inner.is::<Cancelled>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    /// Gives everything up after some reads.
    struct GivesUp {
        reads: u32,
        cancel: Cancel,
    }

    impl Read for GivesUp {
        fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
            self.reads -= 1;
            if self.reads == 0 {
                self.cancel.cancel();
            }
            buffer.fill(0);
            Ok(buffer.len())
        }
    }

    #[test]
    fn an_endless_read_ends_where_it_is_given_up() {
        let cancel = Cancel::default();
        let endless = cancel.watch(GivesUp { reads: 3, cancel: cancel.clone() });
        let mut read = Vec::new();
        let error = BufReader::with_capacity(10, endless).read_to_end(&mut read).unwrap_err();
        assert!(is_cancelled(&error) && !is_cancelled(&io::Error::other("full")), "{error}");
        assert!(!read.is_empty());
    }
}
