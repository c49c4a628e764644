//! 3D Slicer's volume properties (`.vp`): nine lines of numbers.
//!
//! Interpolation, shading, diffuse, ambient, specular and specular power, then scalar opacity, gradient opacity and
//! colour, each as the count of the numbers that follow and the numbers themselves. Values are data values (HU for CT).
//! Slicer takes opacities per spacing of the volume and gradients per spacing too, so both carry over.

use super::normalise::{DataPoints, transfer_file};
use super::{MAX_TRANSFER_POINTS, TransferReadError};
use wheatstone_core::transfer::TransferFile;

/// Line numbers, from 1.
const SCALAR_OPACITY: usize = 7;
const GRADIENT_OPACITY: usize = 8;
const COLOR: usize = 9;

/// Whether a text starts as these files do: six lines of one number each, and no further one, which is a list.
pub(super) fn is_volume_property(text: &str) -> bool {
    let is_number = |line: &str| line.trim().parse::<f64>().is_ok_and(f64::is_finite);
    let mut lines = text.lines();
    lines.by_ref().take(SCALAR_OPACITY - 1).filter(|line| is_number(line)).count() == SCALAR_OPACITY - 1
        && lines.next().is_none_or(|line| line.split_whitespace().count() != 1)
}

pub(super) fn parse(text: &str) -> Result<TransferFile, TransferReadError> {
    let lines: Vec<&str> = text.lines().take(COLOR).collect();
    let points = DataPoints {
        opacity: points::<2>(&lines, SCALAR_OPACITY)?.into_iter().map(|[x, alpha]| (x, alpha)).collect(),
        gradient_opacity: points::<2>(&lines, GRADIENT_OPACITY)?.into_iter().map(|[g, f]| (g, f)).collect(),
        color: points::<4>(&lines, COLOR)?.into_iter().map(|[x, r, g, b]| (x, [r, g, b])).collect(),
    };
    for (line, empty) in [(SCALAR_OPACITY, points.opacity.is_empty()), (COLOR, points.color.is_empty())] {
        if empty {
            return Err(problem(line, "no points"));
        }
    }
    transfer_file(points)?.ok_or_else(|| problem(SCALAR_OPACITY, "the points span no range of values"))
}

fn problem(line: usize, problem: impl Into<String>) -> TransferReadError {
    TransferReadError::Slicer { line, problem: problem.into() }
}

fn line_at<'a>(lines: &[&'a str], line: usize) -> Result<&'a str, TransferReadError> {
    lines.get(line - 1).copied().ok_or_else(|| problem(line, "missing"))
}

/// Points of `N` numbers each, from a line that starts with the count of all numbers.
fn points<const N: usize>(lines: &[&str], line: usize) -> Result<Vec<[f64; N]>, TransferReadError> {
    let mut words = line_at(lines, line)?.split_whitespace();
    let count = words
        .next()
        .and_then(|word| word.parse::<usize>().ok())
        .ok_or_else(|| problem(line, "a count of numbers is expected first"))?;
    if count % N != 0 || count / N > MAX_TRANSFER_POINTS {
        return Err(problem(line, format!("{count} numbers: not up to {MAX_TRANSFER_POINTS} groups of {N}")));
    }
    let mut numbers = Vec::new();
    for word in words.take(count) {
        let number = word.parse::<f64>().ok().filter(|x| x.is_finite());
        numbers.push(number.ok_or_else(|| problem(line, format!("{word:?} is not a finite number")))?);
    }
    if numbers.len() < count {
        return Err(problem(line, format!("{} of {count} numbers are there", numbers.len())));
    }
    Ok(numbers.as_chunks::<N>().0.to_vec())
}
