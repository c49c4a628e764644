//! A screen that is sharply transmissive to the sides and scatters light up and down.

use super::lobe::lobe;
use super::{Eye, SeenView};
use crate::image::RgbImage;
use crate::lightfield::ProjectorArray;
use crate::lightfield::projectors::{PackingError, Projector};
use glam::DVec2;

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
