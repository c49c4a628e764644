//! Trilinear sampling of the stored voxels.

use super::lanes::Lanes;
use super::lanes_wide::each_lane;
use super::vector::Vec3;
use crate::volume::StoredVoxels;
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u32x16};
use glam::Vec3A;
use rayon::prelude::*;

/// A stored voxel as the sampler reads it.
pub(super) trait Stored: Copy + Send + Sync {
    /// Four voxels in as few machine words as they fit.
    type Four: Copy;

    fn to_f64(self) -> f64;

    fn four(voxels: [Self; 4]) -> Self::Four;

    /// The first, second, third and fourth voxels of sixteen fours.
    fn split<S: Simd>(simd: S, fours: [Self::Four; 16]) -> [f32x16<S>; 4];
}

impl Stored for u8 {
    type Four = u32;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn four(voxels: [Self; 4]) -> u32 {
        u32::from_le_bytes(voxels)
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, fours: [u32; 16]) -> [f32x16<S>; 4] {
        let fours = u32x16::load_array(simd, fours);
        [
            (fours & 0xff).to_float(),
            ((fours >> 8) & 0xff).to_float(),
            ((fours >> 16) & 0xff).to_float(),
            (fours >> 24).to_float(),
        ]
    }
}

impl Stored for u16 {
    type Four = [u32; 2];

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn four([a, b, c, d]: [Self; 4]) -> [u32; 2] {
        [u32::from(a) | u32::from(b) << 16, u32::from(c) | u32::from(d) << 16]
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, fours: [[u32; 2]; 16]) -> [f32x16<S>; 4] {
        let first = u32x16::load_array(simd, each_lane!(lane => fours[lane][0]));
        let second = u32x16::load_array(simd, each_lane!(lane => fours[lane][1]));
        [
            (first & 0xffff).to_float(),
            (first >> 16).to_float(),
            (second & 0xffff).to_float(),
            (second >> 16).to_float(),
        ]
    }
}

impl Stored for f32 {
    type Four = [Self; 4];

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn four(voxels: [Self; 4]) -> [Self; 4] {
        voxels
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, fours: [[Self; 4]; 16]) -> [f32x16<S>; 4] {
        [
            f32x16::load_array(simd, each_lane!(lane => fours[lane][0])),
            f32x16::load_array(simd, each_lane!(lane => fours[lane][1])),
            f32x16::load_array(simd, each_lane!(lane => fours[lane][2])),
            f32x16::load_array(simd, each_lane!(lane => fours[lane][3])),
        ]
    }
}

/// Layers around the volume: what a trilinear sample one voxel outside reads.
const PADDING: usize = 2;

/// Voxels with their outermost layer repeated around, so that every trilinear sample up to one voxel outside the volume
/// reads its eight neighbours without a test.
#[derive(Debug)]
pub(super) struct PaddedVoxels {
    voxels: StoredVoxels,
    dims: Vec3A,
    row: usize,
    slice: usize,
}

impl PaddedVoxels {
    pub(super) fn new(dims: [usize; 3], voxels: &StoredVoxels) -> Self {
        let voxels = match voxels {
            StoredVoxels::U8(v) => StoredVoxels::U8(padded(dims, v)),
            StoredVoxels::U16(v) => StoredVoxels::U16(padded(dims, v)),
            StoredVoxels::F32(v) => StoredVoxels::F32(padded(dims, v)),
        };
        let row = dims[0] + 2 * PADDING;
        let slice = row * (dims[1] + 2 * PADDING);
        Self { voxels, dims: Vec3A::from(dims.map(|n| n as f32)), row, slice }
    }

    /// Voxels held, the padding with them.
    pub(super) fn len(&self) -> usize {
        match &self.voxels {
            StoredVoxels::U8(v) => v.len(),
            StoredVoxels::U16(v) => v.len(),
            StoredVoxels::F32(v) => v.len(),
        }
    }

    /// Pairs of neighbours along x, from the voxel on that is `offset` away from a cell's first one; in rows `row` and
    /// slices `slice` apart: see [`Lanes::neighbours`].
    #[inline(always)]
    fn neighbours<L: Lanes>(
        &self,
        token: L::Token,
        index: L::Index,
        offset: isize,
        row: usize,
        slice: usize,
    ) -> [[L; 2]; 4] {
        let start = (1 + self.row + self.slice).wrapping_add_signed(offset);
        match &self.voxels {
            StoredVoxels::U8(v) => L::neighbours(token, &v[start..], index, row, slice),
            StoredVoxels::U16(v) => L::neighbours(token, &v[start..], index, row, slice),
            StoredVoxels::F32(v) => L::neighbours(token, &v[start..], index, row, slice),
        }
    }

    /// Rows of four voxels along x around a cell: see [`Lanes::rows_of_four`].
    #[inline(always)]
    fn rows_of_four<L: Lanes>(&self, token: L::Token, index: L::Index) -> [[L; 4]; 4] {
        let Self { row, slice, .. } = *self;
        let start = row + slice;
        match &self.voxels {
            StoredVoxels::U8(v) => L::rows_of_four(token, &v[start..], index, row, slice),
            StoredVoxels::U16(v) => L::rows_of_four(token, &v[start..], index, row, slice),
            StoredVoxels::F32(v) => L::rows_of_four(token, &v[start..], index, row, slice),
        }
    }
}

fn padded<T: Stored>([width, height, depth]: [usize; 3], voxels: &[T]) -> Vec<T> {
    let inside = |i: usize, count: usize| i.clamp(PADDING, PADDING + count - 1) - PADDING;
    (0..depth + 2 * PADDING)
        .into_par_iter()
        .flat_map_iter(|z| (0..height + 2 * PADDING).map(move |y| (y, z)))
        .flat_map_iter(|(y, z)| {
            let start = (inside(z, depth) * height + inside(y, height)) * width;
            let row = &voxels[start..start + width];
            let [first, last] = [row[0], row[width - 1]].map(|end| std::iter::repeat_n(end, PADDING));
            first.chain(row.iter().copied()).chain(last)
        })
        .collect()
}

/// A volume seen through a window: the normalised value anywhere in voxel space (voxel i's centre at i + ½).
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampler<'a> {
    voxels: &'a PaddedVoxels,
    scale: f32,
    offset: f32,
}

/// The eight voxels around a position, and where between them it is.
#[derive(Debug, Clone, Copy)]
struct Cell<L: Lanes> {
    index: L::Index,
    fraction: Vec3<L>,
}

impl<L: Lanes> Cell<L> {
    /// Trilinear interpolation of pairs along x.
    #[inline(always)]
    fn interpolate(&self, [front_low, front_high, back_low, back_high]: [[L; 2]; 4]) -> L {
        let Vec3 { x, y, z } = self.fraction;
        let front = mix(front_low, x).mix(mix(front_high, x), y);
        front.mix(mix(back_low, x).mix(mix(back_high, x), y), z)
    }
}

#[inline(always)]
fn mix<L: Lanes>([first, second]: [L; 2], t: L) -> L {
    first.mix(second, t)
}

impl<'a> Sampler<'a> {
    pub(super) fn new(voxels: &'a PaddedVoxels, (scale, offset): (f64, f64)) -> Self {
        Self { voxels, scale: scale as f32, offset: offset as f32 }
    }

    /// Voxels along each axis.
    pub(super) fn dims(&self) -> Vec3A {
        self.voxels.dims
    }

    #[inline(always)]
    fn cell<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> Cell<L> {
        let largest = Vec3::splat(token, self.voxels.dims);
        let inside = position.max(Vec3::splat(token, Vec3A::ZERO)).min(largest);
        // The lower neighbour's centre is half a voxel before, and its index one higher in the padded volume.
        let shifted = Vec3 { x: inside.x + 0.5, y: inside.y + 0.5, z: inside.z + 0.5 };
        let lower = shifted.floor();
        let index = L::to_array_index([lower.x, lower.y, lower.z], self.voxels.row, self.voxels.slice);
        Cell { index, fraction: shifted - lower }
    }

    #[inline(always)]
    fn normalised<L: Lanes>(&self, stored: L) -> L {
        L::normalised(stored, self.scale, self.offset)
    }

    /// The normalised value at a position, clamped to the volume.
    #[inline(always)]
    pub(super) fn value_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L {
        self.normalised(self.stored_at(token, position))
    }

    /// The stored number at a position, clamped to the volume.
    #[inline(always)]
    pub(super) fn stored_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L {
        let cell = self.cell(token, position);
        let PaddedVoxels { row, slice, .. } = *self.voxels;
        cell.interpolate(self.voxels.neighbours(token, cell.index, 0, row, slice))
    }

    /// Differences of the normalised values one voxel before and after a position, along each axis.
    #[inline(always)]
    pub(super) fn differences_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> Vec3<L> {
        let cell = self.cell(token, position);
        let PaddedVoxels { row, slice, .. } = *self.voxels;
        let (along_y, along_z) = (row as isize, slice as isize);
        // Of the four rows around the position, four voxels each; of the eight rows around these, two.
        let [a, b, c, d] = self.voxels.rows_of_four(token, cell.index);
        let beside_y = self.voxels.neighbours(token, cell.index, -along_y, 3 * row, slice);
        let beside_z = self.voxels.neighbours(token, cell.index, -along_z, row, 3 * slice);
        let before_x = [[a[0], a[1]], [b[0], b[1]], [c[0], c[1]], [d[0], d[1]]];
        let after_x = [[a[2], a[3]], [b[2], b[3]], [c[2], c[3]], [d[2], d[3]]];
        let [a, b, c, d] = [[a[1], a[2]], [b[1], b[2]], [c[1], c[2]], [d[1], d[2]]];
        let before_y = [beside_y[0], a, beside_y[2], c];
        let after_y = [b, beside_y[1], d, beside_y[3]];
        let before_z = [beside_z[0], beside_z[1], a, b];
        let after_z = [c, d, beside_z[2], beside_z[3]];
        Vec3 {
            x: self.difference(&cell, before_x, after_x),
            y: self.difference(&cell, before_y, after_y),
            z: self.difference(&cell, before_z, after_z),
        }
    }

    #[inline(always)]
    fn difference<L: Lanes>(&self, cell: &Cell<L>, before: [[L; 2]; 4], after: [[L; 2]; 4]) -> L {
        self.normalised(cell.interpolate(after)) - self.normalised(cell.interpolate(before))
    }

    /// The normalised values at four corners of a cube of two voxels around a position: (+,−,−), (−,−,+), (−,+,−),
    /// (+,+,+).
    #[inline(always)]
    pub(super) fn tetrahedron_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> [L; 4] {
        let cell = self.cell(token, position);
        let PaddedVoxels { row, slice, .. } = *self.voxels;
        let (y, z) = (row as isize, slice as isize);
        let mut values = [L::splat(token, 0.0); 4];
        for (value, offset) in values.iter_mut().zip([1 - y - z, -1 - y + z, -1 + y - z, 1 + y + z]) {
            let neighbours = self.voxels.neighbours(token, cell.index, offset, row, slice);
            *value = self.normalised(cell.interpolate(neighbours));
        }
        values
    }
}
