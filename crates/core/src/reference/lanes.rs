//! Lanes: the numbers that the caster computes with, one for each ray of a packet.
//!
//! Every part of the caster is written once over [`Lanes`]. One f64 lane ([`super::lanes_exact`]) is the truth that tests
//! trust; sixteen f32 lanes ([`super::lanes_wide`]) are the fast path.

use super::volume::Stored;
use crate::transfer::LutEntry;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub};

/// Most rays of a packet.
pub(super) const MOST_LANES: usize = 16;

/// One real number per ray of a packet.
pub(super) trait Lanes:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + AddAssign
    + MulAssign
{
    /// Proof of the instruction set that the operations need.
    type Token: Copy;
    /// A yes or no per lane.
    type Mask: Mask;
    /// A place in a table per lane.
    type Index: Copy;
    /// Columns and rows of the pixels whose rays are a packet.
    const PACKET: [usize; 2];

    /// Runs a part of a cast with the instruction set as a function of its own, so that the code that calls it stays
    /// small.
    fn outlined<R>(token: Self::Token, part: impl FnOnce() -> R) -> R;
    /// The same number in all lanes.
    fn splat(token: Self::Token, value: f32) -> Self;
    /// A number for each lane.
    fn from_fn(token: Self::Token, value: impl FnMut(usize) -> f64) -> Self;
    /// The number of each lane; zeros where there is no lane.
    fn to_array(self) -> [f32; MOST_LANES];

    /// `self · factor + term`, rounded once or twice.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Two to the power of numbers not above 0; exactly 1 at 0.
    fn exp2(self) -> Self;
    /// The next whole number below.
    fn floor(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The smaller one.
    fn min(self, other: Self) -> Self;
    /// The larger one.
    fn max(self, other: Self) -> Self;
    /// Whether less.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether less or equal.
    fn le(self, other: Self) -> Self::Mask;
    /// One or the other.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `clamp(stored · scale + offset, 0, 1)`, each step rounded to f32: what tests for empty space rely on.
    fn normalised(stored: Self, scale: f32, offset: f32) -> Self;

    /// Whole numbers not below 0 as places in a table.
    fn to_index(self) -> Self::Index;
    /// Places in an array of rows and slices from their whole coordinates.
    fn to_array_index(coordinates: [Self; 3], row: usize, slice: usize) -> Self::Index;
    /// The eight voxels from a place on: pairs along x, at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
    fn neighbours<T: Stored>(
        token: Self::Token,
        voxels: &[T],
        index: Self::Index,
        row: usize,
        slice: usize,
    ) -> [[Self; 2]; 4];
    /// Four voxels along x from a place on: in rows at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1).
    fn rows_of_four<T: Stored>(
        token: Self::Token,
        voxels: &[T],
        index: Self::Index,
        row: usize,
        slice: usize,
    ) -> [[Self; 4]; 4];
    /// Small numbers at places of a table.
    fn bytes(token: Self::Token, table: &[u8], index: Self::Index) -> Self;
    /// Numbers at places of a table.
    fn numbers(token: Self::Token, table: &[f32], index: Self::Index) -> Self;
    /// Entries at one place of a table and the logarithms at another.
    fn entries(
        token: Self::Token,
        table: &[LutEntry],
        nearest: Self::Index,
        other: Self::Index,
    ) -> ([Self; 4], Self);

    /// Linear interpolation.
    #[inline(always)]
    fn mix(self, other: Self, t: Self) -> Self {
        (other - self).mul_add(t, self)
    }

    /// `self` to a whole power, which must not be 0, by squaring.
    #[inline(always)]
    fn powi(self, exponent: u32) -> Self {
        let mut power = self;
        for bit in (0..exponent.ilog2()).rev() {
            power *= power;
            if exponent >> bit & 1 == 1 {
                power *= self;
            }
        }
        power
    }
}

/// A yes or no per ray of a packet.
pub(super) trait Mask:
    Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Whether any lane says yes.
    fn any(self) -> bool;
}
