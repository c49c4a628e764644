//! What cells took.

use super::{CellGrid, Expectation};

/// Least that a cell is expected to take, as a share of the mean cell: a body may have moved in.
const LEAST_SHARE: f64 = 0.02;

/// Durations of cells in seconds: of all cells of the last view, as far as known, and of those of the view under way that
/// have been measured.
#[derive(Debug, Clone, PartialEq)]
pub struct CellCosts {
    grid: CellGrid,
    work_per_pixel: f64,
    /// Of the last view, on the grid of this one; empty if there was none.
    last_s: Vec<f64>,
    mean_last_s: f64,
    /// What the last view lets expect of each cell.
    smoothed: Vec<Expectation>,
    measured_s: Vec<Option<f64>>,
    measured_cells: usize,
    measured_sum_s: f64,
    /// What the last view lets expect of the cells that have been measured.
    smoothed_sum_s: f64,
}

impl CellCosts {
    /// Nothing is known; the pixels of the first view take a relative amount of work each.
    pub fn new(grid: CellGrid, work_per_pixel: f64) -> Self {
        Self::after(vec![], grid, work_per_pixel)
    }

    fn after(last_s: Vec<f64>, grid: CellGrid, work_per_pixel: f64) -> Self {
        let mean_last_s = last_s.iter().sum::<f64>() / last_s.len().max(1) as f64;
        let smoothed = |cell| smoothed(&grid, &last_s, cell, mean_last_s);
        Self {
            grid,
            work_per_pixel,
            mean_last_s,
            smoothed: (0..last_s.len()).map(smoothed).collect(),
            last_s,
            measured_s: vec![None; grid.cells()],
            measured_cells: 0,
            measured_sum_s: 0.0,
            smoothed_sum_s: 0.0,
        }
    }

    /// The cells of the view under way.
    pub fn grid(&self) -> &CellGrid {
        &self.grid
    }

    /// What a cell took in the last view, seconds; what the place took, if that view had other cells.
    pub fn last_s(&self, cell: usize) -> Option<f64> {
        self.last_s.get(cell).copied()
    }

    /// What a cell took in this view, seconds.
    pub fn measured_s(&self, cell: usize) -> Option<f64> {
        self.measured_s.get(cell).copied().flatten()
    }

    /// Mean of the cells measured in this view, seconds.
    pub fn mean_measured_s(&self) -> Option<f64> {
        (self.measured_cells > 0).then(|| self.measured_sum_s / self.measured_cells as f64)
    }

    /// Whether the last view tells anything.
    pub(super) fn is_known(&self) -> bool {
        self.mean_last_s > 0.0
    }

    /// Cells measured in this view.
    pub(super) fn measured_cells(&self) -> usize {
        self.measured_cells
    }

    /// What the whole view that began last takes, seconds: as the one before, scaled by what has been measured of it.
    pub fn view_s(&self) -> Option<f64> {
        let cells = self.grid.cells() as f64;
        if self.last_s.is_empty() {
            return self.mean_measured_s().map(|mean_s| mean_s * cells);
        }
        Some(self.measured_sum_s + (self.mean_last_s * cells - self.smoothed_sum_s).max(0.0) * self.ratio())
    }

    /// A cell of the view under way has taken a finite time; only the first time counts.
    pub fn record(&mut self, cell: usize, seconds: f64) {
        let smoothed_s = self.smoothed(cell).map_or(0.0, |expected| expected.seconds);
        let Some(measured_s) = self.measured_s.get_mut(cell).filter(|measured_s| measured_s.is_none()) else {
            return;
        };
        *measured_s = Some(seconds);
        self.measured_cells += 1;
        self.measured_sum_s += seconds;
        self.smoothed_sum_s += smoothed_s;
    }

    /// A cell of the last view has taken a finite time, as is known only now.
    pub fn record_late(&mut self, cell: usize, seconds: f64) {
        let Some(last_s) = self.last_s.get_mut(cell) else { return };
        self.mean_last_s += (seconds - *last_s) / self.measured_s.len() as f64;
        *last_s = seconds;
        for (at, _) in self.grid.around(cell, 1) {
            self.smoothed[at] = smoothed(&self.grid, &self.last_s, at, self.mean_last_s);
        }
    }

    /// The view under way becomes the last one. What has not been measured of it is taken from the view before.
    #[must_use]
    pub fn next_view(&self, grid: CellGrid, work_per_pixel: f64) -> Self {
        let ratio = self.ratio();
        let unknown_s = self.mean_measured_s();
        let last_s: Option<Vec<f64>> = (0..self.grid.cells())
            .map(|cell| self.measured_s(cell).or(self.last_s(cell).map(|s| s * ratio)).or(unknown_s))
            .collect();
        let scale = work_per_pixel / self.work_per_pixel;
        let resampled = last_s.map(|last_s| resampled(&last_s, &self.grid, &grid, scale));
        Self::after(resampled.unwrap_or_default(), grid, work_per_pixel)
    }

    /// What the last view lets expect of a cell.
    pub(super) fn smoothed(&self, cell: usize) -> Option<Expectation> {
        self.smoothed.get(cell).copied()
    }

    /// Mean of the last view's cells, seconds.
    pub(super) fn mean_last_s(&self) -> f64 {
        self.mean_last_s
    }

    /// How many times as long as the last view this one takes, by the cells measured.
    pub(super) fn ratio(&self) -> f64 {
        // A cell's worth of the last view keeps a few cheap ones from saying much.
        let (measured_s, smoothed_s) =
            (self.measured_sum_s + self.mean_last_s, self.smoothed_sum_s + self.mean_last_s);
        if smoothed_s > 0.0 { measured_s / smoothed_s } else { 1.0 }
    }
}

/// Mean and variance about a cell, weighted 1-2-1 along both axes. The mean is less noisy than the cell itself and less off
/// where things move.
fn smoothed(grid: &CellGrid, seconds: &[f64], cell: usize, mean_of_all_s: f64) -> Expectation {
    let [weights, sum_s, sum_s2] =
        grid.around(cell, 1).fold([0.0; 3], |[weights, sum_s, sum_s2], (at, off)| {
            let (weight, s) = (((2 - off[0]) * (2 - off[1])) as f64, seconds[at]);
            [weights + weight, sum_s + weight * s, sum_s2 + weight * s * s]
        });
    let mean_s = sum_s / weights;
    let variance_s2 = (sum_s2 / weights - mean_s * mean_s).max(0.0);
    Expectation { seconds: mean_s + LEAST_SHARE * mean_of_all_s, variance_s2 }
}

/// Durations of the cells of one grid on those of another of the same view: spread evenly over each cell, and in proportion
/// to pixels and work per pixel.
fn resampled(seconds: &[f64], from: &CellGrid, to: &CellGrid, work_scale: f64) -> Vec<f64> {
    if from == to {
        return seconds.iter().map(|s| s * work_scale).collect();
    }
    let pixels = |grid: &CellGrid| grid.size().map(f64::from);
    let [to_from_x, to_from_y] = [0, 1].map(|axis| pixels(from)[axis] / pixels(to)[axis]);
    let [columns, rows] = from.dims();
    let side = f64::from(from.rect(0).columns.end.max(from.rect(0).rows.end));
    // Cells that an interval of pixels touches, and the share of each that lies within.
    let overlaps = |range: std::ops::Range<u32>, scale: f64, count: usize, size: f64| {
        let (start, end) = (f64::from(range.start) * scale, f64::from(range.end) * scale);
        let first = ((start / side) as usize).min(count - 1);
        let last = ((end / side).ceil() as usize).clamp(first + 1, count);
        (first..last)
            .map(|at| {
                let (low, high) = (at as f64 * side, ((at + 1) as f64 * side).min(size));
                (at, ((end.min(high) - start.max(low)) / (high - low)).max(0.0))
            })
            .collect::<Vec<_>>()
    };
    let scale = work_scale / (to_from_x * to_from_y);
    (0..to.cells())
        .map(|cell| {
            let rect = to.rect(cell);
            let across = overlaps(rect.columns, to_from_x, columns, pixels(from)[0]);
            let down = overlaps(rect.rows, to_from_y, rows, pixels(from)[1]);
            let sum_s: f64 = down
                .iter()
                .flat_map(|(j, high)| {
                    across.iter().map(move |(i, wide)| seconds[j * columns + i] * wide * high)
                })
                .sum();
            sum_s * scale
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grid(size: [u32; 2], side: u32) -> CellGrid {
        CellGrid::new(size, side).unwrap()
    }

    fn measured(grid: CellGrid, seconds: impl Fn(usize) -> f64) -> CellCosts {
        let mut costs = CellCosts::new(grid, 1.0);
        (0..grid.cells()).for_each(|cell| costs.record(cell, seconds(cell)));
        costs
    }

    #[test]
    fn what_is_measured_is_the_last_view_next_time() {
        let grid = grid([40, 30], 10);
        let costs = measured(grid, |cell| cell as f64);
        assert_eq!((costs.last_s(3), costs.measured_s(3)), (None, Some(3.0)));
        let mut next = costs.next_view(grid, 2.0);
        assert_eq!((next.last_s(3), next.measured_s(3)), (Some(6.0), None));
        assert_eq!(next.view_s(), Some(132.0));
        next.record_late(3, 0.0);
        assert_eq!((next.last_s(3), next.view_s()), (Some(0.0), Some(126.0)));
    }

    #[test]
    fn a_view_cut_short_keeps_what_was_known_of_the_rest() {
        let grid = grid([40, 40], 10);
        let mut costs = measured(grid, |_| 1.0).next_view(grid, 1.0);
        (0..8).for_each(|cell| costs.record(cell, 3.0));
        let view_s = costs.view_s().unwrap();
        assert!((40.0..48.0).contains(&view_s), "{view_s}");
        let next = costs.next_view(grid, 1.0);
        assert_eq!(next.last_s(7), Some(3.0));
        assert!(next.last_s(8).is_some_and(|s| s > 2.0 && s < 3.0));
    }

    #[test]
    fn cells_that_do_not_exist_and_second_times_are_left_out() {
        let mut costs = CellCosts::new(grid([20, 20], 10), 1.0);
        costs.record(4, 1.0);
        costs.record_late(0, 1.0);
        assert_eq!(costs.view_s(), None);
        costs.record(0, 1.0);
        costs.record(0, 5.0);
        assert_eq!(costs.mean_measured_s(), Some(1.0));
    }

    proptest! {
        #[test]
        fn another_grid_has_the_same_sum_per_pixel(
            sizes in prop::array::uniform4(1..90_u32), sides in prop::array::uniform2(4..40_u32),
        ) {
            let [from, to] = [grid([sizes[0], sizes[1]], sides[0]), grid([sizes[2], sizes[3]], sides[1])];
            let costs = measured(from, |cell| (cell % 7) as f64);
            let pixels = |grid: &CellGrid| grid.size().map(f64::from).iter().product::<f64>();
            let expected_s = costs.view_s().unwrap() * pixels(&to) / pixels(&from);
            let view_s = costs.next_view(to, 1.0).view_s().unwrap();
            prop_assert!((view_s - expected_s).abs() <= 1e-9 * expected_s, "{view_s} {expected_s}");
        }
    }
}
