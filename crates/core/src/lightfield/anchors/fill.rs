//! What an anchor does not see, by what the anchors next to it do.

use super::slab_picture::cell_of;
use super::{AnchorPlan, CLEAR, Hider, SlabPicture, Source, color_of};
use glam::Vec4;

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

/// The pictures of the anchors of a plan, with something in the cells that are hidden: what the first anchor next to it tells that sees there.
///
/// What neither sees is clear, unless what hides it is at most [`MOST_BEHIND`] slabs before, or it is in the last slab: there it has the
/// colour of the furthest of what hides it, and is opaque, but for cells next to one that is seen and clear.
///
/// # Panics
/// If there are fewer pictures than anchors.
pub fn fill(plan: &AnchorPlan, pictures: &[SlabPicture]) -> Vec<SlabPicture> {
    let filled = |(index, picture): (usize, &SlabPicture)| {
        let neighbours = plan.neighbours(index);
        let places: Vec<Place<'_>> =
            neighbours.iter().map(|source| Place { anchor: &pictures[source.anchor], source }).collect();
        let mut filled = picture.clone();
        let [width, height] = picture.size;
        for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
            let Some(hider) = picture.hider(column.into(), row) else { continue };
            for slab in hider.slab() + 1..picture.count {
                let cell =
                    (slab as usize * height as usize + row as usize) * width as usize + column as usize;
                let at = [slab, column, row];
                filled.cells[cell] = match seen_from(&places, at, hider) {
                    Seen::Known(color) => cell_of(color),
                    Seen::Behind(hider) => guess(picture, at, hider),
                };
            }
        }
        filled
    };
    pictures.iter().enumerate().map(filled).collect()
}

/// An anchor next to another one.
struct Place<'a> {
    anchor: &'a SlabPicture,
    source: &'a Source,
}

impl Place<'_> {
    fn seen(&self, [slab, column, row]: [u32; 3]) -> Seen {
        let position =
            column as f32 + self.source.offset_px as f32 + slab as f32 * self.source.per_slab_px as f32;
        let columns = [0, 1].map(|right| position.floor() as i64 + right);
        let cells = columns.map(|column| color_of(self.anchor.cell(slab, column, row)));
        let hiders = columns.map(|column| self.anchor.hider(column, row).filter(|hider| hider.hides(slab)));
        match hiders {
            [Some(left), Some(right)] => Seen::Behind(left.max(right)),
            // Between what is hidden and what is not, there is what is not: what hides the one has been there before.
            [Some(_), None] => Seen::Known(cells[1]),
            [None, Some(_)] => Seen::Known(cells[0]),
            [None, None] => Seen::Known(cells[0].lerp(cells[1], position - position.floor())),
        }
    }
}

/// What the first place tells that sees a cell; if none does, the furthest of what hides it, that of its own picture included.
fn seen_from(places: &[Place<'_>], at: [u32; 3], hider: Hider) -> Seen {
    let mut furthest = hider;
    for place in places {
        match place.seen(at) {
            Seen::Behind(other) => furthest = furthest.max(other),
            known @ Seen::Known(_) => return known,
        }
    }
    Seen::Behind(furthest)
}

/// What is put in a cell that nothing sees.
fn guess(picture: &SlabPicture, at: [u32; 3], hider: Hider) -> u32 {
    let [slab, column, row] = at;
    let is_clear = |column| {
        let hider = picture.hider(column, row);
        picture.cell(slab, column, row) == CLEAR && hider.is_none_or(|hider| !hider.hides(slab))
    };
    let is_at_edge = [-1, 1].into_iter().any(|side| is_clear(i64::from(column) + side));
    let is_solid = slab - hider.slab() <= MOST_BEHIND || slab + 1 == picture.count;
    if is_solid && !is_at_edge { cell_of(hider.color()) } else { CLEAR }
}
