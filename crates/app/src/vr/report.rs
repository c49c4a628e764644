//! What a session tells when it ends.

use super::check::{Checked, name};
use crate::viewer::state::EyeMethod;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::time::Duration;
use wheatstone_core::headset::{Late, Stand};

/// What has been measured.
#[derive(Debug, Default)]
pub(crate) struct Report {
    pub(crate) device: String,
    pub(crate) headset: String,
    /// Whether depths were given along with pictures.
    pub(crate) has_depth_layer: bool,
    pub(crate) volume: String,
    pub(crate) period_s: f64,
    pub(crate) late: Late,
    /// What was done before the first refresh.
    pub(crate) warm_up: Duration,
    /// With pictures, and without where the head was not tracked.
    pub(crate) refreshes: u64,
    pub(crate) draws: Vec<Duration>,
    /// Refreshes by the warp that showed them.
    pub(crate) warps: BTreeMap<&'static str, u32>,
    /// How the newest picture comes to both eyes.
    pub(crate) eye_method: EyeMethod,
    /// Whether one cast was asked for, which canted displays cannot have.
    pub(crate) is_canted: bool,
    /// Pictures of both eyes that were cast whole.
    pub(crate) pictures: u64,
    pub(crate) stand: Option<Stand>,
    /// What the left and the right hand pointed at last, in the file's unit.
    pub(crate) values_under_hands: [Option<f64>; 2],
    /// The view as it was left, in the form of saved views.
    pub(crate) view: Value,
    pub(crate) checked: Vec<Checked>,
    pub(crate) failures: Vec<String>,
    pub(crate) ended: String,
}

impl Report {
    /// Milliseconds that drawing took: the middle, 99 of 100, and the most.
    fn draw_ms(&self) -> Option<[f64; 3]> {
        let mut sorted = self.draws.clone();
        sorted.sort();
        let last = sorted.len().checked_sub(1)?;
        let at = |share: f64| 1e3 * sorted[(share * last as f64).round() as usize].as_secs_f64();
        Some([at(0.5), at(0.99), at(1.0)])
    }

    /// Mean and worst of a figure of the refreshes that were checked, by whether the eyes moved.
    fn of_checked(&self, moves: bool, figure: impl Fn(&Checked) -> Option<f64>) -> Option<[f64; 2]> {
        let of: Vec<f64> = self.checked.iter().filter(|c| c.moves == moves).filter_map(figure).collect();
        let worst = of.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        (!of.is_empty()).then(|| [of.iter().sum::<f64>() / of.len() as f64, worst])
    }

    /// One row.
    pub(crate) fn to_json(&self) -> Value {
        let [median, p99, most] = self.draw_ms().map_or([None; 3], |ms| ms.map(Some));
        let [moving, still] =
            [true, false].map(|moves| self.of_checked(moves, |checked| Some(checked.dssim)));
        let [covered_moving, covered_still] =
            [true, false].map(|moves| self.of_checked(moves, |checked| checked.dssim_covered));
        json!({
            "headset": self.headset,
            "depth_layer": self.has_depth_layer,
            "volume": self.volume,
            "period_ms": 1e3 * self.period_s,
            "refreshes": self.refreshes,
            "shown": self.late.total().shown,
            "dropped": self.late.total().dropped,
            "pictures": self.pictures,
            "warm_up_ms": 1e3 * self.warm_up.as_secs_f64(),
            "draw_ms_first": self.draws.first().map(|draw| 1e3 * draw.as_secs_f64()),
            "draw_ms_median": median,
            "draw_ms_p99": p99,
            "draw_ms_worst": most,
            "warps": self.warps,
            "dssim_moving_mean": moving.map(|of| of[0]),
            "dssim_moving_worst": moving.map(|of| of[1]),
            "dssim_still_mean": still.map(|of| of[0]),
            "dssim_still_worst": still.map(|of| of[1]),
            "dssim_covered_moving_mean": covered_moving.map(|of| of[0]),
            "dssim_covered_moving_worst": covered_moving.map(|of| of[1]),
            "dssim_covered_still_mean": covered_still.map(|of| of[0]),
            "dssim_covered_still_worst": covered_still.map(|of| of[1]),
            "checked": self.checked.iter().map(|checked| json!({
                "refresh": checked.refresh,
                "eye": name(checked.side),
                "moves": checked.moves,
                "dssim": checked.dssim,
                "dssim_covered": checked.dssim_covered,
                "resolution": checked.resolution,
            })).collect::<Vec<_>>(),
            "eye_method": self.eye_method,
            "canted": self.is_canted,
            "stand": self.stand.map(|stand| json!({
                "position_m": stand.pose.position_m.to_array(),
                "orientation": stand.pose.orientation.to_array(),
                "longest_side_m": stand.longest_side_m,
            })),
            "values_under_hands": self.values_under_hands,
            "view": self.view,
            "failures": self.failures,
            "ended": self.ended,
        })
    }

    /// Lines for people.
    pub(crate) fn to_lines(&self) -> String {
        let late = self.late.total();
        let mut lines = vec![
            format!("{} on {}, {}: {}", self.headset, self.device, self.volume, self.ended),
            format!(
                "{} refreshes of {:.1} ms; after the first second {} shown, {} dropped; {} pictures cast",
                self.refreshes,
                1e3 * self.period_s,
                late.shown,
                late.dropped,
                self.pictures
            ),
        ];
        if let Some([median, p99, most]) = self.draw_ms() {
            lines.push(format!(
                "drawing took {median:.1} ms (median), {p99:.1} ms (99 of 100), {most:.1} ms at most"
            ));
        }
        for (moves, what) in [(true, "moving"), (false, "still")] {
            let whole = self.of_checked(moves, |checked| Some(checked.dssim));
            let covered = self.of_checked(moves, |checked| checked.dssim_covered);
            for (figure, part) in [(whole, ""), (covered, " where the volume is")] {
                if let Some([mean, worst]) = figure {
                    lines.push(format!(
                        "DSSIM from direct renders{part}, {what}: mean {mean:.5}, worst {worst:.5}"
                    ));
                }
            }
        }
        lines.extend(self.failures.iter().map(|failure| format!("failed: {failure}")));
        lines.join("\n")
    }
}
