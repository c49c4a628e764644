//! Lenses that show each view in directions of its own, the same at all heights.

use super::lobe::{Blend, lobe};
use super::{Eye, SeenView};
use crate::image::RgbImage;
use crate::lightfield::quilt::TileError;
use crate::lightfield::{Lenticular, QuiltDisplay};
use glam::DVec2;
use thiserror::Error;

/// A picture that is not of the panel's size.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("the interlaced picture is of {}x{} pixels: the panel has {}x{}", found[0], found[1], panel[0], panel[1])]
pub struct NotOfPanel {
    /// Width and height of the picture, pixels.
    pub found: [u32; 2],
    /// Width and height of the panel, pixels.
    pub panel: [u32; 2],
}

impl QuiltDisplay {
    /// What an eye sees of a quilt's views, in order, through ideal lenses: from the focal distance one view, or two where they
    /// meet. Beyond the view cone they begin anew.
    ///
    /// # Errors
    /// Another number of views than of tiles, views of another size than a tile's.
    pub fn seen_from(&self, eye: &Eye, views: &[RgbImage]) -> Result<RgbImage, TileError> {
        self.check_views(views)?;
        Ok(eye.picture_of(&self.views_seen_from(eye), views))
    }

    /// Which views an eye sees in each column of its picture, and where in them it looks.
    pub fn views_seen_from(&self, eye: &Eye) -> Vec<Vec<SeenView>> {
        let count = f64::from(self.view_count());
        let screen_size_m = self.screen_size_m();
        eye.columns(screen_size_m, |x_m| {
            let in_views = self.share_towards(eye, x_m) * count - 0.5;
            let along = x_m / screen_size_m[0] + 0.5;
            let seen = |near: f64| {
                let (index, weight) = (near.rem_euclid(count) as usize, lobe(in_views - near));
                (weight > 0.0).then_some(SeenView { index, weight, along, down: [0.0, 1.0] })
            };
            [in_views.floor(), in_views.floor() + 1.0].into_iter().filter_map(seen).collect()
        })
    }

    /// The share of the view cone in which an eye is from a place so far to the right on the screen, metres.
    fn share_towards(&self, eye: &Eye, x_m: f64) -> f64 {
        let to_eye = (eye.position_m().x - x_m) / eye.position_m().z;
        self.share_of_camera(x_m + to_eye * self.focal_distance_m)
    }
}

impl Lenticular {
    /// What an eye sees of an interlaced picture: of the sub-pixels under a lens those that the lens magnifies towards it, where the panel
    /// shows them.
    ///
    /// # Errors
    /// A picture of another size than the panel's.
    pub fn seen_from(
        &self,
        eye: &Eye,
        display: &QuiltDisplay,
        picture: &RgbImage,
    ) -> Result<RgbImage, NotOfPanel> {
        let (found, panel) = ([picture.width, picture.height], self.panel_px);
        if found != panel {
            return Err(NotOfPanel { found, panel });
        }
        let screen_size_m = display.screen_size_m();
        let [columns, rows] = panel.map(f64::from);
        let shares_per_column = self.lenses_across() / columns;
        // Of the panel an eye's pixel sees as much as it covers, and at least a lens across.
        let [covered_columns, covered_rows] =
            [columns / f64::from(eye.size_px()[0]), rows / f64::from(eye.size_px()[1])];
        let half = |pixels: f64| (0.5 * pixels).ceil().max(1.0) as i64;
        let half_columns = half(covered_columns.max(shares_per_column.recip()).min(columns));
        let half_rows = half(covered_rows);
        Ok(eye.picture(|column, row| {
            let screen_m = eye.screen_m(screen_size_m, column, row);
            let wanted = display.share_towards(eye, screen_m.x);
            let right = screen_m.x / screen_size_m[0] + 0.5;
            let down = 0.5 - screen_m.y / screen_size_m[1];
            let at = DVec2::new(
                if self.flips_x { 1.0 - right } else { right } * columns,
                if self.flips_y { 1.0 - down } else { down } * rows,
            );
            let mut blend = Blend::default();
            let (middle_column, middle_row) = (at.x.floor() as i64, at.y.floor() as i64);
            let within = |middle: i64, reach: i64, count: u32| {
                (middle - reach).max(0)..(middle + reach + 1).min(i64::from(count))
            };
            for y in within(middle_row, half_rows, panel[1]) {
                for x in within(middle_column, half_columns, panel[0]) {
                    let rgb = picture.rgb[y as usize * picture.width as usize + x as usize];
                    for (channel, level) in rgb.into_iter().enumerate() {
                        let apart = wanted - self.share(x as u32, y as u32, channel);
                        let to_nearest = apart - apart.round();
                        blend.add_channel(channel, level, lobe(to_nearest / shares_per_column));
                    }
                }
            }
            blend.rgb()
        }))
    }
}
