//! Slabs of depth, evenly spaced in 1/depth.

/// Depths cut into slabs: slab m, from the front, is where 1/depth is in `(nearest − (m + 1) t, nearest − m t]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepthSlabs {
    /// 1/depth at which the nearest slab begins, 1/m.
    pub nearest_per_m: f64,
    /// Thickness t of each, 1/m.
    pub thickness_per_m: f64,
    /// How many there are, at least one.
    pub count: u32,
}

impl DepthSlabs {
    /// The slab of a depth, metres; what is before the first or behind the last is in that.
    pub fn at(&self, depth_m: f64) -> u32 {
        let behind = (self.nearest_per_m - depth_m.recip()) / self.thickness_per_m;
        (behind.max(0.0) as u32).min(self.count - 1)
    }

    /// 1/depth of the middle of a slab, 1/m.
    pub fn middle_per_m(&self, slab: u32) -> f64 {
        self.nearest_per_m - (f64::from(slab) + 0.5) * self.thickness_per_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn depths_are_in_their_slabs(near_m in 0.1..1.0_f64, thickness_m in 0.01..2.0_f64, count in 1..64_u32, share in 0.0..1.0_f64) {
            let (front, back) = (near_m.recip(), (near_m + thickness_m).recip());
            let slabs = DepthSlabs { nearest_per_m: front, thickness_per_m: (front - back) / f64::from(count), count };
            let depth_m = near_m + share * thickness_m;
            let middle = slabs.middle_per_m(slabs.at(depth_m));
            prop_assert!((middle - depth_m.recip()).abs() <= 0.5 * slabs.thickness_per_m * (1.0 + 1e-9));
            prop_assert_eq!(slabs.at(0.5 * near_m), 0);
            prop_assert_eq!(slabs.at(2.0 * (near_m + thickness_m)), count - 1);
        }
    }
}
