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
    /// How far the eyes have turned from where the displayed picture was cast for, and moved, at each refresh: degrees and
    /// millimetres.
    pub(super) pose_off: Vec<[f64; 2]>,
    pub(super) worst: Option<Worst>,
}

/// The refresh of the motion at which what is displayed is furthest off in the mean over the warps.
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

    /// The furthest that the eyes have turned from where the displayed picture was cast for, and moved.
    fn pose_off_worst(&self) -> [f64; 2] {
        [0, 1].map(|part| self.pose_off.iter().map(|off| off[part]).fold(0.0, f64::max))
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
            "turn_off_deg_worst": self.pose_off_worst()[0],
            "way_off_mm_worst": self.pose_off_worst()[1],
            "trace": self.dssim,
            "pose_off_trace": self.pose_off,
        })
    }
}

pub(super) fn to_table(traces: &[Trace]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:<12} {:<10} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>6} {:>6}",
        "volume",
        "motion",
        "warp",
        "DSSIM",
        "worst",
        "drop",
        "warp ms",
        "cast ms",
        "missed",
        "off °",
        "off mm"
    )];
    for trace in traces {
        let [turn_deg, way_mm] = trace.pose_off_worst();
        lines.push(format!(
            "{:<14} {:<12} {:<10} {:>8.5} {:>8.5} {:>8.5} {:>8.2} {:>8.2} {:>6} {:>6.2} {:>6.1}",
            trace.volume,
            trace.motion.name(),
            trace.warp.name(),
            trace.mean(),
            trace.worst(),
            trace.largest_drop(),
            median(&trace.warp_ms),
            median(&trace.cast_ms),
            trace.missed,
            turn_deg,
            way_mm,
        ));
    }
    lines.join("\n")
}
