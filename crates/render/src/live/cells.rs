//! The cells of a rig's views.

use crate::pacer::BAND_ROWS;
use crate::squares::Squares;
use wheatstone_core::budget::{BudgetError, CELLS_PER_REFRESH, CellGrid};

/// How small and how large cells are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct CellSizes {
    /// Pixels, a multiple of `BAND_ROWS`.
    smallest_side: u32,
    /// How many a refresh should hold: errors of their predictions cancel.
    per_refresh: f64,
    /// Time that a cell should take at least, seconds: that of its dispatches is to be a small part.
    shortest_s: f64,
}

impl CellSizes {
    /// Software runs eight rays at a time and takes 0.15 ms for a cell without any; where more refreshes may be missed, fewer cells do.
    /// Hardware needs as many rays at a time as it has lanes to be busy.
    pub(super) fn of(is_software: bool) -> Self {
        if is_software {
            Self { smallest_side: 16, per_refresh: 30.0, shortest_s: 4e-4 }
        } else {
            Self { smallest_side: 32, per_refresh: CELLS_PER_REFRESH, shortest_s: 2e-4 }
        }
    }

    /// Side of the first cells, pixels.
    pub(super) fn first_side(self) -> u32 {
        2 * self.smallest_side
    }

    /// Side of the cells of views that may show something in so many pixels and take some seconds, pixels.
    pub(super) fn side(self, covered_px: f64, view_s: f64, refresh_s: f64) -> u32 {
        let cell_s = (refresh_s / self.per_refresh).max(self.shortest_s);
        let side = (covered_px * cell_s / view_s).sqrt();
        (side as u32 / BAND_ROWS * BAND_ROWS).clamp(self.smallest_side, 8 * self.smallest_side)
    }
}

/// The views of a rig as one picture, one below the other, cut into cells that are each of one view.
#[derive(Debug, Clone, Copy)]
pub(super) struct RigCells {
    grid: CellGrid,
    /// Rows from a view to the next.
    pitch: u32,
    height: u32,
}

impl RigCells {
    /// Cells of views of a width and height, with sides of so many pixels or more, if there are too many else.
    pub(super) fn new([width, height]: [u32; 2], views: usize, side: u32) -> Result<Self, BudgetError> {
        let pitch = height.next_multiple_of(side);
        let rows = u32::try_from(views - 1).unwrap_or(u32::MAX).saturating_mul(pitch).saturating_add(height);
        match CellGrid::new([width, rows], side) {
            Ok(grid) => Ok(Self { grid, pitch, height }),
            Err(BudgetError::Cells { .. }) => Self::new([width, height], views, 2 * side),
            Err(error) => Err(error),
        }
    }

    pub(super) fn grid(&self) -> CellGrid {
        self.grid
    }

    /// The view that a cell is of, and its squares there.
    pub(super) fn squares(&self, cell: usize) -> (usize, Squares) {
        let mut rect = self.grid.rect(cell);
        let view = rect.rows.start / self.pitch;
        rect.rows = rect.rows.start - view * self.pitch..(rect.rows.end - view * self.pitch).min(self.height);
        (view as usize, Squares::of(&rect))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_square_of_every_view_is_in_one_cell() {
        let cells = RigCells::new([70, 45], 2, 16).unwrap();
        let mut seen = [[[0; 9]; 6]; 2];
        for cell in 0..cells.grid().cells() {
            let (view, squares) = cells.squares(cell);
            for band in squares.bands {
                squares.columns.clone().for_each(|column| seen[view][band as usize][column as usize] += 1);
            }
        }
        assert!(seen.iter().flatten().flatten().all(|&count| count == 1), "{seen:?}");
    }

    #[test]
    fn a_refresh_holds_as_many_cells_as_it_should_while_a_view_takes_many() {
        for (is_software, refresh_s) in [(false, 9.1e-3), (true, 38e-3)] {
            let sizes = CellSizes::of(is_software);
            for refreshes in [5.0, 10.0, 20.0] {
                let side = sizes.side(1024.0 * 1024.0, refreshes * refresh_s, refresh_s);
                let cells = RigCells::new([1024, 1024], 1, side).unwrap().grid().cells();
                assert!(cells as f64 >= refreshes * sizes.per_refresh, "{is_software} {refreshes}: {cells}");
            }
        }
    }

    #[test]
    fn dear_views_have_small_cells_and_too_many_are_avoided() {
        let side = |view_s| CellSizes::of(true).side(768.0 * 768.0, view_s, 0.02);
        assert_eq!([0.0, 0.2, 1e4].map(side), [128, 40, 16]);
        let cells = RigCells::new([8192, 8192], 2, 16).unwrap();
        assert!(cells.grid().cells() <= 1 << 16);
        assert!(RigCells::new([0, 5], 1, 16).is_err());
    }
}
