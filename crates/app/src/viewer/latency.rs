//! From an event to the refresh that shows it.

use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Times, ms.
#[derive(Debug, Default)]
pub(crate) struct Latencies {
    milliseconds: Vec<f64>,
}

impl Latencies {
    /// Events have been due at some time and are shown at another.
    pub(crate) fn record(&mut self, due: &[Instant], shown: Instant) {
        self.milliseconds.extend(due.iter().map(|&due| in_ms(shown.saturating_duration_since(due))));
    }

    /// A time of another kind.
    pub(crate) fn push(&mut self, duration: Duration) {
        self.milliseconds.push(in_ms(duration));
    }

    /// Count, median, 95th percentile and worst; `null` without any.
    pub(crate) fn to_json(&self) -> Value {
        let mut sorted = self.milliseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |part: f64| sorted.get(((sorted.len().max(1) - 1) as f64 * part).round() as usize);
        json!({ "count": sorted.len(), "median": at(0.5), "p95": at(0.95), "worst": sorted.last() })
    }
}

fn in_ms(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_of_all_events() {
        let mut latencies = Latencies::default();
        assert_eq!(latencies.to_json()["median"], Value::Null);
        let shown = Instant::now();
        let due: Vec<Instant> =
            (0..=100).filter_map(|ms| shown.checked_sub(Duration::from_millis(ms))).collect();
        latencies.record(&due, shown);
        let found = latencies.to_json();
        assert_eq!(found["count"], due.len());
        assert_eq!((found["median"].as_f64(), found["worst"].as_f64()), (Some(50.0), Some(100.0)));
    }
}
