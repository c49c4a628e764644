//! Light gathered front to back.

use super::accumulate::{Pixels, Taken};
use super::lanes::Lanes;
use super::vector::Vec3;
use crate::cast::FIRST_HIT_ALPHA;
use glam::Vec3A;

/// What rays, or parts of them, have gathered so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gathered<L> {
    /// Premultiplied colour.
    pub(super) rgb: Vec3<L>,
    /// What passes.
    pub(super) transmittance: L,
    /// Depth of the first hit, metres; infinite without one.
    pub(super) depth_m: L,
    /// Depth of the first sample that is visible at all, metres; infinite without one.
    visible_from_m: L,
}

impl<L: Lanes> Gathered<L> {
    #[inline(always)]
    pub(super) fn nothing(token: L::Token) -> Self {
        Self {
            rgb: Vec3::splat(token, Vec3A::ZERO),
            transmittance: L::splat(token, 1.0),
            depth_m: L::splat(token, f32::INFINITY),
            visible_from_m: L::splat(token, f32::INFINITY),
        }
    }

    /// What pixels have gathered: their premultiplied colours and depths.
    #[inline(always)]
    pub(super) fn of(token: L::Token, pixels: &[([f32; 4], f32)]) -> Self {
        let channel = |c: usize| L::from_fn(token, |lane| f64::from(pixels[lane].0[c]));
        Self {
            rgb: Vec3 { x: channel(0), y: channel(1), z: channel(2) },
            transmittance: L::splat(token, 1.0) - channel(3),
            depth_m: L::from_fn(token, |lane| f64::from(pixels[lane].1)),
            visible_from_m: L::splat(token, f32::INFINITY),
        }
    }

    /// Adds a sample behind what has been gathered.
    #[inline(always)]
    pub(super) fn add(&mut self, token: L::Token, rgb: Vec3<L>, transmittance: L) {
        self.rgb = rgb.mul_add((L::splat(token, 1.0) - transmittance) * self.transmittance, self.rgb);
        self.transmittance *= transmittance;
    }

    /// Keeps a depth, metres, if it is the first at which so little passes that there is a hit, and if it is the first at which less
    /// than everything does.
    #[inline(always)]
    pub(super) fn note_hit(&mut self, token: L::Token, transmittance: L, depth_m: L) {
        let none = L::splat(token, f32::INFINITY);
        let is_hit = none.le(self.depth_m) & transmittance.le(L::splat(token, 1.0 - FIRST_HIT_ALPHA));
        self.depth_m = L::select(is_hit, depth_m, self.depth_m);
        let is_visible = none.le(self.visible_from_m) & transmittance.lt(L::splat(token, 1.0));
        self.visible_from_m = L::select(is_visible, depth_m, self.visible_from_m);
    }

    /// The pixels that it makes.
    #[inline(always)]
    pub(super) fn pixels(self, token: L::Token, taken: Taken<L>) -> Pixels<L> {
        let alpha = L::splat(token, 1.0) - self.transmittance;
        let Self { rgb, depth_m, visible_from_m, .. } = self;
        Pixels { rgb, alpha, depth_m, visible_from_m, taken }
    }
}
