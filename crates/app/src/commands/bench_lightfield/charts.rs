//! Charts: what anchors save, how far their views are off, and how far what eyes see of projectors is.

use super::eyes::Walk;
use super::full_frame::FullFrame;
use super::row::{Method, Row};
use crate::failure::Failure;
use crate::output::file_in;
use crate::plot::{Labels, Line, even_chart};
use std::path::Path;

/// The speed-up over the number of views, for each volume.
pub(super) fn draw_speed_ups(folder: &Path, rows: &[Row]) -> Result<(), Failure> {
    for rows in rows.chunk_by(|a, b| a.volume == b.volume) {
        let of_shading = rows.chunk_by(|a, b| a.shading == b.shading);
        let lines: Vec<Line> = of_shading
            .map(|rows| Line {
                name: format!("{} shading", rows[0].shading),
                points: of_anchors(rows).map(|row| (f64::from(row.views), row.speed_up)).collect(),
            })
            .filter(|line| !line.points.is_empty())
            .collect();
        let title = format!("{}: views from anchors", rows[0].volume);
        let labels = Labels { title: &title, x: "views", y: "times faster than a cast for each" };
        draw(folder, &format!("{}-speed-up.svg", rows[0].volume), &labels, &lines)?;
    }
    Ok(())
}

/// The error of each view of the most that a volume was shown with.
pub(super) fn draw_errors(folder: &Path, rows: &[Row]) -> Result<(), Failure> {
    for rows in rows.chunk_by(|a, b| a.volume == b.volume) {
        let most = of_anchors(rows).map(|row| row.views).max();
        let lines: Vec<Line> = of_anchors(rows)
            .filter(|row| Some(row.views) == most)
            .map(|row| Line {
                name: format!("{} shading", row.shading),
                points: (0..).map(f64::from).zip(row.errors.iter().copied()).collect(),
            })
            .collect();
        let title = format!("{}: error of {} anchors", rows[0].volume, anchor_count(rows));
        let labels = Labels { title: &title, x: "view", y: "DSSIM" };
        draw(folder, &format!("{}-error.svg", rows[0].volume), &labels, &lines)?;
    }
    Ok(())
}

/// The error of what an eye sees of the full frame, over its place, for each volume and each of its walks.
pub(super) fn draw_eyes(folder: &Path, frames: &[FullFrame]) -> Result<(), Failure> {
    for frames in frames.chunk_by(|a, b| a.volume == b.volume) {
        let FullFrame { volume, projectors, size: [width, height], .. } = &frames[0];
        for walk in Walk::ALL {
            let (moved, x) = match walk {
                Walk::Up => ("up and down", "height above the middle of the screen, cm"),
                Walk::Sideways => ("to the sides", "to the right of the middle of the screen, cm"),
                Walk::Away => ("back and forth", "distance from the screen, cm"),
            };
            let title = format!("{volume} on {projectors} projectors of {width}x{height}: eye moved {moved}");
            let line = |frame: &FullFrame| Line {
                name: format!("{} resolution", frame.resolution),
                points: frame.on(walk).map(|sight| (walk.along_cm(sight.eye_m), sight.dssim)).collect(),
            };
            let lines: Vec<Line> = frames.iter().map(line).collect();
            let labels = Labels { title: &title, x, y: "DSSIM from a perspective view" };
            draw(folder, &format!("{volume}-eye-{}.svg", walk.name()), &labels, &lines)?;
        }
    }
    Ok(())
}

fn of_anchors(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows.iter().filter(|row| row.method == Method::Anchors)
}

/// How many the most views have.
fn anchor_count(rows: &[Row]) -> usize {
    of_anchors(rows).max_by_key(|row| row.views).map_or(0, |row| row.anchors)
}

fn draw(folder: &Path, name: &str, labels: &Labels<'_>, lines: &[Line]) -> Result<(), Failure> {
    if lines.is_empty() { Ok(()) } else { even_chart(&file_in(folder, name), labels, lines) }
}
