//! Work in the background, with its progress.

use crate::failure::Failure;
use std::io;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, TryRecvError, channel};
use std::thread;
use wheatstone_io::Cancel;

/// Wakes the window when there is news.
pub(crate) type Waker = Arc<dyn Fn() + Send + Sync>;

/// How far a job is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Progress {
    /// What it is at.
    pub(crate) what: &'static str,
    /// Part that is done; none where that is not known.
    pub(crate) done: Option<f32>,
}

/// What a job tells with, and is told by that it has been given up.
pub(crate) struct Teller<T> {
    news: Sender<News<T>>,
    wake: Waker,
    cancel: Cancel,
}

impl<T> Teller<T> {
    /// How far it is. A listener that has gone away is none.
    pub(crate) fn tell(&self, what: &'static str, done: Option<f32>) {
        self.send(News::Progress(Progress { what, done }));
    }

    /// What the job has to look at every now and then.
    pub(crate) fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    fn send(&self, news: News<T>) {
        if self.news.send(news).is_ok() {
            (self.wake)();
        }
    }
}

enum News<T> {
    Progress(Progress),
    Done(Result<T, Failure>),
}

/// Work in a thread of its own. One that is dropped is given up, and goes on unheard until it looks.
pub(crate) struct Job<T> {
    news: Receiver<News<T>>,
    progress: Progress,
    cancel: Cancel,
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.cancel.cancel();
    }
}

impl<T: Send + 'static> Job<T> {
    /// Begins.
    pub(crate) fn begin(
        what: &'static str,
        wake: Waker,
        work: impl FnOnce(&Teller<T>) -> Result<T, Failure> + Send + 'static,
    ) -> io::Result<Self> {
        let (sender, news) = channel();
        let cancel = Cancel::default();
        let teller = Teller { news: sender, wake, cancel: cancel.clone() };
        thread::Builder::new().name(what.to_owned()).spawn(move || {
            let outcome = work(&teller);
            teller.send(News::Done(outcome));
        })?;
        Ok(Self { news, progress: Progress { what, done: None }, cancel })
    }

    /// How far it is, as far as [`Job::poll`] has heard.
    pub(crate) fn progress(&self) -> Progress {
        self.progress
    }

    /// What has become of it, once.
    pub(crate) fn poll(&mut self) -> Option<Result<T, Failure>> {
        loop {
            match self.news.try_recv() {
                Ok(News::Progress(progress)) => self.progress = progress,
                Ok(News::Done(outcome)) => return Some(outcome),
                Err(TryRecvError::Empty) => return None,
                Err(TryRecvError::Disconnected) => {
                    return Some(Err(Failure::Internal(anyhow::anyhow!(
                        "{} ended without a result",
                        self.progress.what
                    ))));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn outcome<T: Send + 'static>(mut job: Job<T>) -> (Progress, Result<T, Failure>) {
        loop {
            if let Some(outcome) = job.poll() {
                return (job.progress(), outcome);
            }
            thread::yield_now();
        }
    }

    #[test]
    fn a_job_tells_how_far_it_is_and_what_it_has_made() {
        let wakes = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&wakes);
        let wake: Waker = Arc::new(move || {
            counted.fetch_add(1, Ordering::SeqCst);
        });
        let job = Job::begin("counting", wake, |teller| {
            teller.tell("half", Some(0.5));
            Ok(7)
        });
        let (progress, made) = outcome(job.unwrap());
        assert_eq!((progress.what, progress.done), ("half", Some(0.5)));
        assert_eq!(made.unwrap(), 7);
        while wakes.load(Ordering::SeqCst) < 2 {
            thread::yield_now();
        }
    }

    #[test]
    fn a_job_that_is_dropped_is_told() {
        let (sender, ended) = channel();
        let job = Job::begin("waiting", Arc::new(|| {}), move |teller| {
            while !teller.cancel().is_cancelled() {
                thread::yield_now();
            }
            sender.send(()).unwrap();
            Ok(())
        });
        drop(job.unwrap());
        ended.recv().unwrap();
    }

    #[test]
    fn a_job_that_panics_has_failed() {
        let job = Job::<()>::begin("falling", Arc::new(|| {}), |_| panic!("on purpose"));
        assert!(outcome(job.unwrap()).1.unwrap_err().to_string().contains("falling"));
    }
}
