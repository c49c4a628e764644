//! Sixteen f32 lanes: the fast path.

use super::lanes::{Lanes, MOST_LANES, Mask};
use super::volume::Stored;
use crate::transfer::LutEntry;
use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x16, i32x16, mask32x16, u32x16};

/// Polynomial of 2ˣ on [−½, ½], highest power first (Cephes, `exp2f`).
const EXP2: [f32; 7] =
    [1.535_336_2e-4, 1.339_887_4e-3, 9.618_437e-3, 5.550_332_5e-2, 2.402_264_8e-1, 6.931_472e-1, 1.0];

/// An array of what an expression is for each lane, written out: a loop would go through memory.
macro_rules! each_lane {
    ($lane:ident => $value:expr) => {
        each_lane!($lane => $value; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15)
    };
    ($lane:ident => $value:expr; $($number:literal)*) => {
        [$({ let $lane = $number; $value }),*]
    };
}

pub(super) use each_lane;

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
        let mut values = [0.0; MOST_LANES];
        for (lane, slot) in values.iter_mut().enumerate() {
            *slot = value(lane) as f32;
        }
        Self::load_array(token, values)
    }

    #[inline(always)]
    fn to_array(self) -> [f32; MOST_LANES] {
        SimdBase::to_array(self)
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
        let [front_low, front_high, back_low, back_high] = rows_of_one_length(voxels, row, slice);
        let index = index.to_array();
        let fours = each_lane!(lane => {
            let second = index[lane] as usize + 1;
            let first = second - 1;
            [
                T::four([front_low[first], front_low[second], front_high[first], front_high[second]]),
                T::four([back_low[first], back_low[second], back_high[first], back_high[second]]),
            ]
        });
        let [a, b, c, d] = T::split(token, each_lane!(lane => fours[lane][0]));
        let [e, f, g, h] = T::split(token, each_lane!(lane => fours[lane][1]));
        [[a, b], [c, d], [e, f], [g, h]]
    }

    #[inline(always)]
    fn rows_of_four<T: Stored>(
        token: S,
        voxels: &[T],
        index: u32x16<S>,
        row: usize,
        slice: usize,
    ) -> [[Self; 4]; 4] {
        let [a, b, c, d] = rows_of_one_length(voxels, row, slice);
        let index = index.to_array();
        [
            T::split(token, each_lane!(lane => four(a, index[lane]))),
            T::split(token, each_lane!(lane => four(b, index[lane]))),
            T::split(token, each_lane!(lane => four(c, index[lane]))),
            T::split(token, each_lane!(lane => four(d, index[lane]))),
        ]
    }

    #[inline(always)]
    fn bytes(token: S, table: &[u8], index: u32x16<S>) -> Self {
        let index = index.to_array();
        let numbers = each_lane!(lane => u32::from(table[index[lane] as usize]));
        u32x16::load_array(token, numbers).to_float()
    }

    #[inline(always)]
    fn numbers(token: S, table: &[f32], index: u32x16<S>) -> Self {
        let index = index.to_array();
        Self::load_array(token, each_lane!(lane => table[index[lane] as usize]))
    }

    #[inline(always)]
    fn entries(token: S, table: &[LutEntry], nearest: u32x16<S>, other: u32x16<S>) -> ([Self; 4], Self) {
        let (nearest, other) = (nearest.to_array(), other.to_array());
        let log2 = each_lane!(lane => table[other[lane] as usize][3]);
        let [a, b, c, d] = [
            quarter(token, table, &nearest[..4]),
            quarter(token, table, &nearest[4..8]),
            quarter(token, table, &nearest[8..12]),
            quarter(token, table, &nearest[12..]),
        ];
        let entries = [
            a[0].combine(b[0]).combine(c[0].combine(d[0])),
            a[1].combine(b[1]).combine(c[1].combine(d[1])),
            a[2].combine(b[2]).combine(c[2].combine(d[2])),
            a[3].combine(b[3]).combine(c[3].combine(d[3])),
        ];
        (entries, Self::load_array(token, log2))
    }
}

/// Four rows at (y, z) = (0, 0), (1, 0), (0, 1), (1, 1), so cut that one test of bounds does for all.
#[inline(always)]
fn rows_of_one_length<T>(voxels: &[T], row: usize, slice: usize) -> [&[T]; 4] {
    let count = voxels.len() - row - slice;
    [
        &voxels[..count],
        &voxels[row..row + count],
        &voxels[slice..slice + count],
        &voxels[row + slice..row + slice + count],
    ]
}

/// Four voxels from a place on.
#[inline(always)]
fn four<T: Stored>(voxels: &[T], at: u32) -> T::Four {
    let last = at as usize + 3;
    let (d, c, b, a) = (voxels[last], voxels[last - 1], voxels[last - 2], voxels[last - 3]);
    T::four([a, b, c, d])
}

/// The numbers of four entries, channel by channel.
#[inline(always)]
fn quarter<S: Simd>(token: S, table: &[LutEntry], at: &[u32]) -> [f32x4<S>; 4] {
    let entry = [table[at[0] as usize], table[at[1] as usize], table[at[2] as usize], table[at[3] as usize]];
    f32x4::load_four_interleaved(token, entry.as_flattened())
}
