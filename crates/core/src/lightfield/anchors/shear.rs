//! A view out of slabs.

use super::{Derived, SlabPicture, color_of};
use crate::image::Image;
use glam::Vec4;
use rayon::prelude::*;

/// What passes a derived ray where it ends.
pub const LEAST_THROUGH: f32 = 0.01;

/// The picture of a view, of the cells of its nearest anchor, in which something [fills](super::fill) what that does not see. It has no depths.
///
/// Rays go through the slabs from front to back.
///
/// # Panics
/// If there are fewer pictures than anchors.
pub fn derive(derived: &Derived, filled: &[SlabPicture]) -> Image {
    let [width, height] = derived.view.size;
    let mut image = Image::transparent(width, height);
    image.color.par_chunks_mut(width as usize).zip(0..height).for_each(|(colors, row)| {
        for (color, column) in colors.iter_mut().zip(0..) {
            *color = gather(derived, &filled[derived.source.anchor], column, row).to_array();
        }
    });
    image
}

/// The ray of a pixel through the slabs: premultiplied RGBA.
fn gather(derived: &Derived, anchor: &SlabPicture, column: u32, row: u32) -> Vec4 {
    let source = &derived.source;
    let mut color = Vec4::ZERO;
    for slab in 0..anchor.count {
        if 1.0 - color.w < LEAST_THROUGH {
            break;
        }
        // Whole numbers are middles of pixels.
        let position = column as f32 + source.offset_px as f32 + slab as f32 * source.per_slab_px as f32;
        let left = position.floor();
        let [at_left, at_right] = [0, 1].map(|right| color_of(anchor.cell(slab, left as i64 + right, row)));
        color += (1.0 - color.w) * at_left.lerp(at_right, position - left);
    }
    color
}
