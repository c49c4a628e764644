//! What a warp has shown during a motion.

use super::motion::MotionName;
use super::warp::WarpName;
use crate::backend::median;
use serde_json::{Value, json};
use wheatstone_core::head::Display;
use wheatstone_core::image::RgbImage;
use wheatstone_core::metrics::SsimMap;

/// One line of the table, and the chart of it.
pub(super) struct Trace {
    pub(super) volume: String,
    pub(super) motion: MotionName,
    pub(super) display: Display,
    pub(super) warp: WarpName,
    /// Of what is displayed at each refresh from a true render.
    pub(super) dssim: Vec<f64>,
    pub(super) warp_ms: Vec<f64>,
    /// Of true renders.
    pub(super) cast_ms: Vec<f64>,
    pub(super) missed: usize,
    pub(super) worst: Option<Worst>,
}

/// The refresh at which what is displayed is furthest off.
pub(super) struct Worst {
    pub(super) refresh: usize,
    pub(super) displayed: RgbImage,
    pub(super) truth: RgbImage,
    pub(super) ssim: SsimMap,
}

impl Trace {
    fn mean(&self) -> f64 {
        self.dssim.iter().sum::<f64>() / self.dssim.len() as f64
    }

    fn worst(&self) -> f64 {
        self.dssim.iter().copied().fold(0.0, f64::max)
    }

    /// The largest fall from one refresh to the next: a picture that suddenly jumps to where it belongs.
    fn largest_drop(&self) -> f64 {
        self.dssim.windows(2).map(|pair| pair[0] - pair[1]).fold(0.0, f64::max)
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "motion": self.motion.name(),
            "warp": self.warp.name(),
            "dssim_mean": self.mean(),
            "dssim_worst": self.worst(),
            "drop_worst": self.largest_drop(),
            "warp_ms": median(&self.warp_ms),
            "cast_ms": median(&self.cast_ms),
            "missed": self.missed,
            "trace": self.dssim,
        })
    }
}

pub(super) fn to_table(traces: &[Trace]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:<12} {:<10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6}",
        "volume", "motion", "warp", "DSSIM", "worst", "drop", "warp ms", "cast ms", "missed"
    )];
    for trace in traces {
        lines.push(format!(
            "{:<14} {:<12} {:<10} {:>8.5} {:>8.5} {:>8.5} {:>8.2} {:>8.2} {:>6}",
            trace.volume,
            trace.motion.name(),
            trace.warp.name(),
            trace.mean(),
            trace.worst(),
            trace.largest_drop(),
            median(&trace.warp_ms),
            median(&trace.cast_ms),
            trace.missed,
        ));
    }
    lines.join("\n")
}
