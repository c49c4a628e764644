//! The cells of a picture.

use super::BudgetError;
use crate::view::PixelRect;

/// Most cells of a grid.
const MOST_CELLS: u64 = 1 << 16;

/// A picture cut into square cells (VR §5.2), row by row from the top left; those at the right and the bottom may be
/// narrower. A cell is the least that is cast at once: where a refresh holds twenty cells or more, errors of their
/// predictions cancel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CellGrid {
    size: [u32; 2],
    cell_side_px: u32,
}

impl CellGrid {
    /// Cuts a picture of the given width and height in pixels. A side that is a multiple of 8 keeps workgroups whole.
    ///
    /// # Errors
    /// An empty picture or cell, or more than 65,536 cells.
    pub fn new(size: [u32; 2], cell_side_px: u32) -> Result<Self, BudgetError> {
        if size.contains(&0) || cell_side_px == 0 {
            return Err(BudgetError::Empty { size, cell_side_px });
        }
        let cells = size.map(|side| u64::from(side.div_ceil(cell_side_px))).iter().product();
        if cells > MOST_CELLS {
            return Err(BudgetError::Cells { cells, most: MOST_CELLS });
        }
        Ok(Self { size, cell_side_px })
    }

    /// Width and height of the picture, pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Cells side by side and one above the other.
    pub fn dims(&self) -> [usize; 2] {
        self.size.map(|side| side.div_ceil(self.cell_side_px) as usize)
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.dims().iter().product()
    }

    /// The pixels of a cell; none beyond the last cell.
    pub fn rect(&self, cell: usize) -> PixelRect {
        let [columns, _] = self.dims();
        let range = |at: usize, size: u32| {
            let edge = |at: usize| {
                let pixel = at as u64 * u64::from(self.cell_side_px);
                u32::try_from(pixel).unwrap_or(u32::MAX).min(size)
            };
            edge(at)..edge(at + 1)
        };
        PixelRect { columns: range(cell % columns, self.size[0]), rows: range(cell / columns, self.size[1]) }
    }

    /// All cells in the order in which to cast them: ever finer lattices, as in Bayer's dither matrix. The thesis lets indices
    /// ascend; here each batch is spread over the picture, so that what moves is dearer in some of its cells and cheaper in
    /// others, and all cells but the first have near ones that have been measured in the same view.
    pub fn order(&self) -> Vec<usize> {
        let [columns, _] = self.dims();
        let rank = |&cell: &usize| {
            let [x, y] = [cell % columns, cell / columns];
            let digit = |bit: u32| ((x ^ y) >> bit & 1) << 1 | y >> bit & 1;
            (0..u16::BITS).fold(0, |rank, bit| rank << 2 | digit(bit) as u64)
        };
        let mut order: Vec<usize> = (0..self.cells()).collect();
        order.sort_by_cached_key(rank);
        order
    }

    /// The cells up to a distance in cells along either axis, itself included, each with how far away it is along both.
    pub(super) fn around(&self, cell: usize, distance: usize) -> impl Iterator<Item = (usize, [usize; 2])> {
        let [columns, rows] = self.dims();
        let [x, y] = [cell % columns, cell / columns];
        let near = move |at: usize, count: usize| at.saturating_sub(distance)..(at + distance + 1).min(count);
        near(y, rows).flat_map(move |j| {
            near(x, columns).map(move |i| (j * columns + i, [i.abs_diff(x), j.abs_diff(y)]))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn grids_without_area_or_end_are_refused() {
        assert!(matches!(CellGrid::new([0, 4], 2), Err(BudgetError::Empty { .. })));
        assert!(matches!(CellGrid::new([4, 4], 0), Err(BudgetError::Empty { .. })));
        assert!(matches!(CellGrid::new([u32::MAX; 2], 1), Err(BudgetError::Cells { .. })));
        let widest = CellGrid::new([u32::MAX; 2], u32::MAX - 1).unwrap();
        assert_eq!(widest.rect(3).columns, u32::MAX - 1..u32::MAX);
    }

    #[test]
    fn every_part_of_the_order_is_spread_over_the_picture() {
        let grid = CellGrid::new([80, 80], 10).unwrap();
        let order = grid.order();
        assert_eq!(order[..4], [0, 36, 4, 32]);
        for part in order.chunks(16) {
            let mut quarters = [0; 4];
            part.iter().for_each(|cell| quarters[cell % 8 / 4 + cell / 32 * 2] += 1);
            assert_eq!(quarters, [4; 4]);
        }
    }

    proptest! {
        #[test]
        fn cells_cover_every_pixel_once(width in 1..70_u32, height in 1..70_u32, side in 1..40_u32) {
            let grid = CellGrid::new([width, height], side).unwrap();
            let mut covered = vec![0; (width * height) as usize];
            for rect in (0..grid.cells()).map(|cell| grid.rect(cell)) {
                prop_assert!(!rect.columns.is_empty() && !rect.rows.is_empty());
                for (x, y) in rect.rows.flat_map(|y| rect.columns.clone().map(move |x| (x, y))) {
                    covered[(y * width + x) as usize] += 1;
                }
            }
            prop_assert!(covered.iter().all(|&times| times == 1));
        }

        #[test]
        fn the_order_has_every_cell_once(width in 1..200_u32, height in 1..200_u32, side in 8..40_u32) {
            let grid = CellGrid::new([width, height], side).unwrap();
            let mut sorted = grid.order();
            sorted.sort_unstable();
            prop_assert!(sorted.into_iter().eq(0..grid.cells()));
        }
    }
}
