//! Charts as SVG.

use crate::failure::Failure;
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use std::path::Path;
use wheatstone_io::write_atomically;

const SIZE: (u32, u32) = (640, 420);

/// Colours that all eyes tell apart (Okabe and Ito 2008).
const COLORS: [RGBColor; 7] = [
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(90, 90, 90),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Most numbers at the horizontal axis.
const MOST_TICKS: usize = 9;

/// Names of a chart and its axes.
pub(crate) struct Labels<'a> {
    pub(crate) title: &'a str,
    pub(crate) x: &'a str,
    pub(crate) y: &'a str,
}

/// A line with a name.
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) points: Vec<(f64, f64)>,
}

/// Part of a chart's height that the name of a line takes.
const NAME_HEIGHT: f64 = 0.08;

/// Draws lines over even axes, with room for their names above; the vertical one has 0 in it.
pub(crate) fn even_chart(path: &Path, labels: &Labels<'_>, lines: &[Line]) -> Result<(), Failure> {
    let (lowest, highest) = span(lines, |point| point.1);
    let room = 1.1 + NAME_HEIGHT * lines.len() as f64;
    let y = 1.1 * lowest.min(0.0)..room * highest.max(f64::EPSILON);
    write_chart(path, labels, lines, y, SeriesLabelPosition::UpperRight)
}

/// Draws lines over a logarithmic vertical axis, with room for their names below.
pub(crate) fn logarithmic_chart(path: &Path, labels: &Labels<'_>, lines: &[Line]) -> Result<(), Failure> {
    let (lowest, highest) = span(lines, |point| point.1);
    let y = (0.2 * lowest..1.5 * highest).log_scale();
    write_chart(path, labels, lines, y, SeriesLabelPosition::LowerRight)
}

fn write_chart<Y>(
    path: &Path,
    labels: &Labels<'_>,
    lines: &[Line],
    y: Y,
    names: SeriesLabelPosition,
) -> Result<(), Failure>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let mut svg = String::new();
    draw(&mut svg, labels, lines, y, names)
        .map_err(|error| anyhow::anyhow!("cannot draw {}: {error}", path.display()))?;
    write_atomically(path, |writer| writer.write_all(svg.as_bytes()))?;
    Ok(())
}

fn draw<Y>(
    svg: &mut String,
    labels: &Labels<'_>,
    lines: &[Line],
    y: Y,
    names: SeriesLabelPosition,
) -> Result<(), Box<dyn std::error::Error>>
where
    Y: AsRangedCoord<Value = f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let root = SVGBackend::with_string(svg, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (left, right) = span(lines, |point| point.0);
    let mut chart = ChartBuilder::on(&root)
        .caption(labels.title, ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(60)
        .build_cartesian_2d(left - 0.2..right + 0.2, y)?;
    let ticks = ((right - left) as usize + 1).min(MOST_TICKS);
    chart
        .configure_mesh()
        .x_desc(labels.x)
        .y_desc(labels.y)
        .x_labels(ticks)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .light_line_style(TRANSPARENT)
        .draw()?;
    for (i, Line { name, points }) in lines.iter().enumerate() {
        let color = COLORS[i % COLORS.len()].stroke_width(2);
        chart
            .draw_series(LineSeries::new(points.iter().copied(), color).point_size(3))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color));
    }
    chart
        .configure_series_labels()
        .position(names)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    drop(chart);
    Ok(())
}

/// The smallest and the largest coordinate of all points.
fn span(lines: &[Line], coordinate: fn(&(f64, f64)) -> f64) -> (f64, f64) {
    let all = lines.iter().flat_map(|line| &line.points).map(coordinate);
    all.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| (lo.min(x), hi.max(x)))
}
