//! What a cell will take.

use super::CellCosts;

/// Distance in cells up to which cells measured in this view tell of a cell.
const NEAR: usize = 3;

/// Weight of the whole view's ratio beside those of near cells, in mean cells.
const WHOLE_VIEW_CELLS: f64 = 2.0;

/// Deviation of a cell of which nothing is known, as a share of the mean cell.
const DEVIATION_OF_ANY: f64 = 0.5;

/// Deviation of a cell that is like all those about it, as a share of its time or of the mean cell's, whichever is more.
const LEAST_DEVIATION: f64 = 0.1;

/// How to predict the time of a cell that has not been cast in this view.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Predictor {
    /// VR Alg. 5: mean, over the cell's neighbours in the last view, of the larger of the two, times a bias.
    Neighbourhood {
        /// b ≥ 1: the only reserve that is kept.
        bias: f64,
    },
    /// The last view's mean about the cell, times how much longer the near cells of this view took than such means had let
    /// expect. The more cells differ from those about them, the more may it be off: the variance. How many deviations to reserve
    /// is learnt from whole batches.
    Corrected,
}

/// What is expected of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Expectation {
    /// Time to cast it, seconds.
    pub seconds: f64,
    /// Variance to reserve time for, seconds²; 0 if the time holds a reserve.
    pub variance_s2: f64,
}

impl Predictor {
    /// What is expected of a cell; nothing if no cell has been measured yet. Before there is a last view it is the mean of the
    /// cells measured in this one.
    pub fn predict(&self, costs: &CellCosts, cell: usize) -> Option<Expectation> {
        let of_last_view = match *self {
            Self::Neighbourhood { bias } => {
                neighbourhood_s(costs, cell).map(|s| Expectation { seconds: bias * s, variance_s2: 0.0 })
            }
            Self::Corrected => corrected(costs, cell),
        };
        of_last_view.or_else(|| {
            let mean_s = costs.mean_measured_s()?;
            Some(match *self {
                Self::Neighbourhood { bias } => Expectation { seconds: bias * mean_s, variance_s2: 0.0 },
                Self::Corrected => {
                    Expectation { seconds: mean_s, variance_s2: (DEVIATION_OF_ANY * mean_s).powi(2) }
                }
            })
        })
    }
}

fn neighbourhood_s(costs: &CellCosts, cell: usize) -> Option<f64> {
    let own_s = costs.last_s(cell)?;
    let neighbours = costs.grid().around(cell, 1).filter(|(at, _)| *at != cell);
    let (sum_s, count) = neighbours.fold((0.0, 0.0), |(sum_s, count), (at, _)| {
        (sum_s + own_s.max(costs.last_s(at).unwrap_or(0.0)), count + 1.0)
    });
    Some(if count > 0.0 { sum_s / count } else { own_s })
}

fn corrected(costs: &CellCosts, cell: usize) -> Option<Expectation> {
    let smoothed = costs.smoothed(cell)?;
    let prior_s = WHOLE_VIEW_CELLS * costs.mean_last_s();
    if prior_s == 0.0 {
        return None;
    }
    let (mut measured_sum_s, mut smoothed_sum_s) = (prior_s * costs.ratio(), prior_s);
    for (at, off) in costs.grid().around(cell, NEAR) {
        if let (Some(measured_s), Some(smoothed)) = (costs.measured_s(at), costs.smoothed(at)) {
            let weight = 1.0 / off.iter().map(|o| o * o).sum::<usize>().max(1) as f64;
            measured_sum_s += weight * measured_s;
            smoothed_sum_s += weight * smoothed.seconds;
        }
    }
    let ratio = measured_sum_s / smoothed_sum_s;
    let seconds = ratio * smoothed.seconds;
    let variance_s2 = ratio * ratio * smoothed.variance_s2
        + (LEAST_DEVIATION * seconds.max(ratio * costs.mean_last_s())).powi(2);
    Some(Expectation { seconds, variance_s2 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::CellGrid;

    fn after(seconds: [f64; 9]) -> CellCosts {
        let grid = CellGrid::new([3, 3], 1).unwrap();
        let mut costs = CellCosts::new(grid, 1.0);
        (0..9).for_each(|cell| costs.record(cell, seconds[cell]));
        costs.next_view(grid, 1.0)
    }

    fn seconds(predictor: Predictor, costs: &CellCosts, cell: usize) -> Option<f64> {
        predictor.predict(costs, cell).map(|expected| expected.seconds)
    }

    #[test]
    fn algorithm_5_is_a_mean_of_maxima() {
        let costs = after([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
        let predict_s = |cell| Predictor::Neighbourhood { bias: 1.1 }.predict(&costs, cell).unwrap().seconds;
        assert!((predict_s(4) - 1.1 * (4.0 * 5.0 + 30.0) / 8.0).abs() < 1e-12);
        assert!((predict_s(0) - 1.1 * 11.0 / 3.0).abs() < 1e-12);
        assert!((predict_s(8) - 1.1 * 9.0).abs() < 1e-12);
    }

    #[test]
    fn nothing_is_known_before_the_first_cell() {
        let mut costs = CellCosts::new(CellGrid::new([2, 1], 1).unwrap(), 1.0);
        for predictor in [Predictor::Corrected, Predictor::Neighbourhood { bias: 1.0 }] {
            assert_eq!(predictor.predict(&costs, 0), None);
        }
        costs.record(0, 0.25);
        assert_eq!(seconds(Predictor::Corrected, &costs, 1), Some(0.25));
        assert_eq!(seconds(Predictor::Neighbourhood { bias: 2.0 }, &costs, 1), Some(0.5));
    }

    #[test]
    fn near_cells_that_took_longer_make_a_cell_dearer() {
        let mut costs = after([1.0; 9]);
        let before_s = seconds(Predictor::Corrected, &costs, 1).unwrap();
        assert!((before_s - 1.02).abs() < 1e-12);
        [3, 4, 5].into_iter().for_each(|cell| costs.record(cell, 3.0));
        let after_s = seconds(Predictor::Corrected, &costs, 1).unwrap();
        assert!((1.8..3.0).contains(&after_s), "{after_s}");
    }

    #[test]
    fn a_view_that_took_no_time_at_all_predicts() {
        let mut costs = after([0.0; 9]);
        assert_eq!(seconds(Predictor::Corrected, &costs, 0), None);
        costs.record(0, 1.0);
        assert_eq!(seconds(Predictor::Corrected, &costs, 1), Some(1.0));
    }
}
