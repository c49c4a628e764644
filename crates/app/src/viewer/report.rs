//! What a run tells when it ends.

use super::latency::Latencies;
use super::memory::Held;
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Time between two looks at what is held.
const LOOK_EVERY: Duration = Duration::from_secs(1);

/// What has been measured.
#[derive(Debug)]
pub(crate) struct Report {
    begun: Instant,
    pub(crate) device: String,
    pub(crate) opened: Option<Duration>,
    pub(crate) first_picture: Option<Duration>,
    pub(crate) refreshes: Latencies,
    pub(crate) latencies: Latencies,
    pub(crate) failures: Vec<String>,
    held: Vec<Held>,
    looked: Instant,
}

impl Report {
    pub(crate) fn new(begun: Instant, device: String) -> Self {
        Self {
            begun,
            device,
            opened: None,
            first_picture: None,
            refreshes: Latencies::default(),
            latencies: Latencies::default(),
            failures: Vec::new(),
            held: Vec::new(),
            looked: begun,
        }
    }

    /// Something is shown: a window, and perhaps a volume in it.
    pub(crate) fn shown(&mut self, has_picture: bool, device: &wgpu::Device) {
        let since = self.begun.elapsed();
        self.opened.get_or_insert(since);
        if has_picture {
            self.first_picture.get_or_insert(since);
        }
        if self.looked.elapsed() >= LOOK_EVERY {
            self.looked = Instant::now();
            self.held.push(Held::now(device));
        }
    }

    /// One object.
    pub(crate) fn to_json(&self) -> Value {
        let milliseconds = |duration: Option<Duration>| duration.map(|duration| duration.as_secs_f64() * 1e3);
        json!({
            "device": self.device,
            "opened_ms": milliseconds(self.opened),
            "first_picture_ms": milliseconds(self.first_picture),
            "seconds": self.begun.elapsed().as_secs_f64(),
            "refresh_ms": self.refreshes.to_json(),
            "event_to_present_ms": self.latencies.to_json(),
            "held": self.held,
            "failures": self.failures,
        })
    }
}
