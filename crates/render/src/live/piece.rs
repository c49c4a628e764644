//! What one dispatch casts of a cell.

use crate::cast_pass::reads_per_sample;
use crate::pacer::{BAND_ROWS, guessed_s, sample_limit};
use crate::renderer::Prepared;
use crate::squares::Squares;

/// Samples of a cell's rays.
#[derive(Debug, Clone)]
pub(super) struct Piece {
    /// Which cell of its batch it is of.
    pub(super) place: usize,
    pub(super) view: usize,
    /// What is emptied before; may be none.
    pub(super) stale: Squares,
    /// What is cast; may be none.
    pub(super) squares: Squares,
    pub(super) first_sample: u32,
    pub(super) sample_limit: u32,
}

impl Piece {
    /// The pieces of a cell: one, unless its rays are too long for the driver or are to be cast a share at a time.
    pub(super) fn of_cell(whole: &Self, prepared: &Prepared, share_of_ray: f64) -> Vec<Self> {
        let most_samples = prepared.parameters.most_samples_per_ray();
        let limit = sample_limit(most_samples, prepared.iterations_per_sample, share_of_ray);
        let part = |first_sample: u32| {
            let stale = if first_sample == 0 { whole.stale.clone() } else { Squares::default() };
            Self { stale, first_sample, sample_limit: limit, ..whole.clone() }
        };
        if whole.squares.is_empty() {
            return vec![part(0)];
        }
        (0..most_samples).step_by(limit as usize).map(part).collect()
    }

    /// Share of the rays of some squares that a budget holds before anything is known.
    pub(super) fn guessed_share(prepared: &Prepared, squares: &Squares, budget_s: f64) -> f64 {
        let pixels = squares.counts().map(|count| f64::from(count * BAND_ROWS)).iter().product::<f64>();
        let samples = pixels * f64::from(prepared.parameters.most_samples_per_ray());
        budget_s / guessed_s(samples, reads_per_sample(&prepared.parameters))
    }
}
