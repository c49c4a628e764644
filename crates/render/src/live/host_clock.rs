//! What pieces take by the host's clock.

use std::sync::{Arc, OnceLock};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

/// How often the device is asked whether it is done.
const POLL_PERIOD: Duration = Duration::from_micros(500);

/// Notes when a submission is done: once it is dropped, because wgpu drops a callback without calling it if a window cannot be
/// configured because another thread gives the device work.
#[derive(Debug)]
struct DoneWhenDropped(Arc<OnceLock<Instant>>);

impl Drop for DoneWhenDropped {
    fn drop(&mut self) {
        self.0.get_or_init(Instant::now);
    }
}

/// Submission to completion, in equal parts for all pieces; a thread watches the device meanwhile.
#[derive(Debug, Default)]
pub(super) struct HostClock {
    reading: Option<Reading>,
}

/// A submission that is being watched.
#[derive(Debug)]
struct Reading {
    pieces: usize,
    submitted: Instant,
    done: Arc<OnceLock<Instant>>,
}

impl HostClock {
    /// Begins to watch the last submission, for so long at most.
    pub(super) fn begin_reading(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        pieces: usize,
        most: Duration,
    ) {
        let submitted = Instant::now();
        let done = Arc::new(OnceLock::new());
        let on_done = DoneWhenDropped(Arc::clone(&done));
        queue.on_submitted_work_done(move || drop(on_done));
        let (watched, device) = (Arc::clone(&done), device.clone());
        #[expect(
            clippy::disallowed_methods,
            reason = "sleeps, which would keep one of rayon's workers from its work"
        )]
        spawn(move || {
            while submitted.elapsed() < most && watched.get().is_none() {
                if device.poll(wgpu::PollType::Poll).is_err() {
                    return;
                }
                sleep(POLL_PERIOD);
            }
        });
        self.reading = Some(Reading { pieces, submitted, done });
    }

    /// What the pieces took, seconds, once they are done.
    pub(super) fn read(&mut self) -> Option<Vec<f64>> {
        let reading = self.reading.take_if(|reading| reading.done.get().is_some())?;
        let taken = *reading.done.get()? - reading.submitted;
        Some(vec![taken.as_secs_f64() / reading.pieces as f64; reading.pieces])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_of_a_submission_is_shared_out() {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let mut clock = HostClock::default();
        assert_eq!(clock.read(), None);
        queue.submit([]);
        clock.begin_reading((&device, &queue), 3, Duration::from_secs(10));
        let start = Instant::now();
        let seconds = loop {
            if let Some(seconds) = clock.read() {
                break seconds;
            }
            assert!(start.elapsed() < Duration::from_secs(10));
            sleep(POLL_PERIOD);
        };
        assert_eq!(seconds, [seconds[0]; 3]);
        assert!(seconds[0] > 0.0 && 3.0 * seconds[0] <= start.elapsed().as_secs_f64() + 1.0);
        assert_eq!(clock.read(), None);
    }
}
