//! Codes: 16-bit numbers for the ends of an interval of stored numbers.

use crate::gradient_map::GradientDepth;
use crate::volume::{Encoding, StorageKind, Volume};

/// Times the largest number of a block, how far rounding may carry an interpolated number out of the block's interval: each
/// of three f32 interpolations `a + (b − a)·t` by at most 1½ ulp. (Between whole numbers of 16 bits it never does.)
const ROUNDING: f32 = 8.0 * f32::EPSILON;

/// How the ends of intervals of stored numbers are written as 16-bit codes:
/// `stored = min(code · stored_per_code + stored_at_zero, largest_stored)`.
///
/// Whole numbers of 8 or 16 bits are their own codes; floats are rounded outward. A fill value far outside the data takes
/// nearly all codes from it: what is left is coarse, and blocks count as occupied that need not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeCodes {
    /// How many codes there are.
    pub count: usize,
    /// From one code to the next, stored units.
    pub stored_per_code: f32,
    /// Stored number of code 0.
    pub stored_at_zero: f32,
    /// Stored number of the last code.
    pub largest_stored: f32,
    /// How far rounding may carry an interpolated number out of the interval of a block that is not of one value.
    pub rounding: f32,
}

impl RangeCodes {
    /// The codes of a volume's stored numbers.
    pub fn of_values(volume: &Volume, kind: StorageKind) -> Self {
        match kind {
            StorageKind::U8 => Self::whole_numbers(1 << 8),
            StorageKind::U16 => Self::whole_numbers(1 << 16),
            StorageKind::F32 => {
                let encoding = Encoding::new(volume, kind);
                let (lo, hi) = volume.range();
                Self::of_floats(encoding.stored(lo) as f32, encoding.stored(hi) as f32)
            }
        }
    }

    /// The codes of gradient magnitudes: the map's own.
    pub fn of_gradients(depth: GradientDepth) -> Self {
        Self::whole_numbers(usize::from(depth.largest_code()) + 1)
    }

    /// Whole numbers below a count, which stand for themselves.
    fn whole_numbers(count: usize) -> Self {
        Self {
            count,
            stored_per_code: 1.0,
            stored_at_zero: 0.0,
            largest_stored: (count - 1) as f32,
            rounding: 0.0,
        }
    }

    /// Floats from `lo` to `hi`, both of which can be written.
    fn of_floats(lo: f32, hi: f32) -> Self {
        let count = 1 << 16;
        let mut codes = Self {
            count,
            stored_per_code: (hi - lo) / (count - 1) as f32,
            stored_at_zero: lo,
            largest_stored: hi,
            rounding: ROUNDING * lo.abs().max(hi.abs()),
        };
        while f32::from(u16::MAX) * codes.stored_per_code + lo < hi {
            codes.stored_per_code = codes.stored_per_code.next_up();
        }
        codes
    }

    /// The number that a code stands for.
    pub fn stored(&self, code: u16) -> f32 {
        (f32::from(code) * self.stored_per_code + self.stored_at_zero).min(self.largest_stored)
    }

    /// The smallest number that an interval from this code upwards stands for.
    pub fn lowest(&self, code: u16) -> f32 {
        if code == 0 { self.stored(code) - self.rounding } else { self.stored(code) }
    }

    /// The largest number that an interval up to this code stands for.
    pub fn highest(&self, code: u16) -> f32 {
        if usize::from(code) + 1 == self.count {
            self.stored(code) + self.rounding
        } else {
            self.stored(code)
        }
    }

    /// Codes of the interval of the voxels that a block reads, outward: every number interpolated between them lies
    /// from [`RangeCodes::lowest`] of the first code to [`RangeCodes::highest`] of the second.
    pub fn outward(&self, [lo, hi]: [f32; 2]) -> [u16; 2] {
        let widened = if lo < hi { self.rounding } else { 0.0 };
        [self.at_most(lo - widened), self.at_least(hi + widened)]
    }

    /// The last code of a number that is not above `x`; the first if there is none.
    fn at_most(&self, x: f32) -> u16 {
        let mut code = self.position(x).ceil() as u16;
        while code > 0 && self.stored(code) > x {
            code -= 1;
        }
        code
    }

    /// The first code of a number that is not below `x`; the last if there is none.
    fn at_least(&self, x: f32) -> u16 {
        let mut code = self.position(x).floor() as u16;
        while code < u16::MAX && self.stored(code) < x {
            code += 1;
        }
        code
    }

    fn position(&self, x: f32) -> f64 {
        if self.stored_per_code > 0.0 {
            (f64::from(x) - f64::from(self.stored_at_zero)) / f64::from(self.stored_per_code)
        } else {
            0.0
        }
    }
}
