//! A view out of slabs.

use super::{CLEAR, Derived, Hider, SlabPicture, Source, color_of};
use crate::image::Image;
use glam::Vec4;
use rayon::prelude::*;

/// What passes a derived ray where it ends.
pub const LEAST_THROUGH: f32 = 0.01;

/// The part of a pixel that the nearest anchor may not know before all are asked; what is less takes the colour of the rest.
pub const LEAST_UNKNOWN: f32 = 1.0 / 16.0;

/// How many slabs behind what hides a place, for all anchors, it still counts as that: surfaces cross slabs from pixel to pixel.
pub const MOST_BEHIND: u32 = 2;

/// What an anchor tells of a place.
#[derive(Debug, Clone, Copy)]
enum Seen {
    /// What is there, premultiplied RGBA.
    Known(Vec4),
    /// What is before it.
    Behind(Hider),
}

/// The picture of a view, of the cells of all anchors. It has no depths.
///
/// Rays go through the slabs from front to back, by what the nearest anchor tells of each. From the first place on that it does not
/// see, if more than [`LEAST_UNKNOWN`] gets there, the other is asked where the nearest does not see. What neither sees is passed unless
/// what hides it is at most [`MOST_BEHIND`] slabs before. A ray that does not get out of what neither sees ends in the furthest of what
/// hides its last slab, there or where it was last seen.
///
/// # Panics
/// If there are fewer pictures than anchors.
pub fn derive(derived: &Derived, anchors: &[SlabPicture]) -> Image {
    let [width, height] = derived.view.size;
    let mut image = Image::transparent(width, height);
    let sources: Vec<Place<'_>> =
        derived.sources.iter().map(|source| Place { anchor: &anchors[source.anchor], source }).collect();
    image.color.par_chunks_mut(width as usize).zip(0..height).for_each(|(colors, row)| {
        for (color, column) in colors.iter_mut().zip(0..) {
            *color = gather(&sources, column, row).to_array();
        }
    });
    image
}

/// Where an anchor sees what a view does.
struct Place<'a> {
    anchor: &'a SlabPicture,
    source: &'a Source,
}

impl Place<'_> {
    /// The column at which a pixel sees a slab; whole numbers are middles of pixels.
    fn position(&self, slab: u32, column: u32) -> f32 {
        column as f32 + self.source.offset_px as f32 + slab as f32 * self.source.per_slab_px as f32
    }

    /// The cells of a slab on both sides of a position.
    fn cells(&self, slab: u32, position: f32, row: u32) -> [u32; 2] {
        [0, 1].map(|right| self.anchor.cell(slab, position.floor() as i64 + right, row))
    }

    fn seen(&self, slab: u32, column: u32, row: u32) -> Seen {
        let position = self.position(slab, column);
        let cells = self.cells(slab, position, row);
        match cells.map(Hider::of_cell) {
            [Some(left), Some(right)] => Seen::Behind(left.max(right)),
            // Between what is hidden and what is not, there is what is not: what hides the one has been there before.
            [Some(_), None] => Seen::Known(color_of(cells[1])),
            [None, Some(_)] => Seen::Known(color_of(cells[0])),
            [None, None] if cells == [CLEAR; 2] => Seen::Known(Vec4::ZERO),
            [None, None] => {
                Seen::Known(color_of(cells[0]).lerp(color_of(cells[1]), position - position.floor()))
            }
        }
    }
}

/// What the first place tells that sees a slab; if none does, the furthest of what hides it.
fn seen_by_any(places: &[Place<'_>], slab: u32, column: u32, row: u32) -> Seen {
    let mut furthest = None;
    for place in places {
        match place.seen(slab, column, row) {
            Seen::Behind(hider) => furthest = furthest.max(Some(hider)),
            Seen::Known(color) => return Seen::Known(color),
        }
    }
    furthest.map_or(Seen::Known(Vec4::ZERO), Seen::Behind)
}

/// The ray of a pixel through the slabs: premultiplied RGBA.
fn gather(places: &[Place<'_>], column: u32, row: u32) -> Vec4 {
    let (mut color, mut are_all_asked, mut last_known) = (Vec4::ZERO, false, 0);
    let count = places.first().map_or(0, |nearest| nearest.anchor.count);
    for slab in 0..count {
        let through = 1.0 - color.w;
        if through < LEAST_THROUGH {
            return color;
        }
        let seen = match places[0].seen(slab, column, row) {
            Seen::Behind(_) if !are_all_asked && through <= LEAST_UNKNOWN => return color / color.w,
            Seen::Behind(_) => {
                are_all_asked = true;
                seen_by_any(places, slab, column, row)
            }
            known @ Seen::Known(_) => known,
        };
        match seen {
            Seen::Known(seen) => {
                color += through * seen;
                last_known = slab;
            }
            Seen::Behind(hider) if slab - hider.slab() <= MOST_BEHIND => {
                return color + through * hider.color();
            }
            Seen::Behind(_) => {}
        }
    }
    if last_known + 1 >= count {
        return color;
    }
    let last = count - 1;
    let hidden = places.iter().flat_map(|place| {
        [last_known, last].map(|slab| place.cells(last, place.position(slab, column), row))
    });
    let furthest = hidden.flatten().filter_map(Hider::of_cell).max();
    furthest.map_or(color, |hider| color + (1.0 - color.w) * hider.color())
}
