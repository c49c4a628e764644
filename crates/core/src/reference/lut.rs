//! Looking the baked transfer function up: the logarithm is interpolated between entries, the colour is the nearest
//! entry's. The twin of `lut_1d.wgsl` and `lut_2d.wgsl`.

use super::lanes::Lanes;
use super::vector::Vec3;
use crate::transfer::Lut;

/// Colour and log2 transmittance of one voxel length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry<L> {
    pub(super) rgb: Vec3<L>,
    pub(super) log2: L,
}

/// The entry at a normalised value, for 1D tables.
#[inline(always)]
pub(super) fn lut_at<L: Lanes>(lut: &Lut, token: L::Token, value: L) -> Entry<L> {
    let (column, fraction) = before(token, value, lut.width());
    entry_at(lut, token, column, fraction)
}

/// The entry at a normalised value and a second coordinate in [0, 1].
#[inline(always)]
pub(super) fn lut_at_2d<L: Lanes>(lut: &Lut, token: L::Token, value: L, second: L) -> Entry<L> {
    let (column, along) = before(token, value, lut.width());
    let (row, across) = before(token, second, lut.height());
    let first = row.mul_add(L::splat(token, lut.width() as f32), column);
    let below = entry_at(lut, token, first, along);
    let above = entry_at(lut, token, first + lut.width() as f32, along);
    let is_below = across.lt(L::splat(token, 0.5));
    Entry { rgb: Vec3::select(is_below, below.rgb, above.rgb), log2: below.log2.mix(above.log2, across) }
}

/// The entry before a coordinate in [0, 1] that has one after it, and the way from it to that one.
#[inline(always)]
fn before<L: Lanes>(token: L::Token, coordinate: L, count: usize) -> (L, L) {
    let along = coordinate * (count - 1) as f32;
    let before = along.floor().min(L::splat(token, (count - 2) as f32));
    (before, along - before)
}

/// Between the entries before and after.
#[inline(always)]
fn entry_at<L: Lanes>(lut: &Lut, token: L::Token, before: L, fraction: L) -> Entry<L> {
    let (half, one) = (L::splat(token, 0.5), L::splat(token, 1.0));
    let is_before_nearest = fraction.lt(half);
    let after = before + 1.0;
    let nearest = L::select(is_before_nearest, before, after);
    let other = L::select(is_before_nearest, after, before);
    let to_other = L::select(is_before_nearest, fraction, one - fraction);
    let ([x, y, z, log2], other_log2) =
        L::entries(token, lut.entries(), nearest.to_index(), other.to_index());
    Entry { rgb: Vec3 { x, y, z }, log2: log2.mix(other_log2, to_other) }
}
