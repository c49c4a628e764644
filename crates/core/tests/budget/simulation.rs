//! Refreshes in simulated time.

use crate::oracle;
use crate::workload::Workload;
use std::collections::VecDeque;
use wheatstone_core::budget::{CastSchedule, Predictor, ViewRequest};

pub(crate) const PERIOD_S: f64 = 1.0 / 90.0;
pub(crate) const WARP_S: f64 = 0.002;
pub(crate) const AVAILABLE_S: f64 = PERIOD_S - WARP_S;

/// What came of a number of refreshes.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) refreshes: u32,
    /// Refreshes before which casting went on into the time of the warp.
    pub(crate) missed: u32,
    pub(crate) views: u32,
    /// Time within the budget that was given to casting, seconds.
    pub(crate) cast_s: f64,
}

impl Outcome {
    pub(crate) fn missed_share(&self) -> f64 {
        f64::from(self.missed) / f64::from(self.refreshes)
    }

    /// Casting time per refresh, seconds.
    pub(crate) fn cast_per_refresh_s(&self) -> f64 {
        self.cast_s / f64::from(self.refreshes)
    }

    fn count(&mut self, taken_s: f64, completes_view: bool) {
        self.refreshes += 1;
        self.missed += u32::from(taken_s > AVAILABLE_S);
        self.cast_s += taken_s.min(AVAILABLE_S);
        self.views += u32::from(completes_view);
    }
}

/// Casts with a schedule that may miss a share of refreshes; times of a batch are known `latency` refreshes later.
pub(crate) fn simulate(
    workload: &mut Workload<'_>,
    predictor: Predictor,
    tolerated: f64,
    latency: usize,
    refreshes: u32,
) -> Outcome {
    let request = |refresh: u32| ViewRequest::new(refresh, workload.grid(), 1.0).unwrap();
    let mut schedule = CastSchedule::new(request(0), predictor).tolerating(tolerated);
    let requests: Vec<_> = (0..refreshes).map(request).collect();
    let mut outcome = Outcome::default();
    let mut waiting = VecDeque::new();
    let mut costs_s = vec![];
    for (refresh, request) in requests.into_iter().enumerate() {
        schedule.aim(request);
        if schedule.back().is_none() {
            costs_s = workload.costs_s(refresh as f64 * PERIOD_S);
        }
        let batch = schedule.plan(AVAILABLE_S).unwrap();
        let taken_s = workload.batch_s(batch.cells().iter().map(|&cell| costs_s[cell]));
        outcome.count(taken_s.iter().sum(), batch.completes_view());
        waiting.push_back((batch, taken_s));
        if waiting.len() > latency {
            let (batch, taken_s) = waiting.pop_front().unwrap();
            schedule.record(&batch, &taken_s).unwrap();
        }
    }
    outcome
}

/// Casts what an oracle knows to fit, by the same rules.
pub(crate) fn simulate_oracle(workload: &mut Workload<'_>, refreshes: u32) -> Outcome {
    let order = workload.grid().order();
    let mut outcome = Outcome::default();
    let mut left_s: Vec<f64> = vec![];
    for refresh in 0..refreshes {
        if left_s.is_empty() {
            let costs_s = workload.costs_s(f64::from(refresh) * PERIOD_S);
            left_s = order.iter().map(|&cell| costs_s[cell] * workload.noise()).collect();
        }
        let batch_s: Vec<f64> = left_s.drain(..oracle::fitting(&left_s, AVAILABLE_S)).collect();
        outcome.count(batch_s.iter().sum(), left_s.is_empty());
    }
    outcome
}
