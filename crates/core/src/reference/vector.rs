//! Vectors of lanes.

use super::lanes::Lanes;
use glam::{Mat3, Vec3A};
use std::ops::{Add, AddAssign, Mul, Sub};

/// Three coordinates or colour channels per ray of a packet.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vec3<L> {
    pub(super) x: L,
    pub(super) y: L,
    pub(super) z: L,
}

impl<L: Lanes> Vec3<L> {
    /// The same vector in all lanes.
    #[inline(always)]
    pub(super) fn splat(token: L::Token, v: Vec3A) -> Self {
        Self { x: L::splat(token, v.x), y: L::splat(token, v.y), z: L::splat(token, v.z) }
    }

    /// What a matrix makes of it.
    #[inline(always)]
    pub(super) fn transformed(self, matrix: &Mat3) -> Self {
        let [a, b, c] = matrix.to_cols_array_2d();
        Self {
            x: self.x * a[0] + self.y * b[0] + self.z * c[0],
            y: self.x * a[1] + self.y * b[1] + self.z * c[1],
            z: self.x * a[2] + self.y * b[2] + self.z * c[2],
        }
    }

    /// Products of the coordinates.
    #[inline(always)]
    pub(super) fn scaled(self, scale: Self) -> Self {
        Self { x: self.x * scale.x, y: self.y * scale.y, z: self.z * scale.z }
    }

    #[inline(always)]
    pub(super) fn dot(self, other: Self) -> L {
        self.x.mul_add(other.x, self.y.mul_add(other.y, self.z * other.z))
    }

    #[inline(always)]
    pub(super) fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    #[inline(always)]
    pub(super) fn length_squared(self) -> L {
        self.dot(self)
    }

    /// `self · factor + term`.
    #[inline(always)]
    pub(super) fn mul_add(self, factor: L, term: Self) -> Self {
        Self {
            x: self.x.mul_add(factor, term.x),
            y: self.y.mul_add(factor, term.y),
            z: self.z.mul_add(factor, term.z),
        }
    }

    /// The smaller of each coordinate.
    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        Self { x: self.x.min(other.x), y: self.y.min(other.y), z: self.z.min(other.z) }
    }

    /// The larger of each coordinate.
    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        Self { x: self.x.max(other.x), y: self.y.max(other.y), z: self.z.max(other.z) }
    }

    /// The next whole numbers below.
    #[inline(always)]
    pub(super) fn floor(self) -> Self {
        Self { x: self.x.floor(), y: self.y.floor(), z: self.z.floor() }
    }

    /// Whether no coordinate is larger.
    #[inline(always)]
    pub(super) fn le(self, other: Self) -> L::Mask {
        self.x.le(other.x) & self.y.le(other.y) & self.z.le(other.z)
    }

    /// One or the other.
    #[inline(always)]
    pub(super) fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            x: L::select(mask, yes.x, no.x),
            y: L::select(mask, yes.y, no.y),
            z: L::select(mask, yes.z, no.z),
        }
    }
}

impl<L: Lanes> Add for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl<L: Lanes> AddAssign for Vec3<L> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<L: Lanes> Sub for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { x: self.x - other.x, y: self.y - other.y, z: self.z - other.z }
    }
}

impl<L: Lanes> Mul<L> for Vec3<L> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: L) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }
}
