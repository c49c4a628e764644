//! A piece of surface between four neighbouring pixel centres, and how it is drawn.

use super::Landing;
use glam::{DVec2, DVec3, DVec4};

/// Which part of a sheet is drawn, and before what.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Cover {
    /// The quarters next to marked corners, before all that is further away.
    Quarters([bool; 4]),
    /// All of it if it does not face away, where nothing else is; the furthest of several.
    Holes,
}

/// Four corners of a cell: top left, top right, bottom left, bottom right.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sheet {
    pub(super) corners: [Landing; 4],
    /// Premultiplied.
    pub(super) colors: [DVec4; 4],
    pub(super) cover: Cover,
}

/// Rows of the picture that is drawn.
pub(super) struct Band<'a> {
    pub(super) first_row: usize,
    pub(super) width: usize,
    pub(super) color: &'a mut [[f32; 4]],
    pub(super) depth_m: &'a mut [f32],
    /// What is drawn at a pixel yields to what has a larger rank: above 0, the inverse depth.
    pub(super) rank: Vec<f64>,
}

/// Corners and directions of the two triangles of a sheet.
const TRIANGLES: [[usize; 3]; 2] = [[0, 1, 3], [0, 3, 2]];

/// Where corners are in the cell.
const PLACES: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];

/// How far outside of a triangle a pixel's centre still counts as inside, so that rounding opens no seams.
const SEAM: f64 = 1e-9;

impl Sheet {
    /// Lowest and highest pixel position along y.
    pub(super) fn extent_y(&self) -> (f64, f64) {
        let ys = self.corners.map(|corner| corner.position.y);
        (ys.into_iter().fold(f64::INFINITY, f64::min), ys.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }

    /// Draws what lies in the band.
    pub(super) fn draw(&self, band: &mut Band<'_>) {
        for triangle in TRIANGLES {
            self.draw_triangle(triangle, band);
        }
    }

    fn draw_triangle(&self, triangle: [usize; 3], band: &mut Band<'_>) {
        let [a, b, c] = triangle.map(|corner| self.corners[corner].position);
        let area = (b - a).perp_dot(c - a);
        let is_drawn = match self.cover {
            Cover::Quarters(_) => area != 0.0,
            Cover::Holes => area > 0.0,
        };
        if !is_drawn {
            return;
        }
        let first_row = band.first_row as f64;
        let rows = band.rank.len() / band.width;
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let (left, right) = centres_between(low.x, high.x, band.width);
        let (top, bottom) = centres_between(low.y - first_row, high.y - first_row, rows);
        for row in top..bottom {
            for x in left..right {
                let centre = DVec2::new(x as f64 + 0.5, first_row + row as f64 + 0.5);
                let weight_b = (centre - a).perp_dot(c - a) / area;
                let weight_c = (b - a).perp_dot(centre - a) / area;
                let weights = DVec3::new(1.0 - weight_b - weight_c, weight_b, weight_c);
                if weights.min_element() >= -SEAM {
                    self.draw_pixel(triangle, weights, row * band.width + x, band);
                }
            }
        }
    }

    fn draw_pixel(&self, triangle: [usize; 3], weights: DVec3, pixel: usize, band: &mut Band<'_>) {
        let [a, b, c] = triangle;
        let depths = triangle.map(|corner| self.corners[corner].inverse_depth);
        let inverse_depth = weights.dot(DVec3::from(depths)).max(0.0);
        let rank = match self.cover {
            Cover::Quarters(_) => inverse_depth,
            Cover::Holes => -1.0 - inverse_depth,
        };
        if rank <= band.rank[pixel] {
            return;
        }
        let place = (weights.x * PLACES[a] + weights.y * PLACES[b] + weights.z * PLACES[c])
            .clamp(DVec2::ZERO, DVec2::ONE);
        if let Cover::Quarters(covered) = self.cover
            && !covered[usize::from(place.x >= 0.5) + 2 * usize::from(place.y >= 0.5)]
        {
            return;
        }
        let above = self.colors[0].lerp(self.colors[1], place.x);
        let below = self.colors[2].lerp(self.colors[3], place.x);
        band.color[pixel] = above.lerp(below, place.y).as_vec4().to_array();
        band.depth_m[pixel] = (1.0 / inverse_depth) as f32;
        band.rank[pixel] = rank;
    }
}

/// The pixels, of a number of them, whose centres lie between two positions.
fn centres_between(low: f64, high: f64, pixels: usize) -> (usize, usize) {
    let first = (low - 0.5 - SEAM).ceil().max(0.0) as usize;
    let end = (high + 0.5 + SEAM).floor().clamp(0.0, pixels as f64) as usize;
    (first, end)
}
