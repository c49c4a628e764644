//! Trilinear sampling of the stored voxels.

use super::lanes::Lanes;
use super::vector::Vec3;
use crate::volume::StoredVoxels;
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, u16x16, u32x16};
use glam::Vec3A;
use rayon::prelude::*;

/// A stored voxel as the sampler reads it.
pub(super) trait Stored: Copy + Send + Sync {
    /// Two neighbours.
    type Pair: Copy + Default;

    fn to_f64(self) -> f64;

    fn pair(first: Self, second: Self) -> Self::Pair;

    /// The first and the second voxels of sixteen pairs.
    fn split<S: Simd>(simd: S, pairs: [Self::Pair; 16]) -> [f32x16<S>; 2];
}

impl Stored for u8 {
    type Pair = u16;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn pair(first: Self, second: Self) -> u16 {
        u16::from_le_bytes([first, second])
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, pairs: [u16; 16]) -> [f32x16<S>; 2] {
        let (low, high) = u16x16::load_array(simd, pairs).widen();
        let pairs: u32x16<S> = low.combine(high);
        [(pairs & 0xff).to_float(), (pairs >> 8).to_float()]
    }
}

impl Stored for u16 {
    type Pair = u32;

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn pair(first: Self, second: Self) -> u32 {
        u32::from(first) | u32::from(second) << 16
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, pairs: [u32; 16]) -> [f32x16<S>; 2] {
        let pairs = u32x16::load_array(simd, pairs);
        [(pairs & 0xffff).to_float(), (pairs >> 16).to_float()]
    }
}

impl Stored for f32 {
    type Pair = [Self; 2];

    #[inline(always)]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }

    #[inline(always)]
    fn pair(first: Self, second: Self) -> [Self; 2] {
        [first, second]
    }

    #[inline(always)]
    fn split<S: Simd>(simd: S, pairs: [[Self; 2]; 16]) -> [f32x16<S>; 2] {
        let mut split = [[0.0; 16]; 2];
        for (lane, [first, second]) in pairs.into_iter().enumerate() {
            split[0][lane] = first;
            split[1][lane] = second;
        }
        [f32x16::load_array(simd, split[0]), f32x16::load_array(simd, split[1])]
    }
}

/// Voxels with their outermost layer repeated once around, so that every trilinear sample inside the volume
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
        let [width, height, depth] = dims.map(|n| n as f32);
        let voxels = match voxels {
            StoredVoxels::U8(v) => StoredVoxels::U8(padded(dims, v)),
            StoredVoxels::U16(v) => StoredVoxels::U16(padded(dims, v)),
            StoredVoxels::F32(v) => StoredVoxels::F32(padded(dims, v)),
        };
        let row = dims[0] + 2;
        Self { voxels, dims: Vec3A::new(width, height, depth), row, slice: row * (dims[1] + 2) }
    }

    /// Voxels held, the padding with them.
    pub(super) fn len(&self) -> usize {
        match &self.voxels {
            StoredVoxels::U8(v) => v.len(),
            StoredVoxels::U16(v) => v.len(),
            StoredVoxels::F32(v) => v.len(),
        }
    }

    /// The eight voxels around a position, from the lower neighbour on: see [`Lanes::neighbours`].
    #[inline(always)]
    fn neighbours<L: Lanes>(&self, token: L::Token, lower: Vec3<L>) -> [[L; 2]; 4] {
        let Self { row, slice, .. } = *self;
        let index = L::to_array_index([lower.x, lower.y, lower.z], row, slice);
        match &self.voxels {
            StoredVoxels::U8(v) => L::neighbours(token, v, index, row, slice),
            StoredVoxels::U16(v) => L::neighbours(token, v, index, row, slice),
            StoredVoxels::F32(v) => L::neighbours(token, v, index, row, slice),
        }
    }
}

fn padded<T: Stored>([width, height, depth]: [usize; 3], voxels: &[T]) -> Vec<T> {
    let source_row = |y: usize, z: usize| {
        let start = (z * height + y) * width;
        &voxels[start..start + width]
    };
    (0..depth + 2)
        .into_par_iter()
        .flat_map_iter(|z| (0..height + 2).map(move |y| (y, z)))
        .flat_map_iter(|(y, z)| {
            let source = source_row(y.clamp(1, height) - 1, z.clamp(1, depth) - 1);
            let (first, last) = (source[0], source[width - 1]);
            std::iter::once(first).chain(source.iter().copied()).chain(std::iter::once(last))
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

impl<'a> Sampler<'a> {
    pub(super) fn new(voxels: &'a PaddedVoxels, (scale, offset): (f64, f64)) -> Self {
        Self { voxels, scale: scale as f32, offset: offset as f32 }
    }

    /// Voxels along each axis.
    pub(super) fn dims(&self) -> Vec3A {
        self.voxels.dims
    }

    /// The normalised value at a position, clamped to the volume.
    #[inline(always)]
    pub(super) fn value_at<L: Lanes>(&self, token: L::Token, position: Vec3<L>) -> L {
        let zero = L::splat(token, 0.0);
        let largest = Vec3::splat(token, self.voxels.dims);
        let inside = position.max(Vec3 { x: zero, y: zero, z: zero }).min(largest);
        // The lower neighbour, whose centre is at `index − ½` for its padded index.
        let shifted = Vec3 { x: inside.x + 0.5, y: inside.y + 0.5, z: inside.z + 0.5 };
        let lower = shifted.floor();
        let fraction = shifted - lower;
        let [front_low, front_high, back_low, back_high] = self.voxels.neighbours(token, lower);
        let front = mix(front_low, fraction.x).mix(mix(front_high, fraction.x), fraction.y);
        let back = mix(back_low, fraction.x).mix(mix(back_high, fraction.x), fraction.y);
        L::normalised(front.mix(back, fraction.z), self.scale, self.offset)
    }
}

#[inline(always)]
fn mix<L: Lanes>([first, second]: [L; 2], t: L) -> L {
    first.mix(second, t)
}
