//! The smallest and the largest number that trilinear samples in each block read.

use super::BlockGrid;
use rayon::prelude::*;
use std::ops::Range;

/// The smallest and the largest of the voxels that each block reads.
#[derive(Debug)]
pub(super) struct Extremes<T> {
    pub(super) lo: Vec<T>,
    pub(super) hi: Vec<T>,
}

impl<T: Copy + PartialOrd + Send + Sync> Extremes<T> {
    /// Of the blocks of a grid over the voxels that it was made for.
    pub(super) fn new(grid: &BlockGrid, voxels: &[T]) -> Self {
        let layer = grid.dims()[0] * grid.dims()[1];
        let mut all =
            Self { lo: vec![voxels[0]; grid.block_count()], hi: vec![voxels[0]; grid.block_count()] };
        let layers = all.lo.par_chunks_mut(layer).zip(all.hi.par_chunks_mut(layer)).enumerate();
        layers.for_each(|(z, (lo, hi))| fill_layer(grid, voxels, grid.voxels_read(2, z), lo, hi));
        all
    }

    fn rows_with_capacity(capacity: usize) -> Self {
        Self { lo: Vec::with_capacity(capacity), hi: Vec::with_capacity(capacity) }
    }
}

/// Finds those of a layer of blocks, along z, then y, then x: each stage leaves less to the next.
fn fill_layer<T: Copy + PartialOrd + Send + Sync>(
    grid: &BlockGrid,
    voxels: &[T],
    slices: Range<usize>,
    lo: &mut [T],
    hi: &mut [T],
) {
    let [width, height, _] = grid.volume_dims();
    let blocks_x = grid.dims()[0];
    let side = grid.block_size().sides()[0] as usize;
    let mut plane = Extremes::rows_with_capacity(width * height);
    for y in 0..height {
        let rows = slices.clone().map(|slice| &voxels[(slice * height + y) * width..][..width]);
        append_extreme(&mut plane.lo, rows.clone(), lesser);
        append_extreme(&mut plane.hi, rows, greater);
    }
    let mut row = Extremes::rows_with_capacity(width);
    let mut padded = Vec::with_capacity(blocks_x * side + 2);
    let blocks = lo.chunks_exact_mut(blocks_x).zip(hi.chunks_exact_mut(blocks_x));
    for (block_y, (lo, hi)) in blocks.enumerate() {
        let rows = grid.voxels_read(1, block_y).map(|y| y * width..(y + 1) * width);
        row.lo.clear();
        row.hi.clear();
        append_extreme(&mut row.lo, rows.clone().map(|row| &plane.lo[row]), lesser);
        append_extreme(&mut row.hi, rows.map(|row| &plane.hi[row]), greater);
        fill_row(lo, &row.lo, side, &mut padded, lesser);
        fill_row(hi, &row.hi, side, &mut padded, greater);
    }
}

/// Appends the extreme of each column of some rows.
fn append_extreme<'a, T: Copy + 'a>(
    to: &mut Vec<T>,
    mut rows: impl Iterator<Item = &'a [T]>,
    extreme: impl Fn(T, T) -> T,
) {
    let start = to.len();
    to.extend_from_slice(rows.next().unwrap_or_default());
    for row in rows {
        for (so_far, &number) in to[start..].iter_mut().zip(row) {
            *so_far = extreme(*so_far, number);
        }
    }
}

/// Finds the extremes of what a row of blocks reads of a row of voxels.
fn fill_row<T: Copy>(
    blocks: &mut [T],
    voxels: &[T],
    side: usize,
    padded: &mut Vec<T>,
    extreme: impl Fn(T, T) -> T,
) {
    // The halo before the first block and after the last is its outermost voxel.
    padded.clear();
    padded.push(voxels[0]);
    padded.extend_from_slice(voxels);
    padded.resize(blocks.len() * side + 2, voxels[voxels.len() - 1]);
    // Each doubling makes of extremes of `reach` neighbours those of twice as many.
    let window = side + 2;
    let mut reach = 1;
    while 2 * reach <= window {
        for i in 0..padded.len() - reach {
            padded[i] = extreme(padded[i], padded[i + reach]);
        }
        reach *= 2;
    }
    for (block, first) in blocks.iter_mut().zip((0..).step_by(side)) {
        *block = extreme(padded[first], padded[first + window - reach]);
    }
}

fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

fn greater<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}
