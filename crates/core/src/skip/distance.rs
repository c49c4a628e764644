//! Chebyshev distances on a grid, dimension by dimension.
//!
//! One step from a cell towards a cell in an earlier plane shortens the distance by one, whichever of the neighbours in
//! the plane before is taken first. So the distance to the nearest occupied cell in this plane or an earlier one is
//!
//! `D(x, y, z) = min(E(x, y, z), 1 + min D(x′, y′, z − 1))`
//!
//! over the neighbours (x′, y′) of (x, y), where E is the distance within the plane, found from rows in the same way, and
//! those from cells. Neighbouring cells do not wait for each other (DM Algorithms 2 and 3 search; this takes one read of
//! the plane before).

use rayon::prelude::*;

/// Along an axis, where occupied cells count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reach {
    /// On both sides.
    Both,
    /// At higher indices.
    Up,
    /// At lower indices.
    Down,
}

impl Reach {
    fn is_up(self) -> bool {
        self != Self::Down
    }

    fn is_down(self) -> bool {
        self != Self::Up
    }
}

/// From 0 for occupied cells and 255 for empty ones to the distances along x.
pub(super) fn along_x(cells: &mut [u8], dims: [usize; 3], reach: Reach) {
    cells.par_chunks_mut(dims[0]).with_min_len(256).for_each(|row| {
        let nearer = |before: u8, cell: &mut u8| {
            *cell = (*cell).min(before.saturating_add(1));
            *cell
        };
        if reach.is_down() {
            row.iter_mut().fold(u8::MAX, nearer);
        }
        if reach.is_up() {
            row.iter_mut().rev().fold(u8::MAX, nearer);
        }
    });
}

/// From distances along x to those within planes.
pub(super) fn along_y(cells: &mut [u8], [width, height, _]: [usize; 3], reach: [Reach; 2]) {
    cells.par_chunks_mut(width * height).for_each(|plane| {
        let mut nearest = vec![u8::MAX; width + 2];
        each_after_another(plane, width, reach[1], |before, row| {
            nearest[1..=width].copy_from_slice(before);
            step_towards(&nearest, row, reach[0]);
        });
    });
}

/// From distances within planes to those in space.
pub(super) fn along_z(cells: &mut [u8], [width, height, _]: [usize; 3], reach: [Reach; 3]) {
    let mut nearest = vec![u8::MAX; width + 2];
    each_after_another(cells, width * height, reach[2], |before, plane| {
        for (y, row) in plane.chunks_exact_mut(width).enumerate() {
            let first = if reach[1].is_down() { y.saturating_sub(1) } else { y };
            let last = if reach[1].is_up() { (y + 1).min(height - 1) } else { y };
            nearest[1..=width].copy_from_slice(&before[first * width..(first + 1) * width]);
            for neighbour in before[(first + 1) * width..(last + 1) * width].chunks_exact(width) {
                for (nearest, &cell) in nearest[1..=width].iter_mut().zip(neighbour) {
                    *nearest = cell.min(*nearest);
                }
            }
            step_towards(&nearest, row, reach[0]);
        }
    });
}

/// Visits each part of the cells with the one before it in the direction, or directions, of the reach.
fn each_after_another(cells: &mut [u8], part: usize, reach: Reach, mut visit: impl FnMut(&[u8], &mut [u8])) {
    let count = cells.len() / part;
    if reach.is_down() {
        for i in 1..count {
            let (before, after) = cells.split_at_mut(i * part);
            visit(&before[(i - 1) * part..], &mut after[..part]);
        }
    }
    if reach.is_up() {
        for i in (1..count).rev() {
            let (before, after) = cells.split_at_mut(i * part);
            visit(&after[..part], &mut before[(i - 1) * part..]);
        }
    }
}

/// Takes a step to the nearest of the neighbours along x in a row that has 255 before and after it, where that is shorter.
fn step_towards(neighbours: &[u8], row: &mut [u8], reach: Reach) {
    let width = row.len();
    let (below, same, above) = (&neighbours[..width], &neighbours[1..=width], &neighbours[2..]);
    match reach {
        Reach::Both => {
            for (((cell, &a), &b), &c) in row.iter_mut().zip(below).zip(same).zip(above) {
                *cell = (*cell).min(a.min(b).min(c).saturating_add(1));
            }
        }
        Reach::Up => {
            for ((cell, &b), &c) in row.iter_mut().zip(same).zip(above) {
                *cell = (*cell).min(b.min(c).saturating_add(1));
            }
        }
        Reach::Down => {
            for ((cell, &a), &b) in row.iter_mut().zip(below).zip(same) {
                *cell = (*cell).min(a.min(b).saturating_add(1));
            }
        }
    }
}
