//! What an eye sees in one column of its picture.

use super::Eye;
use super::lobe::Blend;
use crate::image::RgbImage;
use glam::DVec2;

/// A view that is seen in a column: the same at all heights, for light leaves a display's screen up and down everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenView {
    /// Which view, or projector, by its index.
    pub index: usize,
    /// How bright it is; colours are means by these weights.
    pub weight: f64,
    /// Where the column looks in the view's picture, from its left (0) to its right edge (1).
    pub along: f64,
    /// Where the screen's top and bottom edges are in it, from its top (0) to its bottom edge (1).
    pub down: [f64; 2],
}

impl SeenView {
    /// Where it looks at a share of the screen's height from its top, in pixels of a picture of a size.
    fn position(&self, share: f64, size: DVec2) -> DVec2 {
        let [top, bottom] = self.down;
        DVec2::new(self.along, top + (bottom - top) * share) * size
    }
}

impl Eye {
    /// Its picture of views that are seen in columns, one list for each of its columns.
    pub(super) fn picture_of(&self, columns: &[Vec<SeenView>], views: &[RgbImage]) -> RgbImage {
        let rows = f64::from(self.size_px()[1]);
        self.picture(|column, row| {
            let mut blend = Blend::default();
            for seen in &columns[column] {
                let view = &views[seen.index];
                let size = DVec2::new(f64::from(view.width), f64::from(view.height));
                if let Some(rgb) = view.sample(seen.position((row as f64 + 0.5) / rows, size)) {
                    blend.add(rgb, seen.weight);
                }
            }
            blend.rgb()
        })
    }

    /// Something for each of its columns, from the x of its middle on a screen of a width, metres.
    pub(super) fn columns<T>(&self, screen_size_m: [f64; 2], of_column: impl Fn(f64) -> T) -> Vec<T> {
        let columns = self.size_px()[0] as usize;
        (0..columns).map(|column| of_column(self.screen_m(screen_size_m, column, 0).x)).collect()
    }
}
