//! ParaView's colour maps: a JSON array of objects, as its colour-map editor exports them.

use super::normalise::{DataPoints, transfer_file};
use super::{MAX_TRANSFER_POINTS, TransferReadError};
use serde_json::Value;
use wheatstone_core::transfer::TransferFile;
use wheatstone_core::transfer::color_space::{mix_diverging, mix_hsv, mix_lab};

/// How many straight pieces stand for one segment that is curved in sRGB or in opacity.
const PIECES: usize = 32;

/// How a colour between two points is found.
#[derive(Debug, Clone, Copy, PartialEq)]
enum ColorSpace {
    Rgb,
    Lab,
    Diverging,
    Hsv { wrap: bool },
    Step,
}

/// The first colour map in a parsed file: an object with points, alone or in an array.
pub(super) fn find_map(file: &Value) -> Option<&Value> {
    let is_map = |value: &&Value| value.get("RGBPoints").is_some() || value.get("IndexedColors").is_some();
    match file {
        Value::Array(maps) => maps.iter().find(is_map),
        _ => Some(file).filter(is_map),
    }
}

pub(super) fn parse(map: &Value) -> Result<TransferFile, TransferReadError> {
    let rgb_points = map.get("RGBPoints").ok_or_else(|| {
        problem("holds indexed colours only (no RGBPoints): categories have no order to map values by")
    })?;
    if is_set(map, "UseLogScale") {
        return Err(problem("UseLogScale is set: maps over the logarithm of the value are not read"));
    }
    let mut nodes: Vec<(f64, [f64; 3])> =
        quadruples(rgb_points, "RGBPoints")?.into_iter().map(|[x, r, g, b]| (x, [r, g, b])).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let color = resample_color(&nodes, color_space(map)?);
    let mut opacity = match map.get("Points") {
        None | Some(Value::Null) => Vec::new(),
        Some(points) => quadruples(points, "Points")?,
    };
    opacity.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let opacity = if opacity.is_empty() { even_ramp(&nodes) } else { resample_opacity(&opacity) };
    transfer_file(DataPoints { color, opacity, gradient_opacity: Vec::new() })?
        .ok_or_else(|| problem("its points span no range of values"))
}

fn problem(problem: impl Into<String>) -> TransferReadError {
    TransferReadError::ParaView { problem: problem.into() }
}

/// Whether a switch, written as a boolean or a number, is on.
fn is_set(map: &Value, switch: &str) -> bool {
    match map.get(switch) {
        Some(Value::Bool(is_on)) => *is_on,
        Some(Value::Number(number)) => number.as_f64() != Some(0.0),
        _ => false,
    }
}

fn color_space(map: &Value) -> Result<ColorSpace, TransferReadError> {
    let wrap = is_set(map, "HSVWrap");
    match map.get("ColorSpace") {
        None => Ok(ColorSpace::Rgb),
        Some(Value::String(name)) => match name.as_str() {
            "RGB" => Ok(ColorSpace::Rgb),
            "Lab" | "CIELAB" | "Lab/CIEDE2000" => Ok(ColorSpace::Lab),
            "Diverging" => Ok(ColorSpace::Diverging),
            "HSV" => Ok(ColorSpace::Hsv { wrap }),
            "Step" => Ok(ColorSpace::Step),
            other => {
                Err(problem(format!("colour space {other:?} is not one of RGB, Lab, Diverging, HSV, Step")))
            }
        },
        Some(_) => Err(problem("ColorSpace is not a text")),
    }
}

/// Groups of four finite numbers.
fn quadruples(list: &Value, name: &str) -> Result<Vec<[f64; 4]>, TransferReadError> {
    let list = list.as_array().ok_or_else(|| problem(format!("{name} is not a list")))?;
    if list.is_empty() || list.len() % 4 != 0 {
        return Err(problem(format!("{name} holds {} numbers: not groups of four", list.len())));
    }
    if list.len() / 4 > MAX_TRANSFER_POINTS {
        return Err(problem(format!("{name} holds more than {MAX_TRANSFER_POINTS} points")));
    }
    let number = |index: usize| {
        list[index]
            .as_f64()
            .filter(|x| x.is_finite())
            .ok_or_else(|| problem(format!("{name}[{index}] is not a finite number")))
    };
    (0..list.len())
        .step_by(4)
        .map(|i| Ok([number(i)?, number(i + 1)?, number(i + 2)?, number(i + 3)?]))
        .collect()
}

/// Colour points that give in sRGB what the nodes give in their own space.
fn resample_color(nodes: &[(f64, [f64; 3])], space: ColorSpace) -> Vec<(f64, [f64; 3])> {
    let mix = |from: [f64; 3], to: [f64; 3], t: f64| match space {
        ColorSpace::Lab => mix_lab(from, to, t),
        ColorSpace::Diverging => mix_diverging(from, to, t),
        ColorSpace::Hsv { wrap } => mix_hsv(from, to, t, wrap),
        ColorSpace::Rgb | ColorSpace::Step => to,
    };
    let mut points = vec![nodes[0]];
    for pair in nodes.windows(2) {
        let ((x0, from), (x1, to)) = (pair[0], pair[1]);
        match space {
            ColorSpace::Rgb => {}
            // A segment has the colour of its upper end.
            ColorSpace::Step => points.push((x0, to)),
            _ => points.extend((1..PIECES).map(|i| {
                let t = i as f64 / PIECES as f64;
                (x0 + (x1 - x0) * t, mix(from, to, t))
            })),
        }
        points.push((x1, to));
    }
    points
}

/// From 0 at the first colour to 1 at the last, where a map has no opacity of its own.
fn even_ramp(nodes: &[(f64, [f64; 3])]) -> Vec<(f64, f64)> {
    vec![(nodes[0].0, 0.0), (nodes[nodes.len() - 1].0, 1.0)]
}

/// Opacity points from value, opacity, midpoint and sharpness of the segment that follows.
fn resample_opacity(nodes: &[[f64; 4]]) -> Vec<(f64, f64)> {
    let mut points = vec![(nodes[0][0], nodes[0][1])];
    for pair in nodes.windows(2) {
        let ([x0, from, midpoint, sharpness], [x1, to, ..]) = (pair[0], pair[1]);
        if sharpness > 0.99 {
            let middle = x0 + (x1 - x0) * midpoint.clamp(0.0, 1.0);
            points.extend([(middle, from), (middle, to)]);
        } else if sharpness > 0.01 || midpoint != 0.5 {
            points.extend((1..PIECES).map(|i| {
                let t = i as f64 / PIECES as f64;
                (x0 + (x1 - x0) * t, eased(from, to, t, midpoint, sharpness))
            }));
        }
        points.push((x1, to));
    }
    points
}

/// The curve of VTK's piecewise functions: linear for a sharpness of 0, a step for 1, passing half-way at the midpoint.
fn eased(from: f64, to: f64, t: f64, midpoint: f64, sharpness: f64) -> f64 {
    let midpoint = midpoint.clamp(1e-5, 1.0 - 1e-5);
    let mut s = if t < midpoint { 0.5 * t / midpoint } else { 0.5 + 0.5 * (t - midpoint) / (1.0 - midpoint) };
    if sharpness <= 0.01 {
        return from + (to - from) * s;
    }
    let exponent = 1.0 + 10.0 * sharpness;
    s = if s < 0.5 { 0.5 * (2.0 * s).powf(exponent) } else { 1.0 - 0.5 * (2.0 * (1.0 - s)).powf(exponent) };
    let (square, cube) = (s * s, s * s * s);
    let rise = 3.0 * square - 2.0 * cube;
    let tangents = (2.0 * cube - 3.0 * square + s) * (1.0 - sharpness) * (to - from);
    (from + (to - from) * rise + tangents).clamp(from.min(to), from.max(to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eased_segments_pass_half_way_at_their_midpoint() {
        for sharpness in [0.0, 0.3, 0.8] {
            assert!((eased(0.2, 0.8, 0.3, 0.3, sharpness) - 0.5).abs() < 1e-9, "{sharpness}");
            assert!(eased(0.2, 0.8, 0.1, 0.3, sharpness) < 0.5);
        }
        assert!((eased(0.0, 1.0, 0.25, 0.5, 0.0) - 0.25).abs() < 1e-12);
        assert!(eased(0.0, 1.0, 0.25, 0.5, 0.9) < 0.05, "a sharp segment stays at its start");
    }
}
