//! Ranges of depth that move by the same number of columns.

use super::SlabRange;
use std::ops::Range;

/// Depth cut into slabs: a sample of reference column x in slab m lands on derived column x − m.
///
/// Slab m is `k / (m + offset) ≤ z < k / (m − 1 + offset)` (DESIGN §5.2), in sweep columns
/// ([`Epipolar`](super::Epipolar)); the same planes for every ray. The bounds of neighbours are one number, so that each
/// depth is in exactly one slab.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slabs {
    /// Disparity times depth, pixels · metres.
    k: f64,
    offset: f64,
    /// The slab that reaches to infinity: the first with `m + offset > 0`.
    furthest: i32,
}

impl Slabs {
    pub(super) fn new(k: f64, offset: f64) -> Self {
        Self { k, offset, furthest: ((-offset).floor() as i32).saturating_add(1) }
    }

    /// Slab m is where k / z is in `(m − 1 + offset, m + offset]`.
    pub fn offset(&self) -> f64 {
        self.offset
    }

    /// The slab of a depth above 0, metres. Nearer is larger; what would be past `i32` is the last that `i32` holds.
    pub fn at(&self, depth_m: f64) -> i32 {
        let m = ((self.k / depth_m - self.offset).ceil() as i32).max(self.furthest);
        // The division rounds: the bounds decide.
        if depth_m < self.start_m(m) {
            m.saturating_add(1)
        } else if m > self.furthest && self.start_m(m - 1) <= depth_m {
            m - 1
        } else {
            m
        }
    }

    /// Depths of a slab, metres; empty beyond the one that reaches to infinity.
    pub fn depths_m(&self, slab: i32) -> Range<f64> {
        self.start_m(slab)..self.start_m(slab.saturating_sub(1))
    }

    /// The slabs from one depth to another, both included, metres.
    pub fn between(&self, near_m: f64, far_m: f64) -> SlabRange {
        SlabRange { furthest: self.at(far_m), nearest: self.at(near_m) }
    }

    /// Depths at which the samples of a reference column land within a derived picture of the given width, metres. For
    /// columns beyond the picture's edge, this is all that their rays are needed for.
    pub fn depths_within_m(&self, column: i32, width: u32) -> Range<f64> {
        let last = i32::try_from(width).unwrap_or(i32::MAX).saturating_sub(1);
        self.depths_m(column).start..self.depths_m(column.saturating_sub(last)).end
    }

    /// How far right of its slab's largest shift a sample lands, columns from 0 to 1, by its depth in metres.
    pub fn fraction(&self, slab: i32, depth_m: f64) -> f64 {
        (f64::from(slab) + self.offset - self.k / depth_m).clamp(0.0, 1.0)
    }

    /// Where a slab starts; not before infinity if no depth moves that far.
    fn start_m(&self, slab: i32) -> f64 {
        let over = f64::from(slab) + self.offset;
        if over > 0.0 { self.k / over } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn slabs_are_those_of_the_design() {
        let slabs = Slabs::new(16.0, 0.5);
        assert_eq!(slabs.depths_m(0), 32.0..f64::INFINITY);
        assert_eq!(slabs.depths_m(3), 16.0 / 3.5..16.0 / 2.5);
        assert!(slabs.depths_m(-1).is_empty());
        assert_eq!([f64::INFINITY, 32.0, 16.0, 1.0].map(|depth_m| slabs.at(depth_m)), [0, 0, 1, 16]);
    }

    #[test]
    fn eyes_at_one_place_see_one_slab() {
        let slabs = Slabs::new(0.0, 0.5);
        assert_eq!(slabs.between(1e-9, f64::INFINITY), SlabRange { furthest: 0, nearest: 0 });
        assert_eq!(slabs.depths_m(0), 0.0..f64::INFINITY);
    }

    #[test]
    fn depths_too_near_for_any_picture_saturate() {
        let slabs = Slabs::new(1e3, 0.5);
        assert_eq!(slabs.at(1e-300), i32::MAX);
        assert_eq!(slabs.between(1e-300, 1.0).layers(), i32::MAX as u32 - 999);
    }

    proptest! {
        #[test]
        fn each_depth_is_in_the_slab_that_it_is_given(
            k in 1e-3..1e3_f64, offset in -50.0..50.0_f64, depth_m in 1e-3..1e3_f64,
        ) {
            let slabs = Slabs::new(k, offset);
            let slab = slabs.at(depth_m);
            prop_assert!(slabs.depths_m(slab).contains(&depth_m), "{slab} {:?}", slabs.depths_m(slab));
        }

        #[test]
        fn bounds_belong_to_the_nearer_slab_and_leave_no_gap(
            k in 1e-3..1e3_f64, offset in -50.0..50.0_f64, step in 0..5000_i32,
        ) {
            let slabs = Slabs::new(k, offset);
            let slab = slabs.at(f64::INFINITY) + step;
            let depths_m = slabs.depths_m(slab);
            prop_assert_eq!(slabs.at(depths_m.start), slab);
            prop_assert_eq!(slabs.at(depths_m.start.next_down()), slab + 1);
            prop_assert_eq!(slabs.depths_m(slab + 1).end, depths_m.start);
        }

        #[test]
        fn a_column_lands_within_the_picture_at_just_its_depths(
            k in 1e-3..1e3_f64, offset in -5.0..5.0_f64, column in -40..200_i32, width in 1_u32..100,
            depth_m in 1e-2..1e2_f64,
        ) {
            let slabs = Slabs::new(k, offset);
            let lands_within = (0..width as i32).contains(&(column - slabs.at(depth_m)));
            prop_assert_eq!(slabs.depths_within_m(column, width).contains(&depth_m), lands_within);
        }
    }
}
