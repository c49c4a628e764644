//! One line of the table: some views of a volume by a method.

use serde_json::{Value, json};

/// How views are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    /// Each by a cast.
    Each,
    /// From a few that are.
    Anchors,
}

impl Method {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Each => "each",
            Self::Anchors => "anchors",
        }
    }
}

pub(super) struct Row {
    pub(super) volume: String,
    pub(super) views: u32,
    pub(super) method: Method,
    pub(super) shading: String,
    pub(super) anchors: usize,
    pub(super) slabs: u32,
    /// Of the anchors' slabs.
    pub(super) bytes: u64,
    /// Time of casting the anchors.
    pub(super) anchors_ms: f64,
    /// Time of all views.
    pub(super) ms: f64,
    /// Pixels of all views.
    pub(super) rays: u64,
    /// The time of a cast for each view over this one.
    pub(super) speed_up: f64,
    /// DSSIM of each view, if it is not its own cast.
    pub(super) errors: Vec<f64>,
}

impl Row {
    fn mrays_per_s(&self) -> f64 {
        self.rays as f64 / self.ms / 1e3
    }

    fn dssim_mean(&self) -> f64 {
        self.errors.iter().fold(0.0, |sum, dssim| sum + dssim) / self.errors.len().max(1) as f64
    }

    fn dssim_worst(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "views": self.views,
            "method": self.method.name(),
            "shading": self.shading,
            "anchors": self.anchors,
            "slabs": self.slabs,
            "bytes": self.bytes,
            "anchor_ms": self.anchors_ms,
            "derived_ms": self.ms - self.anchors_ms,
            "ms_per_frame": self.ms,
            "views_per_s": f64::from(self.views) / self.ms * 1e3,
            "mrays_per_s": self.mrays_per_s(),
            "speedup": self.speed_up,
            "dssim_mean": self.dssim_mean(),
            "dssim_worst": self.dssim_worst(),
            "dssim": self.errors,
        })
    }
}

pub(super) fn to_table(rows: &[Row]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:>5} {:<12} {:<8} {:>7} {:>5} {:>6} {:>9} {:>10} {:>8} {:>7} {:>8} {:>10} {:>10}",
        "volume",
        "views",
        "shading",
        "method",
        "anchors",
        "slabs",
        "MB",
        "anchor ms",
        "ms",
        "views/s",
        "Mray/s",
        "speed-up",
        "DSSIM mean",
        "worst"
    )];
    for row in rows {
        lines.push(format!(
            "{:<14} {:>5} {:<12} {:<8} {:>7} {:>5} {:>6.1} {:>9.1} {:>10.1} {:>8.1} {:>7.1} {:>8.2} {:>10.5} {:>10.5}",
            row.volume,
            row.views,
            row.shading,
            row.method.name(),
            row.anchors,
            row.slabs,
            row.bytes as f64 / 1e6,
            row.anchors_ms,
            row.ms,
            f64::from(row.views) / row.ms * 1e3,
            row.mrays_per_s(),
            row.speed_up,
            row.dssim_mean(),
            row.dssim_worst(),
        ));
    }
    lines.join("\n")
}
