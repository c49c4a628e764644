use crate::simulation::PERIOD_S;
use crate::workload::{Balls, Workload};
use wheatstone_core::budget::{CellCosts, CellGrid, Predictor};

const VIEWS: usize = 40;
const VIEW_S: f64 = 10.0 * PERIOD_S;
const CELLS_PER_BATCH: usize = 64;

/// Root mean square errors of cells and of batches, each as a share of the mean cell and batch, once two views are known.
fn errors(predictor: Predictor, speed: f64) -> [f64; 2] {
    let grid = CellGrid::new([1024, 1024], 32).unwrap();
    let balls = Balls { speed };
    let mut workload = Workload::new(grid, VIEW_S, &balls, 7);
    let order = grid.order();
    let mut costs = CellCosts::new(grid, 1.0);
    let (mut cell_error_s2, mut batch_error_s2) = (0.0, 0.0);
    for view in 0..VIEWS {
        let true_s = workload.costs_s(view as f64 * VIEW_S);
        for batch in order.chunks(CELLS_PER_BATCH) {
            let off_s = |cell: &usize| Some(predictor.predict(&costs, *cell)?.seconds - true_s[*cell]);
            let off_s: Vec<f64> = batch.iter().filter_map(off_s).collect();
            if view >= 2 {
                cell_error_s2 += off_s.iter().map(|s| s * s).sum::<f64>();
                batch_error_s2 += off_s.iter().sum::<f64>().powi(2);
            }
            batch.iter().for_each(|&cell| costs.record(cell, true_s[cell] * workload.noise()));
        }
        costs = costs.next_view(grid, 1.0);
    }
    let cells = ((VIEWS - 2) * grid.cells()) as f64;
    let mean_s = VIEW_S / grid.cells() as f64;
    let batches = cells / CELLS_PER_BATCH as f64;
    [
        (cell_error_s2 / cells).sqrt() / mean_s,
        (batch_error_s2 / batches).sqrt() / (mean_s * CELLS_PER_BATCH as f64),
    ]
}

#[test]
fn corrected_expectations_are_nearer_to_the_truth_than_algorithm_5_of_any_bias() {
    for (speed, bias) in
        [0.0, 0.5, 1.5].iter().flat_map(|&speed| [0.8, 0.85, 0.9, 0.95, 1.0].map(|bias| (speed, bias)))
    {
        let [cell, batch] = errors(Predictor::Corrected, speed);
        let [thesis_cell, thesis_batch] = errors(Predictor::Neighbourhood { bias }, speed);
        let case = format!(
            "speed {speed}, b = {bias}: cells {cell:.3} {thesis_cell:.3}, batches {batch:.4} {thesis_batch:.4}"
        );
        assert!(cell < thesis_cell && batch < thesis_batch, "{case}");
    }
}
