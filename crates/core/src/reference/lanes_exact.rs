//! One f64 lane: the truth.

use super::accumulate::Pixels;
use super::lanes::{Lanes, MOST_LANES, Mask};
use super::renderer::Reads;
use super::volume::Stored;
use crate::transfer::LutEntry;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub};

/// A packet of one ray, in double precision.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(super) struct Exact(f64);

impl From<f64> for Exact {
    fn from(number: f64) -> Self {
        Self(number)
    }
}

impl From<Exact> for f64 {
    fn from(lane: Exact) -> Self {
        lane.0
    }
}

impl Pixels<Exact> {
    /// Premultiplied colour.
    pub(super) fn color(&self) -> [f32; 4] {
        [self.rgb.x, self.rgb.y, self.rgb.z, self.alpha].map(|channel| channel.0 as f32)
    }

    /// What its ray has read.
    pub(super) fn reads(&self) -> Reads {
        Reads { samples: self.taken.samples.0 as u32, map_reads: self.taken.map_reads.0 as u32 }
    }
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

impl Lanes for Exact {
    type Token = ();
    type Mask = bool;
    type Index = usize;
    const PACKET: [usize; 2] = [1, 1];

    fn outlined<R>((): (), part: impl FnOnce() -> R) -> R {
        part()
    }

    fn splat((): (), value: f32) -> Self {
        Self(f64::from(value))
    }

    fn from_fn((): (), mut value: impl FnMut(usize) -> f64) -> Self {
        Self(value(0))
    }

    fn to_array(self) -> [f32; MOST_LANES] {
        let mut lanes = [0.0; MOST_LANES];
        lanes[0] = self.0 as f32;
        lanes
    }

    fn mul_add(self, factor: Self, term: Self) -> Self {
        self * factor + term
    }

    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn exp2(self) -> Self {
        Self(self.0.exp2())
    }

    fn floor(self) -> Self {
        Self(self.0.floor())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    fn lt(self, other: Self) -> bool {
        self < other
    }

    fn le(self, other: Self) -> bool {
        self <= other
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn normalised(stored: Self, scale: f32, offset: f32) -> Self {
        Self(f64::from((stored.0 as f32 * scale + offset).clamp(0.0, 1.0)))
    }

    fn to_index(self) -> usize {
        self.0 as usize
    }

    fn to_array_index(coordinates: [Self; 3], row: usize, slice: usize) -> usize {
        let [x, y, z] = coordinates.map(Self::to_index);
        x + y * row + z * slice
    }

    fn neighbours<T: Stored>((): (), voxels: &[T], index: usize, row: usize, slice: usize) -> [[Self; 2]; 4] {
        [0, row, slice, slice + row].map(|start| {
            let at = index + start;
            [voxels[at], voxels[at + 1]].map(|v| Self(v.to_f64()))
        })
    }

    fn rows_of_four<T: Stored>(
        (): (),
        voxels: &[T],
        index: usize,
        row: usize,
        slice: usize,
    ) -> [[Self; 4]; 4] {
        [0, row, slice, slice + row].map(|start| {
            let at = index + start;
            [0, 1, 2, 3].map(|x| Self(voxels[at + x].to_f64()))
        })
    }

    fn bytes((): (), table: &[u8], index: usize) -> Self {
        Self(f64::from(table[index]))
    }

    fn numbers((): (), table: &[f32], index: usize) -> Self {
        Self(f64::from(table[index]))
    }

    fn entries((): (), table: &[LutEntry], nearest: usize, other: usize) -> ([Self; 4], Self) {
        (table[nearest].map(|number| Self(f64::from(number))), Self(f64::from(table[other][3])))
    }
}

macro_rules! operators {
    ($($trait:ident $method:ident),*) => {
        $(impl $trait for Exact {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }

        impl $trait<f32> for Exact {
            type Output = Self;
            fn $method(self, other: f32) -> Self {
                Self(self.0.$method(f64::from(other)))
            }
        })*
    };
}

operators!(Add add, Sub sub, Mul mul, Div div);

impl Neg for Exact {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Exact {
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl MulAssign for Exact {
    fn mul_assign(&mut self, other: Self) {
        self.0 *= other.0;
    }
}
