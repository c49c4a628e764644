//! Trilinear sampling of the stored voxels.

use glam::Vec3A;
use rayon::prelude::*;

/// Above it, neighbouring f32 numbers are whole.
const TWO_TO_23: f32 = 8_388_608.0;

/// A stored voxel as the sampler reads it.
pub(super) trait Stored: Copy + Send + Sync {
    fn to_f32(self) -> f32;
}

impl Stored for u8 {
    fn to_f32(self) -> f32 {
        f32::from(self)
    }
}

impl Stored for u16 {
    fn to_f32(self) -> f32 {
        f32::from(self)
    }
}

impl Stored for f32 {
    fn to_f32(self) -> f32 {
        self
    }
}

/// Voxels with their outermost layer repeated once around, so that every trilinear sample inside the volume
/// reads its eight neighbours without a test.
#[derive(Debug)]
pub(super) struct PaddedVoxels<T> {
    voxels: Vec<T>,
    dims: Vec3A,
    row: usize,
    slice: usize,
}

impl<T: Stored> PaddedVoxels<T> {
    pub(super) fn new(dims: [usize; 3], voxels: &[T]) -> Self {
        let [width, height, depth] = dims;
        let (row, slice) = (width + 2, (width + 2) * (height + 2));
        let source_row = |y: usize, z: usize| {
            let start = (z * height + y) * width;
            &voxels[start..start + width]
        };
        let padded = (0..depth + 2)
            .into_par_iter()
            .flat_map_iter(|z| (0..height + 2).map(move |y| (y, z)))
            .flat_map_iter(|(y, z)| {
                let source = source_row(y.clamp(1, height) - 1, z.clamp(1, depth) - 1);
                let (first, last) = (source[0], source[width - 1]);
                std::iter::once(first).chain(source.iter().copied()).chain(std::iter::once(last))
            })
            .collect();
        Self { voxels: padded, dims: Vec3A::new(width as f32, height as f32, depth as f32), row, slice }
    }

    /// Trilinear interpolation at a texture position, clamped to the volume; in stored units.
    #[inline(always)]
    fn sample(&self, position: Vec3A) -> f32 {
        let in_voxels = (position * self.dims).clamp(Vec3A::ZERO, self.dims);
        // Adding 2²³ rounds to a whole number and leaves it in the low bits: the padded index of the lower
        // neighbour, whose centre is at `index − ½`. A tie rounds to either neighbour, with a fraction of 0 or 1.
        let rounded = in_voxels + TWO_TO_23;
        let fraction = in_voxels + 0.5 - (rounded - TWO_TO_23);
        let [x, y, z] = rounded.to_array().map(|r| (r.to_bits() - TWO_TO_23.to_bits()) as usize);
        let base = x + y * self.row + z * self.slice;
        let along_x = |base: usize| {
            let (a, b) = (self.voxels[base].to_f32(), self.voxels[base + 1].to_f32());
            a + (b - a) * fraction.x
        };
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let front = mix(along_x(base), along_x(base + self.row), fraction.y);
        let back = mix(along_x(base + self.slice), along_x(base + self.slice + self.row), fraction.y);
        mix(front, back, fraction.z)
    }
}

/// A volume seen through a window: the normalised value anywhere in texture space.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sampler<'a, T> {
    voxels: &'a PaddedVoxels<T>,
    scale: f32,
    offset: f32,
    /// One voxel along each axis, texture space.
    pub(super) texel: Vec3A,
}

impl<'a, T: Stored> Sampler<'a, T> {
    pub(super) fn new(voxels: &'a PaddedVoxels<T>, (scale, offset): (f64, f64)) -> Self {
        Self { voxels, scale: scale as f32, offset: offset as f32, texel: voxels.dims.recip() }
    }

    /// The normalised value at a texture position.
    #[inline(always)]
    pub(super) fn value_at(&self, position: Vec3A) -> f32 {
        (self.voxels.sample(position) * self.scale + self.offset).clamp(0.0, 1.0)
    }
}
