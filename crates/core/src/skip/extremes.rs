//! The smallest and the largest number that trilinear samples in each block read.

use super::BlockGrid;
use rayon::prelude::*;
use std::ops::Range;

/// Layers of blocks that a thread takes at once, so that slices on the border of two layers are fetched less often.
const LAYERS: usize = 4;

/// Smallest and largest of the voxels that each block reads. `slices` fetches whole slices of the volume.
pub(super) fn extremes<T, S>(grid: &BlockGrid, slices: impl Fn(Range<usize>) -> S + Sync) -> Vec<[T; 2]>
where
    T: Copy + PartialOrd + Send + Sync,
    S: AsRef<[T]>,
{
    let [width, height, _] = grid.volume_dims();
    let layers = grid.dims()[2];
    let of_layers = |first: usize| {
        let end = (first + LAYERS).min(layers);
        let fetched = grid.voxels_read(2, first).start..grid.voxels_read(2, end - 1).end;
        let voxels = slices(fetched.clone());
        let mut found = Vec::with_capacity((end - first) * grid.dims()[0] * grid.dims()[1]);
        for layer in first..end {
            let read = grid.voxels_read(2, layer);
            let size = width * height;
            let of_layer = (read.start - fetched.start) * size..(read.end - fetched.start) * size;
            append_layer(grid, &voxels.as_ref()[of_layer], &mut found);
        }
        found
    };
    (0..layers).into_par_iter().step_by(LAYERS).flat_map_iter(of_layers).collect()
}

/// Reduces the slices that a layer of blocks reads: along z and y row by row, then along x.
fn append_layer<T: Copy + PartialOrd>(grid: &BlockGrid, slices: &[T], found: &mut Vec<[T; 2]>) {
    let [width, height, _] = grid.volume_dims();
    // Of each row, over all slices.
    let (mut lo, mut hi) = (slices[..width * height].to_vec(), slices[..width * height].to_vec());
    for slice in slices.chunks_exact(width * height).skip(1) {
        widen(&mut lo, &mut hi, slice, slice);
    }
    for block_y in 0..grid.dims()[1] {
        let rows = grid.voxels_read(1, block_y);
        let row = |y: usize| y * width..(y + 1) * width;
        let (mut row_lo, mut row_hi) = (lo[row(rows.start)].to_vec(), hi[row(rows.start)].to_vec());
        for y in rows.skip(1) {
            widen(&mut row_lo, &mut row_hi, &lo[row(y)], &hi[row(y)]);
        }
        found.extend((0..grid.dims()[0]).map(|block_x| {
            let columns = grid.voxels_read(0, block_x);
            let smallest = row_lo[columns.clone()].iter().copied().reduce(lesser);
            let largest = row_hi[columns.clone()].iter().copied().reduce(greater);
            [smallest.unwrap_or(row_lo[columns.start]), largest.unwrap_or(row_hi[columns.start])]
        }));
    }
}

/// Widens intervals, element by element.
fn widen<T: Copy + PartialOrd>(lo: &mut [T], hi: &mut [T], other_lo: &[T], other_hi: &[T]) {
    for (lo, &other) in lo.iter_mut().zip(other_lo) {
        *lo = lesser(*lo, other);
    }
    for (hi, &other) in hi.iter_mut().zip(other_hi) {
        *hi = greater(*hi, other);
    }
}

fn lesser<T: PartialOrd>(a: T, b: T) -> T {
    if b < a { b } else { a }
}

fn greater<T: PartialOrd>(a: T, b: T) -> T {
    if b > a { b } else { a }
}
