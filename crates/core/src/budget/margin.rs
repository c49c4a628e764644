//! How much more than expected to be prepared for.

use std::collections::VecDeque;

/// Batches remembered: a few seconds.
const REMEMBERED: usize = 256;

/// Batches after which the doubts of the beginning are forgotten.
const DOUBTFUL: usize = 64;

/// Deviations reserved before anything is known.
const FIRST_DEVIATIONS: f64 = 4.0;

/// Fewest deviations that are reserved: what has never been off may be, once.
const FEWEST_DEVIATIONS: f64 = 1.0;

/// Most deviations that are reserved.
const MOST_DEVIATIONS: f64 = 8.0;

/// Learns how far batches are off what was expected of them, in deviations.
///
/// In place of the bias b of VR Alg. 5: errors of single cells cancel in a batch, so that a factor per cell that covers
/// their errors reserves too much, and a fixed one reserves too little where things move. The reserve is what all but a few of the
/// remembered batches would have kept to, so the share that exceeds it is about that, whatever the distribution of errors.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Margin {
    /// Of the remembered batches, how many may take longer.
    tolerated_share: f64,
    /// Batches that have been learnt from, up to those that are remembered.
    learnt: usize,
    /// Oldest first.
    recent_deviations: VecDeque<f64>,
}

impl Default for Margin {
    /// One batch in 256 may take longer.
    fn default() -> Self {
        Self::tolerating(0.0)
    }
}

impl Margin {
    /// So large a share of batches may take longer, but one in 256 at least.
    pub(super) fn tolerating(share: f64) -> Self {
        let mut recent_deviations = VecDeque::from([0.0; REMEMBERED]);
        recent_deviations[DOUBTFUL - 1] = FIRST_DEVIATIONS;
        Self { tolerated_share: share.max(1.0 / REMEMBERED as f64), learnt: 0, recent_deviations }
    }

    /// Forgets all batches.
    pub(super) fn forget(&mut self) {
        *self = Self::tolerating(self.tolerated_share);
    }

    /// Deviations by which to undercut a budget: the most of late but for those tolerated.
    pub(super) fn deviations(&self) -> f64 {
        let mut deviations: Vec<f64> = self.recent_deviations.iter().copied().collect();
        let tolerated = ((self.tolerated_share * self.learnt as f64) as usize).min(REMEMBERED - 1);
        let (_, most, _) = deviations.select_nth_unstable_by(REMEMBERED - 1 - tolerated, f64::total_cmp);
        most.max(FEWEST_DEVIATIONS)
    }

    /// Learns from a batch.
    pub(super) fn learn(&mut self, expected_s: f64, variance_s2: f64, measured_s: f64) {
        let deviations = (measured_s - expected_s) / variance_s2.sqrt();
        if deviations.is_finite() {
            self.recent_deviations.pop_front();
            self.recent_deviations.push_back(deviations.min(MOST_DEVIATIONS));
            self.learnt = (self.learnt + 1).min(REMEMBERED);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_shrinks_to_the_errors_that_there_are_and_grows_with_them() {
        let mut margin = Margin::default();
        let mut learn = |deviations: &[f64]| {
            deviations.iter().for_each(|d| margin.learn(1.0, 0.01, 1.0 + 0.1 * d));
            (10.0 * margin.deviations()).round() / 10.0
        };
        assert_eq!(learn(&[]), FIRST_DEVIATIONS);
        assert_eq!(learn(&[1.0; DOUBTFUL - 2]), FIRST_DEVIATIONS);
        assert_eq!(learn(&[-1.0, 1.0]), 1.0);
        assert_eq!(learn(&[2.0]), 2.0);
        assert_eq!(learn(&[1e9]), MOST_DEVIATIONS);
        assert_eq!(learn(&[1.5; REMEMBERED]), 1.5);
        assert_eq!(learn(&[1e9]), 1.5);
        assert_eq!(learn(&[-3.0; REMEMBERED]), FEWEST_DEVIATIONS);
    }

    #[test]
    fn more_batches_are_tolerated_where_that_is_asked_for() {
        let mut margin = Margin::tolerating(0.02);
        (0..REMEMBERED).for_each(|batch| margin.learn(1.0, 0.01, 1.0 + 0.01 * (batch % 50) as f64));
        let deviations = margin.deviations();
        assert!((4.5..=5.0).contains(&deviations), "{deviations}");
        margin.forget();
        assert_eq!(margin, Margin::tolerating(0.02));
    }

    #[test]
    fn what_is_no_error_teaches_nothing() {
        let mut margin = Margin::default();
        for [expected_s, variance_s2, measured_s] in
            [[0.0, 0.0, 1.0], [f64::INFINITY, 1.0, 1.0], [1.0, 1.0, f64::NAN], [0.0, -1.0, 0.0]]
        {
            margin.learn(expected_s, variance_s2, measured_s);
        }
        assert_eq!(margin, Margin::default());
    }
}
