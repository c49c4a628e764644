//! Whether casts keep layers for volumetric warps, by what that costs the pictures.
//!
//! A cast that keeps layers takes longer, so that pictures of a volume that moves come out coarser. A coarse picture warped by its
//! layers is further from what eyes should see than a fine one warped by its grid (`docs/benchmarks/2026-11-23-vr.md`); as fine, it is
//! nearer.

use crate::viewer::state::WarpName;
use wheatstone_core::budget::Quality;

/// Pictures in a row that are no finer than the one before, by which quality counts as settled.
const SETTLED: u32 = 3;

/// Pictures of full resolution after which layers are tried again: at first and at most.
const TRY_AGAIN: [u32; 2] = [32, 1024];

/// Keeps layers as long as pictures are of full resolution with them, and tries again, ever later, where they are without.
#[derive(Debug)]
pub(crate) struct Keeping {
    /// Number and quality of the newest picture that is known.
    newest: Option<(u64, Quality)>,
    has_layers: bool,
    /// Pictures with layers that were no finer than the one before, or of full resolution without.
    in_a_row: u32,
    /// Of the latter, as many as it takes for another try.
    pause: u32,
}

impl Default for Keeping {
    fn default() -> Self {
        Self { newest: None, has_layers: true, in_a_row: 0, pause: TRY_AGAIN[0] }
    }
}

impl Keeping {
    /// The warp that the next picture is to be cast for, no better than the one that is asked for.
    pub(crate) fn choose(&self, asked: WarpName) -> WarpName {
        if asked == WarpName::Volumetric && !self.has_layers { WarpName::Grid } else { asked }
    }

    /// The newest whole picture: its number, its quality, and whether it has layers.
    pub(crate) fn note(&mut self, number: u64, quality: Quality, has_layers: bool) {
        let before = self.newest.replace((number, quality));
        if before.is_some_and(|(last, _)| last == number) || has_layers != self.has_layers {
            return;
        }
        let is_full = quality == Quality::FULL;
        let goes_on =
            if has_layers { !is_full && before.is_some_and(|(_, last)| quality >= last) } else { is_full };
        self.in_a_row = if goes_on { self.in_a_row + 1 } else { 0 };
        if has_layers && self.in_a_row >= SETTLED {
            (self.has_layers, self.in_a_row) = (false, 0);
        } else if !has_layers && self.in_a_row >= self.pause {
            (self.has_layers, self.in_a_row) = (true, 0);
            self.pause = (2 * self.pause).min(TRY_AGAIN[1]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shows pictures of some levels with or without layers, as asked; with which they were cast.
    fn play(keeping: &mut Keeping, first: u64, with_layers: u32, without: u32, pictures: u64) -> Vec<bool> {
        (first..first + pictures)
            .map(|number| {
                let has_layers = keeping.choose(WarpName::Volumetric) == WarpName::Volumetric;
                let level = if has_layers { with_layers } else { without };
                keeping.note(number, Quality::at(level), has_layers);
                keeping.note(number, Quality::at(level), has_layers);
                has_layers
            })
            .collect()
    }

    #[test]
    fn layers_that_make_pictures_coarse_are_left_out_and_tried_ever_later() {
        let mut keeping = Keeping::default();
        let kept = play(&mut keeping, 0, 2, 0, 400);
        let runs: Vec<_> = kept.chunk_by(|a, b| a == b).map(|run| (run[0], run.len())).collect();
        assert_eq!(runs[..6], [(true, 4), (false, 32), (true, 3), (false, 64), (true, 3), (false, 128)]);
        let mut coarse = Keeping::default();
        play(&mut coarse, 0, 6, 2, 400);
        assert_eq!(coarse.choose(WarpName::Volumetric), WarpName::Grid, "nothing to spare for layers");
    }

    #[test]
    fn layers_that_cost_nothing_stay() {
        let mut keeping = Keeping::default();
        // The first pictures are coarse anyhow.
        for level in (0..=Quality::COARSEST.level()).rev() {
            play(&mut keeping, u64::from(100 - level), level, 0, 1);
        }
        assert!(play(&mut keeping, 101, 0, 0, 100).into_iter().all(|kept| kept));
    }

    #[test]
    fn no_better_warp_is_chosen_than_what_is_asked_for() {
        for asked in WarpName::ALL {
            assert_eq!(Keeping::default().choose(asked), asked);
        }
        let without = Keeping { has_layers: false, ..Keeping::default() };
        assert_eq!(without.choose(WarpName::Quad), WarpName::Quad);
    }
}
