//! The charts of SP Fig. 10 and 11 (VR Fig. 16 and 17).

use super::layers::LayersRow;
use super::row::Row;
use crate::failure::Failure;
use crate::output::file_in;
use crate::pairing::Pairing;
use crate::plot::{Labels, Line, even_chart};
use std::path::Path;

/// The speed-up over the samples of shading, for each volume and distance.
pub(super) fn draw_speed_ups(folder: &Path, rows: &[Row]) -> Result<(), Failure> {
    for rows in rows.chunk_by(|a, b| (&a.volume, a.distance_m) == (&b.volume, b.distance_m)) {
        let [Row { volume, distance_m, .. }, ..] = rows else { continue };
        let mut lines: Vec<(Pairing, Line)> = Vec::new();
        for row in rows {
            let point = (f64::from(row.shading_samples), row.speed_up);
            match lines.iter_mut().find(|(pairing, _)| *pairing == row.pairing) {
                Some((_, line)) => line.points.push(point),
                None => lines.push((row.pairing, Line { name: name(&row.pairing), points: vec![point] })),
            }
        }
        let lines: Vec<Line> = lines.into_iter().map(|(_, line)| line).collect();
        even_chart(
            &file_in(folder, &format!("{volume}-{distance_m:.2}-speed-up.svg")),
            &Labels {
                title: &format!("{volume} at {distance_m:.2} m"),
                x: "samples of shading",
                y: "speed-up V",
            },
            &lines,
        )?;
    }
    Ok(())
}

/// Times of clearing and compositing over the number of layers, for each volume and pairing.
pub(super) fn draw_layers(folder: &Path, rows: &[LayersRow]) -> Result<(), Failure> {
    let mut drawn: Vec<(&str, Pairing)> = Vec::new();
    for row in rows {
        let chart = (row.volume.as_str(), row.pairing);
        if drawn.contains(&chart) {
            continue;
        }
        drawn.push(chart);
        let of_chart: Vec<&LayersRow> =
            rows.iter().filter(|row| (row.volume.as_str(), row.pairing) == chart).collect();
        let mut lines = Vec::new();
        for of_side in of_chart.chunk_by(|a, b| a.side == b.side) {
            let line = |what: &str, ms: fn(&LayersRow) -> f64| Line {
                name: format!("{what}, {}²", of_side[0].side),
                points: of_side.iter().map(|row| (f64::from(row.layers), ms(row))).collect(),
            };
            lines.extend([line("clear", |row| row.clear_ms), line("composite", |row| row.composite_ms)]);
        }
        let (volume, pairing) = chart;
        let method = name(&pairing);
        even_chart(
            &file_in(folder, &format!("{volume}-{method}-layers.svg")),
            &Labels { title: &format!("{volume}, {method}"), x: "layers", y: "time (ms)" },
            &lines,
        )?;
    }
    Ok(())
}

fn name(pairing: &Pairing) -> String {
    format!("{} {}", pairing.form.name(), pairing.quality.name())
}
