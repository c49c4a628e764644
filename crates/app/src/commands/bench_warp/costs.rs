//! What warps cost beside casts of the same view.

use super::motion::{Extent, MotionName};
use super::source::Camera;
use super::warp::WarpName;
use crate::backend::{Shot, median, milliseconds};
use crate::failure::Failure;
use serde_json::{Value, json};
use wheatstone_core::head::Pose;
use wheatstone_core::view::View;

/// Rounds in which everything is timed once, after one that is not.
const ROUNDS: usize = 15;

/// Age of the picture that is warped: five refreshes at 90 Hz.
const AGE_S: f64 = 5.0 / 90.0;

/// Median times of a volume, milliseconds.
pub(super) struct Costs {
    volume: String,
    /// A cast as the settings ask for, unshaded and lit with shadows.
    casts_ms: [f64; 2],
    /// A cast that keeps what warps need, and finding the depths of its layers.
    begins_ms: [f64; 2],
    warps_ms: Vec<(WarpName, f64)>,
}

/// What is timed.
pub(super) struct Timed<'a> {
    pub(super) volume: &'a str,
    /// Casts of the volume unshaded and with shadows.
    pub(super) shots: [Shot; 2],
    pub(super) middle: &'a View,
    pub(super) extent: Extent,
    pub(super) warps: &'a [WarpName],
}

/// Times casts and warps of the middle of a motion, where the head is fastest, one after the other in rounds.
pub(super) fn measure(timed: &Timed<'_>, camera: &mut Camera<'_, '_>) -> Result<Costs, Failure> {
    let motion = MotionName::Both.about(Pose::of(timed.middle), timed.extent)?;
    let at = |time_s| motion.eyes_at(time_s).view(timed.middle);
    let middle_s = 0.5 * motion.duration_s();
    let (shown, wanted) = (at(middle_s - AGE_S), at(middle_s));
    let mut casts_ms = [const { Vec::new() }; 2];
    let mut begins_ms = [const { Vec::new() }; 2];
    let mut warps_ms: Vec<(WarpName, Vec<f64>)> =
        timed.warps.iter().map(|&warp| (warp, Vec::new())).collect();
    for round in 0..=ROUNDS {
        let note = |times: &mut Vec<f64>, time| {
            if round > 0 {
                times.push(milliseconds(time));
            }
        };
        for (&shot, times) in timed.shots.iter().zip(&mut casts_ms) {
            note(times, camera.engine.cast(shot, &[wanted])?);
        }
        let begun = camera.begin(shown)?;
        note(&mut begins_ms[0], begun.cast);
        note(&mut begins_ms[1], begun.depths);
        for (warp, times) in &mut warps_ms {
            note(times, camera.warp(*warp, &wanted)?);
        }
    }
    Ok(Costs {
        volume: timed.volume.to_owned(),
        casts_ms: casts_ms.each_ref().map(|times| median(times)),
        begins_ms: begins_ms.each_ref().map(|times| median(times)),
        warps_ms: warps_ms.iter().map(|(warp, times)| (*warp, median(times))).collect(),
    })
}

impl Costs {
    /// What was timed and its time, milliseconds.
    fn rows(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let [unshaded, shadow] = self.casts_ms;
        let [source, depths] = self.begins_ms;
        let casts =
            [("cast", unshaded), ("cast, shadows", shadow), ("cast to warp", source), ("depths", depths)];
        casts.into_iter().chain(self.warps_ms.iter().map(|(warp, ms)| (warp.name(), *ms)))
    }

    pub(super) fn to_json(&self) -> Vec<Value> {
        let [unshaded, shadow] = self.casts_ms;
        let row = |(what, ms): (&str, f64)| {
            json!({
                "volume": self.volume, "what": what, "ms": ms,
                "of_cast": ms / unshaded, "of_shadow_cast": ms / shadow,
            })
        };
        self.rows().map(row).collect()
    }
}

pub(super) fn to_table(costs: &[Costs]) -> String {
    let mut lines =
        vec![format!("{:<14} {:<14} {:>8} {:>8} {:>11}", "volume", "what", "ms", "/ cast", "/ shadows")];
    for of_volume in costs {
        let [unshaded, shadow] = of_volume.casts_ms;
        for (what, ms) in of_volume.rows() {
            lines.push(format!(
                "{:<14} {:<14} {:>8.2} {:>8.3} {:>11.4}",
                of_volume.volume,
                what,
                ms,
                ms / unshaded,
                ms / shadow
            ));
        }
    }
    lines.join("\n")
}
