//! A screen that is sharply transmissive to the sides and scatters light up and down.

use super::Eye;
use super::lobe::{Blend, lobe};
use crate::image::RgbImage;
use crate::lightfield::ProjectorArray;
use crate::lightfield::projectors::PackingError;

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
        let description = self.description();
        let beam_rad = description.beam_angle_deg.to_radians();
        let position_m = eye.position_m();
        Ok(eye.picture(|column, row| {
            let screen_m = eye.screen_m(description.screen_size_m, column, row);
            let to_eye_rad = ((position_m.x - screen_m.x) / position_m.z).atan();
            let mut blend = Blend::default();
            for (projector, image) in self.projectors().iter().zip(images) {
                let emitter = projector.emitter();
                let beam_to_rad = ((screen_m.x - emitter.x) / -emitter.z).atan();
                let weight = lobe((to_eye_rad - beam_to_rad) / beam_rad);
                if weight > 0.0 {
                    let pixel = projector.pixel(screen_m, description.image_size_px);
                    if let Some(rgb) = image.sample(pixel) {
                        blend.add(rgb, weight);
                    }
                }
            }
            blend.rgb()
        }))
    }
}
