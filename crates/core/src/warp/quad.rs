//! The picture on a plane.

use super::{PixelMap, WarpError};
use crate::image::Image;
use crate::view::View;
use glam::{DVec2, DVec4, Vec4};
use rayon::prelude::*;

/// The picture of the shown view as the wanted view sees it if all of it is on a plane across the shown view, at an inverse depth in
/// 1/m (VR §5.3.1, which takes the far clipping plane; 0 is infinity): exact where only the orientation or the window differs; of what
/// the eye moves sideways, right for what is at that depth ([`Reach::middle`](super::Reach::middle) is in the midst of a body).
/// Bilinear between premultiplied colours, transparent outside of the picture; all depths are infinite. Sizes and windows of the
/// views may differ.
///
/// A shader does the same with one thread per wanted pixel: `h = matrix · (x + ½, y + ½, 1)` with the [`PixelMap::onto_plane`] from
/// wanted to shown, and four texels about `h.xy / h.z`.
///
/// # Errors
/// A picture that is not of the shown view, a parallel projection, views with numbers that are not finite or without area.
pub fn quad(shown: &View, image: &Image, wanted: &View, inverse_depth: f64) -> Result<Image, WarpError> {
    let shown_from_wanted = PixelMap::between(wanted, shown)?.onto_plane(inverse_depth);
    WarpError::unless_of(image, shown)?;
    let [width, height] = wanted.size;
    let mut warped = Image::transparent(width, height);
    warped.color.par_chunks_mut(width as usize).enumerate().for_each(|(y, row)| {
        for (x, color) in row.iter_mut().enumerate() {
            let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
            if let Some(landing) = shown_from_wanted.at(centre, 0.0) {
                *color = bilinear(image, landing.position);
            }
        }
    });
    Ok(warped)
}

/// Colour at a position in pixels from the top left; transparent from one pixel outside of the outermost centres.
fn bilinear(image: &Image, position: DVec2) -> [f32; 4] {
    let first = (position - 0.5).floor();
    let along = position - 0.5 - first;
    let texel = |dx: f64, dy: f64| {
        let (x, y) = (first.x + dx, first.y + dy);
        let is_inside = x >= 0.0 && y >= 0.0 && x < f64::from(image.width) && y < f64::from(image.height);
        if is_inside {
            Vec4::from(image.color[y as usize * image.width as usize + x as usize]).as_dvec4()
        } else {
            DVec4::ZERO
        }
    };
    let above = texel(0.0, 0.0).lerp(texel(1.0, 0.0), along.x);
    let below = texel(0.0, 1.0).lerp(texel(1.0, 1.0), along.x);
    above.lerp(below, along.y).as_vec4().to_array()
}
