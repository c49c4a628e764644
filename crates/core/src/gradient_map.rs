//! The gradient magnitude of every voxel, made once per volume (DM §3.2).

use crate::scene::GradientMethod;
use crate::volume::{Encoding, Grid, StorageKind, StoredSlices, StoredVoxels, Volume};
use glam::Vec3;
use rayon::prelude::*;

/// Slices that a thread takes at once.
const SLICES: usize = 8;

/// Voxels that a gradient is estimated from: offsets along x, y and z.
type Stencil = &'static [[isize; 3]];

const CENTRAL: Stencil = &[[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];

/// DM Algorithm 1, with the missing corner of its listing.
const TETRAHEDRON: Stencil = &[[1, -1, -1], [-1, -1, 1], [-1, 1, -1], [1, 1, 1]];

/// Precision of the magnitudes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum GradientDepth {
    /// 8 bits.
    Bits8,
    /// 16 bits.
    Bits16,
}

impl GradientDepth {
    /// Bits of a code.
    pub fn bits(self) -> u32 {
        match self {
            Self::Bits8 => u8::BITS,
            Self::Bits16 => u16::BITS,
        }
    }

    /// The code of the largest magnitude.
    pub fn largest_code(self) -> u16 {
        match self {
            Self::Bits8 => u8::MAX.into(),
            Self::Bits16 => u16::MAX,
        }
    }
}

/// Gradient magnitudes at the voxels' centres, as codes from 0 to the largest magnitude: the change of the *stored* number
/// per voxel length, so that a map holds for every window.
///
/// The magnitude of a sample is interpolated between them.
#[derive(Debug, Clone)]
pub struct GradientMap {
    dims: [usize; 3],
    depth: GradientDepth,
    codes: StoredVoxels,
    largest: f64,
}

impl GradientMap {
    /// Estimates the gradients of a volume as held at a precision. Beyond a face its outermost voxels are repeated.
    ///
    /// The axes are taken to be perpendicular.
    pub fn new(volume: &Volume, kind: StorageKind, method: GradientMethod, depth: GradientDepth) -> Self {
        let estimate = Estimate::new(volume, kind, method);
        let largest = estimate.largest();
        let code_per_magnitude = if largest > 0.0 { f32::from(depth.largest_code()) / largest } else { 0.0 };
        let code = |magnitude: f32| magnitude * code_per_magnitude + 0.5;
        let codes = match depth {
            GradientDepth::Bits8 => StoredVoxels::U8(estimate.map(|magnitude| code(magnitude) as u8)),
            GradientDepth::Bits16 => StoredVoxels::U16(estimate.map(|magnitude| code(magnitude) as u16)),
        };
        let largest = f64::from(largest) * f64::from(estimate.unit);
        Self { dims: volume.grid().dims(), depth, codes, largest }
    }

    /// Voxels along each axis.
    pub fn dims(&self) -> [usize; 3] {
        self.dims
    }

    /// Precision of the codes.
    pub fn depth(&self) -> GradientDepth {
        self.depth
    }

    /// The codes, 8- or 16-bit, in the order of the voxels.
    pub fn codes(&self) -> &StoredVoxels {
        &self.codes
    }

    /// The magnitude of the largest code, stored units per voxel length.
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// Scale and offset from a code to the magnitude of the normalised value's gradient per voxel length, before it is
    /// limited to 1. `value_scale` is that of [`Encoding::normalised_from_stored`].
    pub fn normalised_from_code(&self, value_scale: f64) -> (f64, f64) {
        (self.largest / f64::from(self.depth.largest_code()) * value_scale.abs(), 0.0)
    }

    /// Bytes that the codes take.
    pub fn byte_size(&self) -> usize {
        self.dims.iter().product::<usize>() * (self.depth.bits() / u8::BITS) as usize
    }
}

/// How the gradients of a volume are estimated.
struct Estimate<'a> {
    volume: &'a Volume,
    kind: StorageKind,
    encoding: Encoding,
    method: GradientMethod,
    /// Unit of the magnitudes, stored units per voxel length: the stored numbers' range, so that no square overflows.
    unit: f32,
    /// Part of the gradient along each axis for each of its differences.
    per_difference: Vec3,
}

impl<'a> Estimate<'a> {
    fn new(volume: &'a Volume, kind: StorageKind, method: GradientMethod) -> Self {
        let encoding = Encoding::new(volume, kind);
        let (lo, hi) = volume.range();
        let unit = ((encoding.stored(hi) - encoding.stored(lo)) as f32).max(f32::MIN_POSITIVE);
        let weight = match method {
            GradientMethod::CentralDifferences => 0.5,
            GradientMethod::Tetrahedron => 0.25,
        };
        let per_difference = weight / spacing(volume.grid()) / unit;
        Self { volume, kind, encoding, method, unit, per_difference }
    }

    /// The largest magnitude.
    fn largest(&self) -> f32 {
        let depth = self.volume.grid().dims()[2];
        let of_slices = |first| {
            let mut largest = 0.0_f32;
            self.for_each_row(first, |row| largest = row.iter().copied().fold(largest, f32::max));
            largest
        };
        (0..depth).into_par_iter().step_by(SLICES).map(of_slices).reduce(|| 0.0, f32::max)
    }

    /// Maps the magnitudes of all voxels.
    fn map<T: Copy + Default + Send>(&self, code: impl Fn(f32) -> T + Sync) -> Vec<T> {
        let [width, height, _] = self.volume.grid().dims();
        let mut codes = vec![T::default(); self.volume.grid().voxel_count()];
        codes.par_chunks_mut(SLICES * height * width).enumerate().for_each(|(task, codes)| {
            let mut rows = codes.chunks_exact_mut(width);
            self.for_each_row(task * SLICES, |magnitudes| {
                for (code_of, &magnitude) in rows.next().into_iter().flatten().zip(magnitudes) {
                    *code_of = code(magnitude);
                }
            });
        });
        codes
    }

    /// Visits the magnitudes of each row of the slices of a task, in units of `unit`.
    fn for_each_row(&self, first_slice: usize, visit: impl FnMut(&[f32])) {
        let depth = self.volume.grid().dims()[2];
        let last_slice = (first_slice + SLICES).min(depth) - 1;
        let read = first_slice.saturating_sub(1)..(last_slice + 2).min(depth);
        let slices = first_slice - read.start..=last_slice - read.start;
        match StoredSlices::of_volume(self.volume, self.kind, &self.encoding, read) {
            StoredSlices::U8(v) => self.for_each_row_of(&v, slices, visit),
            StoredSlices::U16(v) => self.for_each_row_of(&v, slices, visit),
            StoredSlices::F32(v) => self.for_each_row_of(&v, slices, visit),
        }
    }

    fn for_each_row_of<T: Copy + Into<f32>>(
        &self,
        voxels: &[T],
        slices: std::ops::RangeInclusive<usize>,
        mut visit: impl FnMut(&[f32]),
    ) {
        let [width, height, _] = self.volume.grid().dims();
        let depth = voxels.len() / (width * height);
        let stencil = match self.method {
            GradientMethod::CentralDifferences => CENTRAL,
            GradientMethod::Tetrahedron => TETRAHEDRON,
        };
        let mut neighbours = vec![vec![0.0; width]; stencil.len()];
        let mut magnitudes = vec![0.0; width];
        for (z, y) in slices.flat_map(|z| (0..height).map(move |y| (z, y))) {
            for (row, &[dx, dy, dz]) in neighbours.iter_mut().zip(stencil) {
                let y = y.saturating_add_signed(dy).min(height - 1);
                let z = z.saturating_add_signed(dz).min(depth - 1);
                copy_shifted(row, &voxels[(z * height + y) * width..][..width], dx);
            }
            match self.method {
                GradientMethod::CentralDifferences => self.central_differences(&mut magnitudes, &neighbours),
                GradientMethod::Tetrahedron => self.tetrahedron(&mut magnitudes, &neighbours),
            }
            visit(&magnitudes);
        }
    }

    fn central_differences(&self, magnitudes: &mut [f32], neighbours: &[Vec<f32>]) {
        let [right, left, above, below, behind, before] = rows(neighbours, magnitudes.len());
        let scale = self.per_difference;
        for (i, magnitude) in magnitudes.iter_mut().enumerate() {
            let x = (right[i] - left[i]) * scale.x;
            let y = (above[i] - below[i]) * scale.y;
            let z = (behind[i] - before[i]) * scale.z;
            *magnitude = (x * x + y * y + z * z).sqrt();
        }
    }

    fn tetrahedron(&self, magnitudes: &mut [f32], neighbours: &[Vec<f32>]) {
        let [a, b, c, d] = rows(neighbours, magnitudes.len());
        let scale = self.per_difference;
        for (i, magnitude) in magnitudes.iter_mut().enumerate() {
            let (a, b, c, d) = (a[i], b[i], c[i], d[i]);
            let x = (a - b) * scale.x + (d - c) * scale.x;
            let y = (c - a) * scale.y + (d - b) * scale.y;
            let z = (b - a) * scale.z + (d - c) * scale.z;
            *magnitude = (x * x + y * y + z * z).sqrt();
        }
    }
}

/// Distance of neighbouring voxels along each axis, voxel lengths.
fn spacing(grid: &Grid) -> Vec3 {
    (grid.spacing_mm() / grid.voxel_length_mm()).as_vec3()
}

/// Copies a row so that place i holds voxel i + shift, the outermost voxel repeated.
fn copy_shifted<T: Copy + Into<f32>>(to: &mut [f32], row: &[T], shift: isize) {
    let last = row.len() - 1;
    let (inner, from) = match shift {
        1 => (&mut to[..last], &row[1..]),
        -1 => (&mut to[1..], &row[..last]),
        _ => (&mut to[..], row),
    };
    for (to, &voxel) in inner.iter_mut().zip(from) {
        *to = voxel.into();
    }
    match shift {
        1 => to[last] = row[last].into(),
        -1 => to[0] = row[0].into(),
        _ => {}
    }
}

/// The rows of a stencil, all of the same length.
fn rows<const N: usize>(neighbours: &[Vec<f32>], width: usize) -> [&[f32]; N] {
    std::array::from_fn(|i| &neighbours[i][..width])
}
