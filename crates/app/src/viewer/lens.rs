//! Which pixels of an eye's picture can be seen.

use wheatstone_core::headset::HiddenArea;
use wheatstone_core::view::{Frustum, PixelRect};

/// What an eye sees through.
#[derive(Debug, Default)]
pub(crate) struct Lens {
    hidden: HiddenArea,
    /// What was asked for last.
    known: Option<Known>,
}

#[derive(Debug)]
struct Known {
    /// Left, right, down, up.
    tangents: [f64; 4],
    size: [u32; 2],
    visible: Vec<PixelRect>,
}

impl Lens {
    /// It hides something from now on; whether it has not done so before.
    pub(crate) fn hide(&mut self, hidden: &HiddenArea) -> bool {
        let is_other = self.hidden != *hidden;
        if is_other {
            (self.hidden, self.known) = (hidden.clone(), None);
        }
        is_other
    }

    /// The pixels of a picture of a frustum, of some width and height, that can be seen.
    pub(crate) fn visible(&mut self, frustum: &Frustum, size: [u32; 2]) -> &[PixelRect] {
        let Frustum { left, right, down, up, .. } = *frustum;
        let tangents = [left, right, down, up];
        let kept = self.known.take().filter(|known| (known.tangents, known.size) == (tangents, size));
        let work_out = || Known { tangents, size, visible: self.hidden.visible(frustum, size) };
        &self.known.insert(kept.unwrap_or_else(work_out)).visible
    }
}
