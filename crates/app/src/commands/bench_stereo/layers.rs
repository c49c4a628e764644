//! Clearing and compositing over the number of layers (SP Fig. 11, VR Fig. 17).

use super::eyes::Eyes;
use crate::backend::{Engine, Shot, Underived, median, milliseconds};
use crate::failure::Failure;
use crate::pairing::Pairing;
use crate::progress::Bar;
use serde_json::{Value, json};

/// What is made.
pub(super) struct Sweep<'a> {
    pub(super) volume: &'a str,
    pub(super) eyes: Eyes,
    /// How often each pair is made, after one that does not count.
    pub(super) frames: u32,
}

/// One line of the table.
pub(super) struct LayersRow {
    pub(super) volume: String,
    pub(super) pairing: Pairing,
    /// Width and height of a picture, pixels.
    pub(super) side: u32,
    pub(super) layers: u32,
    distance_m: f64,
    pub(super) clear_ms: f64,
    pub(super) composite_ms: f64,
    bytes: u64,
}

/// Numbers of layers that are measured.
pub(super) fn counts() -> impl Iterator<Item = u32> {
    (16..=64).step_by(8)
}

/// Makes pairs by each pairing from the distances at which a volume takes each number of layers. Pairings that are refused
/// have no row.
pub(super) fn measure(
    engine: &mut Engine<'_>,
    shot: Shot,
    sweep: &Sweep<'_>,
    pairings: &[Pairing],
    bar: &Bar,
) -> Result<Vec<LayersRow>, Failure> {
    let Sweep { volume, eyes, frames } = sweep;
    let mut rows = Vec::new();
    for layers in counts() {
        let distance_m = eyes.nearest_distance_m(layers)?;
        let views = eyes.views(distance_m, 0.0)?;
        for &pairing in pairings {
            let reports =
                (0..=*frames).map(|_| engine.cast_pair(shot, views, &pairing).map(|pair| pair.report));
            match reports.collect::<Result<Vec<_>, _>>() {
                Ok(reports) => {
                    let timed = &reports[1..];
                    let median_ms = |ms: Vec<f64>| median(&ms);
                    rows.push(LayersRow {
                        volume: (*volume).to_owned(),
                        pairing,
                        side: eyes.size[0],
                        layers,
                        distance_m,
                        clear_ms: median_ms(timed.iter().map(|r| milliseconds(r.clear)).collect()),
                        composite_ms: median_ms(timed.iter().map(|r| milliseconds(r.composite)).collect()),
                        bytes: reports[0].bytes,
                    });
                }
                Err(Underived::Refused(why)) => {
                    let (side, form) = (eyes.size[0], pairing.form.name());
                    eprintln!("note: {volume} at {side}², {layers} layers: {form} refuses ({why}): left out");
                }
                Err(Underived::Gpu(error)) => return Err(error.into()),
            }
        }
        bar.advance();
    }
    Ok(rows)
}

impl LayersRow {
    pub(super) fn to_json(&self) -> Value {
        json!({
            "volume": self.volume,
            "method": self.pairing.form.name(),
            "quality": self.pairing.quality.name(),
            "side": self.side,
            "layers": self.layers,
            "distance_m": self.distance_m,
            "clear_ms": self.clear_ms,
            "composite_ms": self.composite_ms,
            "bytes": self.bytes,
        })
    }
}

pub(super) fn to_table(rows: &[LayersRow]) -> String {
    let mut lines = vec![format!(
        "{:<14} {:<9} {:<8} {:>5} {:>6} {:>6} {:>9} {:>9} {:>9}",
        "volume", "method", "quality", "side", "layers", "m", "clear ms", "comp. ms", "KiB"
    )];
    for row in rows {
        lines.push(format!(
            "{:<14} {:<9} {:<8} {:>5} {:>6} {:>6.3} {:>9.2} {:>9.2} {:>9.0}",
            row.volume,
            row.pairing.form.name(),
            row.pairing.quality.name(),
            row.side,
            row.layers,
            row.distance_m,
            row.clear_ms,
            row.composite_ms,
            row.bytes as f64 / 1024.0,
        ));
    }
    lines.join("\n")
}
