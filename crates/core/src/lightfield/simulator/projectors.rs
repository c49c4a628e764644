//! A screen that is sharply transmissive to the sides and scatters light up and down.

use super::lobe::lobe;
use super::{Eye, SeenView};
use crate::image::RgbImage;
use crate::lightfield::ProjectorArray;
use crate::lightfield::projectors::{PackingError, Projector};
use glam::DVec2;
use std::ops::Range;

/// Which columns of the projectors' images an eye sees anything of, and where.
#[derive(Debug, Clone)]
pub struct SeenParts {
    eye: Eye,
    /// In each column of its picture; places are in the parts.
    views: Vec<Vec<SeenView>>,
    columns: Vec<Range<u32>>,
}

impl SeenParts {
    /// Those of each projector's image, in their order; none of those that are not seen.
    pub fn columns(&self) -> &[Range<u32>] {
        &self.columns
    }

    /// What the eye sees, of pictures of these columns alone.
    ///
    /// # Panics
    /// If there are fewer pictures than projectors.
    pub fn picture(&self, parts: &[RgbImage]) -> RgbImage {
        self.eye.picture_of(&self.views, parts)
    }

    /// The columns of the eye's picture between which it sees any projector.
    pub fn lit_columns(&self) -> Range<u32> {
        let is_lit = |views: &Vec<SeenView>| !views.is_empty();
        let first = self.views.iter().position(is_lit).unwrap_or(0);
        let end = self.views.iter().rposition(is_lit).map_or(0, |last| last + 1);
        first as u32..end as u32
    }
}

impl ProjectorArray {
    /// What an eye sees of the projectors' images, which are in the order of the projectors.
    ///
    /// A place on the screen sends each projector's light on to the sides in its direction, spread over the beam angle, and upwards and
    /// downwards everywhere: so it looks the same from all heights.
    ///
    /// # Errors
    /// Another number of images than of projectors, images of another size.
    pub fn seen_from(&self, eye: &Eye, images: &[RgbImage]) -> Result<RgbImage, PackingError> {
        self.check_images(images)?;
        Ok(eye.picture_of(&self.views_seen_from(eye), images))
    }

    /// Which columns of the projectors' images an eye sees anything of.
    pub fn parts_seen_from(&self, eye: &Eye) -> SeenParts {
        let mut views = self.views_seen_from(eye);
        let [width, _] = self.description().image_size_px;
        let mut columns = vec![0..0; self.projectors().len()];
        for seen in views.iter().flatten() {
            let at = seen.along * f64::from(width);
            // Interpolation reads the pixels whose middles are around a place.
            let first = (at - 0.5).floor().max(0.0) as u32;
            let end = ((at + 0.5).ceil() as u32 + 1).min(width);
            let seen: &mut Range<u32> = &mut columns[seen.index];
            *seen =
                if seen.start == seen.end { first..end } else { seen.start.min(first)..seen.end.max(end) };
        }
        for seen in views.iter_mut().flatten() {
            let part = &columns[seen.index];
            seen.along =
                (seen.along * f64::from(width) - f64::from(part.start)) / f64::from(part.len() as u32);
        }
        SeenParts { eye: *eye, views, columns }
    }

    /// Which projectors an eye sees in each column of its picture, and where in their images it looks.
    pub fn views_seen_from(&self, eye: &Eye) -> Vec<Vec<SeenView>> {
        let screen_size_m = self.description().screen_size_m;
        let half_height_m = 0.5 * screen_size_m[1];
        let beam_rad = self.description().beam_angle_deg.to_radians();
        let eye_m = eye.position_m();
        eye.columns(screen_size_m, |x_m| {
            let to_eye_rad = ((eye_m.x - x_m) / eye_m.z).atan();
            let seen = |(index, projector): (usize, &Projector)| {
                let emitter = projector.emitter();
                let beam_to_rad = ((x_m - emitter.x) / -emitter.z).atan();
                let weight = lobe((to_eye_rad - beam_to_rad) / beam_rad);
                let share = |y_m: f64| projector.pixel(DVec2::new(x_m, y_m), [1, 1]);
                let (top, bottom) = (share(half_height_m), share(-half_height_m));
                let is_seen = weight > 0.0 && (0.0..=1.0).contains(&top.x);
                is_seen.then_some(SeenView { index, weight, along: top.x, down: [top.y, bottom.y] })
            };
            self.projectors().iter().enumerate().filter_map(seen).collect()
        })
    }
}
