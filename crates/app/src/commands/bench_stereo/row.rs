//! One line of the table: a way to make pairs of a volume at a distance, with a shading.

use super::turn::Tally;
use crate::backend::median;
use crate::pairing::Pairing;
use crate::spec;
use serde_json::{Value, json};
use wheatstone_core::cast::CastParameters;

pub(super) struct Row {
    pub(super) volume: String,
    pub(super) distance_m: f64,
    pub(super) pairing: Pairing,
    pub(super) shading: String,
    pub(super) shading_samples: u32,
    left_ms: f64,
    right_ms: f64,
    pair_ms: f64,
    /// Speed-up: the part of the second cast that is saved (SP, VR Eq. 23), over the whole turn.
    pub(super) speed_up: f64,
    dssim: Spread,
    dssim_covered: Spread,
    bytes: u64,
    clear_ms: f64,
    composite_ms: f64,
    repair_ms: f64,
    reference_difference: f32,
}

/// Mean and worst of some frames.
struct Spread {
    mean: f64,
    worst: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Self {
        Self {
            mean: values.iter().sum::<f64>() / values.len() as f64,
            worst: values.iter().copied().fold(0.0, f64::max),
        }
    }
}

impl Row {
    pub(super) fn new(volume: &str, distance_m: f64, parameters: &CastParameters, tally: &Tally) -> Self {
        let [left, right, pair] =
            [&tally.left_ms, &tally.right_ms, &tally.pair_ms].map(|ms| ms.iter().sum::<f64>());
        Self {
            volume: volume.to_owned(),
            distance_m,
            pairing: tally.pairing,
            shading: spec::shading_name(parameters.shading),
            shading_samples: parameters.shading_samples(),
            left_ms: median(&tally.left_ms),
            right_ms: median(&tally.right_ms),
            pair_ms: median(&tally.pair_ms),
            speed_up: 1.0 - (pair - left) / right,
            dssim: Spread::of(&tally.dssim),
            dssim_covered: Spread::of(&tally.dssim_covered),
            bytes: tally.bytes,
            clear_ms: median(&tally.clear_ms),
            composite_ms: median(&tally.composite_ms),
            repair_ms: median(&tally.repair_ms),
            reference_difference: tally.reference_difference,
        }
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "distance_m": self.distance_m,
            "method": self.pairing.form.name(),
            "quality": self.pairing.quality.name(),
            "shading": self.shading,
            "shading_samples": self.shading_samples,
            "t_left_ms": self.left_ms,
            "t_right_ms": self.right_ms,
            "t_pair_ms": self.pair_ms,
            "v": self.speed_up,
            "dssim_mean": self.dssim.mean,
            "dssim_worst": self.dssim.worst,
            "dssim_covered_mean": self.dssim_covered.mean,
            "dssim_covered_worst": self.dssim_covered.worst,
            "bytes": self.bytes,
            "clear_ms": self.clear_ms,
            "composite_ms": self.composite_ms,
            "repair_ms": self.repair_ms,
            "reference_difference": self.reference_difference,
        })
    }
}

pub(super) fn to_table(rows: &[Row]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:>5} {:<10} {:<8} {:<14} {:>7} {:>8} {:>8} {:>8} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9} {:>7}",
        "volume",
        "m",
        "method",
        "quality",
        "shading",
        "samples",
        "left ms",
        "right ms",
        "pair ms",
        "V",
        "DSSIM",
        "worst",
        "covered",
        "worst",
        "clear ms",
        "comp. ms",
        "rep. ms",
        "KiB",
        "ref."
    )];
    for row in rows {
        lines.push(format!(
            "{:<14} {:>5.2} {:<10} {:<8} {:<14} {:>7} {:>8.1} {:>8.1} {:>8.1} {:>6.2} {:>8.5} {:>8.5} {:>8.5} {:>8.5} {:>8.1} {:>8.1} {:>8.1} {:>9.0} {:>7.4}",
            row.volume,
            row.distance_m,
            row.pairing.form.name(),
            row.pairing.quality.name(),
            row.shading,
            row.shading_samples,
            row.left_ms,
            row.right_ms,
            row.pair_ms,
            row.speed_up,
            row.dssim.mean,
            row.dssim.worst,
            row.dssim_covered.mean,
            row.dssim_covered.worst,
            row.clear_ms,
            row.composite_ms,
            row.repair_ms,
            row.bytes as f64 / 1024.0,
            row.reference_difference,
        ));
    }
    lines.join("\n")
}
