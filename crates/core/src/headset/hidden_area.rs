//! What lenses hide.

use crate::view::{Frustum, PixelRect};
use std::ops::Range;

/// Rows of pixels that are drawn together: fewer fit what is hidden better, and are more draws.
const BAND_ROWS: u32 = 16;

/// How far within a pixel its edges are looked at, pixels: what ends between two pixels hides the one before, whatever its rounding.
const WITHIN_PX: f64 = 0.02;

/// The part of an eye's picture that cannot be seen, as triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HiddenArea {
    /// Corners: x / −z and y / −z in the eye's view space, as the tangents of a [`Frustum`].
    pub corners: Vec<[f32; 2]>,
    /// Indices of the corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

impl HiddenArea {
    /// The pixels of a picture of a frustum, of some width and height, that can be seen, and those next to them, between which
    /// interpolation reaches: rectangles, one below the other. What is hidden only between pixels that can be seen is among them.
    ///
    /// # Panics
    /// If a triangle has a corner that there is not.
    pub fn visible(&self, frustum: &Frustum, [width, height]: [u32; 2]) -> Vec<PixelRect> {
        if self.triangles.is_empty() {
            return vec![PixelRect { columns: 0..width, rows: 0..height }];
        }
        let scale = [
            f64::from(width) / (frustum.right - frustum.left),
            f64::from(height) / (frustum.up - frustum.down),
        ];
        let pixel = |corner: u32| {
            let [x, y] = self.corners[corner as usize].map(f64::from);
            [(x - frustum.left) * scale[0], (frustum.up - y) * scale[1]]
        };
        let triangles: Vec<_> = self.triangles.iter().map(|triangle| triangle.map(pixel)).collect();
        let in_rows = (0..height).map(|row| {
            let edges = [f64::from(row) + WITHIN_PX, f64::from(row + 1) - WITHIN_PX];
            let [upper, lower] = edges.map(|y| visible_at(y, &triangles, width));
            hull(upper, lower)
        });
        let in_rows: Vec<Range<u32>> = in_rows.collect();
        let mut rects: Vec<PixelRect> = Vec::new();
        for first in (0..height).step_by(BAND_ROWS as usize) {
            let rows = first..(first + BAND_ROWS).min(height);
            let about = rows.start.saturating_sub(1) as usize..(rows.end + 1).min(height) as usize;
            let seen = in_rows[about].iter().cloned().fold(0..0, hull);
            if seen.is_empty() {
                continue;
            }
            let columns = seen.start.saturating_sub(1)..(seen.end + 1).min(width);
            match rects.last_mut() {
                Some(last) if last.columns == columns && last.rows.end == rows.start => {
                    last.rows.end = rows.end;
                }
                _ => rects.push(PixelRect { columns, rows }),
            }
        }
        rects
    }
}

/// Columns of which something can be seen along a line across the picture, pixels: all between the outermost.
fn visible_at(y: f64, triangles: &[[[f64; 2]; 3]], width: u32) -> Range<u32> {
    let mut hidden: Vec<[f64; 2]> = triangles.iter().filter_map(|triangle| crossing(y, triangle)).collect();
    hidden.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut left = 0.0;
    for [from, to] in &hidden {
        if *from <= left + WITHIN_PX {
            left = to.max(left);
        }
    }
    let mut right = f64::from(width);
    hidden.sort_by(|a, b| b[1].total_cmp(&a[1]));
    for [from, to] in &hidden {
        if *to >= right - WITHIN_PX {
            right = from.min(right);
        }
    }
    // A cast to an integer keeps within its bounds.
    let (start, end) = ((left + WITHIN_PX).floor() as u32, (right - WITHIN_PX).ceil() as u32);
    if start < end { start..end } else { 0..0 }
}

/// Where a line across the picture is in a triangle.
fn crossing(y: f64, triangle: &[[f64; 2]; 3]) -> Option<[f64; 2]> {
    let at = |edge: usize| {
        let [[x0, y0], [x1, y1]] = [triangle[edge], triangle[(edge + 1) % 3]];
        let is_crossed = y0.min(y1) <= y && y <= y0.max(y1) && y0 != y1;
        is_crossed.then(|| x0 + (y - y0) / (y1 - y0) * (x1 - x0))
    };
    let mut crossings = (0..3).filter_map(at);
    let first = crossings.next()?;
    Some(crossings.fold([first; 2], |[lo, hi], x| [lo.min(x), hi.max(x)]))
}

fn hull(a: Range<u32>, b: Range<u32>) -> Range<u32> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b,
        (_, true) => a,
        _ => a.start.min(b.start)..a.end.max(b.end),
    }
}
