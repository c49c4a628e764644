//! Sixteen f32 lanes: the fast path.

use super::lanes::{Lanes, Mask};
use super::volume::Stored;
use crate::transfer::LutEntry;
use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16, mask32x16, u32x16};

const COUNT: usize = 16;

/// Polynomial of 2ˣ on [−½, ½], highest power first (Cephes, `exp2f`).
const EXP2: [f32; 7] =
    [1.535_336_2e-4, 1.339_887_4e-3, 9.618_437e-3, 5.550_332_5e-2, 2.402_264_8e-1, 6.931_472e-1, 1.0];

impl<S: Simd> Mask for mask32x16<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.any_true()
    }
}

impl<S: Simd> Lanes for f32x16<S> {
    type Token = S;
    type Mask = mask32x16<S>;
    type Index = u32x16<S>;
    const PACKET: [usize; 2] = [4, 4];

    #[inline(always)]
    fn outlined<R>(token: S, part: impl FnOnce() -> R) -> R {
        token.vectorize(part)
    }

    #[inline(always)]
    fn splat(token: S, value: f32) -> Self {
        SimdBase::splat(token, value)
    }

    #[inline(always)]
    fn from_fn(token: S, mut value: impl FnMut(usize) -> f64) -> Self {
        let mut values = [0.0; COUNT];
        for (lane, slot) in values.iter_mut().enumerate() {
            *slot = value(lane) as f32;
        }
        Self::load_array(token, values)
    }

    #[inline(always)]
    fn lane(self, lane: usize) -> f32 {
        self[lane]
    }

    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        SimdFloat::mul_add(self, factor, term)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }

    #[inline(always)]
    fn exp2(self) -> Self {
        let token = self.token();
        let bounded = SimdBase::max(self, -126.0);
        let whole = bounded.round_ties_even();
        let rest = bounded - whole;
        let mut polynomial = <Self as Lanes>::splat(token, EXP2[0]);
        for coefficient in &EXP2[1..] {
            polynomial = SimdFloat::mul_add(polynomial, rest, *coefficient);
        }
        let power = (whole.to_int::<i32x16<S>>() + 127) << 23;
        polynomial * power.bitcast::<Self>()
    }

    #[inline(always)]
    fn floor(self) -> Self {
        SimdFloat::floor(self)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        SimdBase::min(self, other)
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        SimdBase::max(self, other)
    }

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        self.simd_lt(other)
    }

    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        self.simd_le(other)
    }

    #[inline(always)]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self {
        Select::select(mask, yes, no)
    }

    #[inline(always)]
    fn normalised(stored: Self, scale: f32, offset: f32) -> Self {
        SimdBase::min(SimdBase::max(stored * scale + offset, 0.0), 1.0)
    }

    #[inline(always)]
    fn to_index(self) -> u32x16<S> {
        self.to_int()
    }

    #[inline(always)]
    fn to_array_index([x, y, z]: [Self; 3], row: usize, slice: usize) -> u32x16<S> {
        x.to_index() + y.to_index() * row as u32 + z.to_index() * slice as u32
    }

    #[inline(always)]
    fn neighbours<T: Stored>(
        token: S,
        voxels: &[T],
        index: u32x16<S>,
        row: usize,
        slice: usize,
    ) -> [[Self; 2]; 4] {
        // Rows of one length, so that one test of bounds does for all.
        let count = voxels.len() - row - slice;
        let rows = [0, row, slice, row + slice].map(|start| &voxels[start..start + count]);
        let mut pairs = [[T::Pair::default(); COUNT]; 4];
        let index = index.to_array();
        for lane in 0..COUNT {
            let at = index[lane] as usize;
            for (pairs, row) in pairs.iter_mut().zip(rows) {
                pairs[lane] = T::pair(row[at], row[at + 1]);
            }
        }
        let [a, b, c, d] = pairs;
        [T::split(token, a), T::split(token, b), T::split(token, c), T::split(token, d)]
    }

    #[inline(always)]
    fn entries(
        token: S,
        table: &[LutEntry],
        color_at: u32x16<S>,
        log2_at: u32x16<S>,
    ) -> ([Self; 3], [Self; 2]) {
        let (color_at, log2_at) = (color_at.to_array(), log2_at.to_array());
        let (mut rgb, mut log2) = ([[0.0; COUNT]; 3], [[0.0; COUNT]; 2]);
        for lane in 0..COUNT {
            let color = &table[color_at[lane] as usize];
            for (channel, lanes) in rgb.iter_mut().enumerate() {
                lanes[lane] = color[channel];
            }
            let at = log2_at[lane] as usize;
            log2[0][lane] = table[at][3];
            log2[1][lane] = table[at + 1][3];
        }
        let [r, g, b] = rgb;
        let rgb = [Self::load_array(token, r), Self::load_array(token, g), Self::load_array(token, b)];
        (rgb, [Self::load_array(token, log2[0]), Self::load_array(token, log2[1])])
    }
}
