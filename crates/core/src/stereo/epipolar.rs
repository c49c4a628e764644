//! What two parallel views have in common.

use super::{Slabs, StereoError};
use crate::view::{Frustum, Projection, View, whole_pixels};
use glam::{DMat3, DVec3};
use std::ops::Range;

/// Most that a pair may be off the ideal, pixels.
const TOLERANCE_PX: f64 = 1.0 / 16.0;

/// Most that the derived eye may be above or before the reference eye, as a share of the eye distance.
const BASELINE_TOLERANCE: f64 = 1e-3;

/// The map from a reference view to a derived one whose image plane is parallel, whose eye is apart along view X only, and
/// whose window is as large; the window may lie elsewhere (off-axis), as for convergence at a finite distance and for
/// headsets.
///
/// A point at depth z that the reference eye sees in column `x_r` is in column `x_d = x_r + c − k/z` of the derived picture
/// (SP Eq. 2 and 3 in pixels; VR Source 1 without its matrices), in the same row. It is shaded as for
/// the reference eye, which is as for the derived one if both are of one [`Rig`](crate::view::Rig).
///
/// `k`, `c`, slabs and shifts count **sweep** columns: from the left if the derived eye is to the right, else mirrored,
/// from the right. There k is not negative and nearer means further left, so that algorithms need one direction only:
/// reference rays from the last sweep column to the first, each front to back, reach every derived pixel front to back.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Epipolar {
    reference: View,
    derived: View,
    depth_range_m: (f64, f64),
    pixels_per_tangent: f64,
    is_mirrored: bool,
    k: f64,
    c: f64,
}

impl Epipolar {
    /// Compares two views. What is off by less than a pixel's sixteenth counts as equal.
    ///
    /// # Errors
    /// What keeps the derived view from being a shift of the reference view, column by column.
    pub fn new(reference: &View, derived: &View) -> Result<Self, StereoError> {
        let (Projection::Perspective(of_reference), Projection::Perspective(of_derived)) =
            (reference.projection, derived.projection)
        else {
            return Err(StereoError::Projection);
        };
        if reference.size != derived.size {
            return Err(StereoError::Size { reference: reference.size, derived: derived.size });
        }
        let [width, height] = reference.size.map(f64::from);
        let [extent, derived_extent] = [of_reference, of_derived].map(|f| f.right - f.left);
        let pixels_per_tangent = width / extent;
        let is_same_extent = (derived_extent - extent).abs() * pixels_per_tangent <= TOLERANCE_PX;
        if !(extent > 0.0 && extent.is_finite() && is_same_extent) {
            return Err(StereoError::HorizontalExtent { reference: extent, derived: derived_extent });
        }
        check_rows(&of_reference, &of_derived, height)?;
        let [range, derived_range] = [of_reference, of_derived].map(|f| [f.near_m, f.far_m]);
        if range != derived_range {
            return Err(StereoError::DepthRange { reference: range, derived: derived_range });
        }
        let reference_from_derived = reference.view_from_world * derived.view_from_world.inverse();
        check_orientation(reference_from_derived.matrix3, pixels_per_tangent)?;
        let eye_distance_m = right_of_reference_m(reference_from_derived.translation)?;

        let k = pixels_per_tangent * eye_distance_m;
        let c = pixels_per_tangent * (of_reference.left - of_derived.left);
        let is_mirrored = k < 0.0;
        Ok(Self {
            reference: *reference,
            derived: *derived,
            depth_range_m: (of_reference.near_m, of_reference.far_m),
            pixels_per_tangent,
            is_mirrored,
            k: k.abs(),
            c: if is_mirrored { -c } else { c },
        })
    }

    /// The view that is cast.
    pub fn reference(&self) -> &View {
        &self.reference
    }

    /// The view that is derived.
    pub fn derived(&self) -> &View {
        &self.derived
    }

    /// Whether sweep columns count from the right: the derived eye is to the left.
    pub fn is_mirrored(&self) -> bool {
        self.is_mirrored
    }

    /// Disparity times depth, pixels · metres: w·e / (2 tan α) for symmetric views.
    pub fn k(&self) -> f64 {
        self.k
    }

    /// Distance of the eyes, metres.
    pub fn eye_distance_m(&self) -> f64 {
        self.k / self.pixels_per_tangent
    }

    /// Depth from which on rays of both eyes through a sample are alike enough for one to stand for the other, metres: twice
    /// the eyes' distance, where they are half a radian apart. Nearer ones cross slabs on ways of other lengths.
    pub fn least_depth_m(&self) -> f64 {
        2.0 * self.eye_distance_m()
    }

    /// Shift of what is infinitely far away, pixels: k over the depth at which the eyes converge.
    pub fn c(&self) -> f64 {
        self.c
    }

    /// From a column of either picture to the sweep column, and back. Columns beyond the edges are columns, too.
    pub fn sweep_column(&self, column: i32) -> i32 {
        if self.is_mirrored { self.width() - 1 - column } else { column }
    }

    /// Where a point that the reference eye sees at a picture position along x is along x in the derived picture, pixels
    /// from the left, for a depth in metres.
    pub fn derived_position(&self, x: f64, depth_m: f64) -> f64 {
        let shift = self.c - self.k / depth_m;
        if self.is_mirrored { x - shift } else { x + shift }
    }

    /// Slabs of depth whose samples land on the nearest column.
    pub fn slabs(&self) -> Slabs {
        Slabs::new(self.k, self.c + 0.5)
    }

    /// Slabs of depth whose samples land between the column that the slab gives and the one after it.
    pub fn slabs_between_columns(&self) -> Slabs {
        Slabs::new(self.k, self.c)
    }

    /// Pixels per metre in a plane at a depth: s of SP Eq. 4 (VR Eq. 17).
    pub fn pixels_per_metre(&self, depth_m: f64) -> f64 {
        self.pixels_per_tangent / depth_m
    }

    /// Pixels over which a ray spreads in the derived picture: `d_p` of SP Eq. 5 (VR Eq. 18) between two depths in metres,
    /// of which the far one may be infinite: d∞, `d_z` and, from h to h + 2r, `d_r` of SP Eq. 6–8 (VR Eq. 19–21).
    pub fn pixel_range(&self, near_m: f64, far_m: f64) -> f64 {
        self.k / near_m - self.k / far_m
    }

    /// Least distance of the near plane, metres, at which rays through a sphere of the given radius spread over no more
    /// than a number of pixels: h of SP Eq. 9 (VR Eq. 22).
    pub fn nearest_distance_m(&self, radius_m: f64, pixel_range: f64) -> f64 {
        (radius_m * radius_m + 2.0 * self.k * radius_m / pixel_range).sqrt() - radius_m
    }

    /// Depths between which a convex body lies, by its corners in world space, as far as the reference view goes, metres.
    /// From the near plane if the eye is in the body; nothing if all of it is too near or too far.
    pub fn depths_m(&self, corners_world: &[DVec3]) -> Option<Range<f64>> {
        let (near_m, far_m) = self.reference.depths_m(corners_world);
        let depths_m = near_m.max(self.depth_range_m.0)..far_m.min(self.depth_range_m.1);
        (!depths_m.is_empty()).then_some(depths_m)
    }

    /// Sweep columns, of the given ones, whose reference rays can meet a convex body, by its corners in world space.
    pub fn columns_of(&self, corners_world: &[DVec3], columns: &Range<i32>) -> Range<i32> {
        let seen: Option<Vec<f64>> = corners_world
            .iter()
            .map(|&at| {
                let x = self.reference.pixel_position(at)?.x;
                Some(if self.is_mirrored { f64::from(self.width()) - x } else { x })
            })
            .collect();
        let Some(seen) = seen else { return columns.clone() };
        let Range { start, end } = whole_pixels(seen.into_iter());
        columns.start.max(start as i32)..columns.end.min(end as i32)
    }

    fn width(&self) -> i32 {
        i32::try_from(self.reference.size[0]).unwrap_or(i32::MAX)
    }
}

fn check_rows(reference: &Frustum, derived: &Frustum, height: f64) -> Result<(), StereoError> {
    let pixels_per_tangent = height / (reference.up - reference.down).abs();
    let is_near = |a: f64, b: f64| (a - b).abs() * pixels_per_tangent <= TOLERANCE_PX;
    if is_near(reference.down, derived.down) && is_near(reference.up, derived.up) {
        return Ok(());
    }
    Err(StereoError::VerticalTangents {
        reference: [reference.down, reference.up],
        derived: [derived.down, derived.up],
    })
}

fn check_orientation(reference_from_derived: DMat3, pixels_per_tangent: f64) -> Result<(), StereoError> {
    let off = reference_from_derived - DMat3::IDENTITY;
    let is_parallel = off.to_cols_array().iter().all(|o| o.abs() * pixels_per_tangent <= TOLERANCE_PX);
    if is_parallel {
        return Ok(());
    }
    let trace = (0..3).map(|axis| reference_from_derived.col(axis)[axis]).sum::<f64>();
    Err(StereoError::Orientation { angle_rad: (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos() })
}

fn right_of_reference_m(eye: DVec3) -> Result<f64, StereoError> {
    let tolerance_m = (BASELINE_TOLERANCE * eye.x.abs()).max(f64::from(f32::EPSILON));
    if eye.y.abs() <= tolerance_m && eye.z.abs() <= tolerance_m {
        return Ok(eye.x);
    }
    Err(StereoError::Baseline { up_m: eye.y, back_m: eye.z })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stereo::SlabRange;
    use crate::view::{Orbit, OrthographicBox, Rig};
    use glam::{DAffine3, DQuat};
    use proptest::prelude::*;

    const SIZE: [u32; 2] = [96, 64];

    fn pair(fov_rad: f64, eye_distance_m: f64, convergence_m: f64, size: [u32; 2]) -> [View; 2] {
        let frustum = Frustum::from_fov(fov_rad, size).unwrap();
        let middle = Orbit { azimuth_rad: 0.4, elevation_rad: 0.2, ..Orbit::default() }
            .view(Projection::Perspective(frustum), size);
        Rig::Stereo { eye_distance_m, convergence_m }.views(&middle).try_into().unwrap()
    }

    /// The papers' set-up: 768², 2α = 110°, e = 0.065 m.
    fn papers() -> Epipolar {
        let [left, right] = pair(110.0_f64.to_radians(), 0.065, f64::INFINITY, [768; 2]);
        Epipolar::new(&left, &right).unwrap()
    }

    fn frustum(view: &mut View) -> &mut Frustum {
        let Projection::Perspective(frustum) = &mut view.projection else { unreachable!() };
        frustum
    }

    #[test]
    fn near_planes_and_ranges_are_the_papers() {
        let epipolar = papers();
        let (radius_m, d_p) = (0.5 * 3.0_f64.sqrt(), 32.0);
        let h = epipolar.nearest_distance_m(radius_m, d_p);
        // 0.4363; the papers print 0.435.
        assert!((h - 0.435).abs() < 2e-3, "{h}");
        let tan = 55.0_f64.to_radians().tan();
        let s = 768.0 / (2.0 * h * tan);
        assert!((epipolar.k() - 768.0 * 0.065 / (2.0 * tan)).abs() < 1e-9);
        assert!((epipolar.pixels_per_metre(h) - s).abs() < 1e-9);
        let infinite = epipolar.pixel_range(h, f64::INFINITY);
        assert!((infinite - s * 0.065).abs() < 1e-9);
        let finite = epipolar.pixel_range(h, 3.0);
        assert!((finite - s * (0.065 - 0.065 * h / 3.0)).abs() < 1e-9);
        assert!((epipolar.pixel_range(h, h + 2.0 * radius_m) - d_p).abs() < 1e-9);
    }

    #[test]
    fn a_sphere_takes_as_many_layers_as_columns_that_its_pixel_range_touches() {
        let epipolar = papers();
        let radius_m = 0.5 * 3.0_f64.sqrt();
        let h = epipolar.nearest_distance_m(radius_m, 32.0);
        // A pixel range d_p touches at most d_p + 1 columns, rounded up.
        assert!((32..=33).contains(&epipolar.slabs().between(h, h + 2.0 * radius_m).layers()));
    }

    #[test]
    fn the_eyes_swap_by_mirroring() {
        let [left, right] = pair(1.0, 0.065, 1.3, SIZE);
        let to_right = Epipolar::new(&left, &right).unwrap();
        let to_left = Epipolar::new(&right, &left).unwrap();
        assert!(!to_right.is_mirrored() && to_left.is_mirrored());
        assert!((to_right.k() - to_left.k()).abs() < 1e-12 && (to_right.c() - to_left.c()).abs() < 1e-12);
        assert!((to_right.c() - to_right.k() / 1.3).abs() < 1e-12);
        assert_eq!([0, 5, 96, -1].map(|x| to_left.sweep_column(x)), [95, 90, -1, 96]);
        assert_eq!([0, 5, 96, -1].map(|x| to_right.sweep_column(x)), [0, 5, 96, -1]);
    }

    #[test]
    fn mirrored_windows_of_a_headset_shift_infinity() {
        let [mut left, mut right] = pair(1.0, 0.065, f64::INFINITY, SIZE);
        (frustum(&mut left).left, frustum(&mut left).right) = (-1.4, 1.1);
        (frustum(&mut right).left, frustum(&mut right).right) = (-1.1, 1.4);
        let epipolar = Epipolar::new(&left, &right).unwrap();
        assert!((epipolar.c() + 0.3 * 96.0 / 2.5).abs() < 1e-9);
        assert_eq!(epipolar.slabs().at(f64::INFINITY), 12);
    }

    #[test]
    fn eyes_that_share_no_rays_are_told_why() {
        let [left, right] = pair(1.0, 0.065, f64::INFINITY, SIZE);
        let why = |change: &dyn Fn(&mut View)| {
            let mut changed = right;
            change(&mut changed);
            Epipolar::new(&left, &changed).err()
        };
        let move_eye = |view: &mut View, by: DVec3| {
            view.view_from_world = DAffine3::from_translation(-by) * view.view_from_world;
        };
        assert_eq!(why(&|_| ()), None);
        assert_eq!(why(&|view| move_eye(view, DVec3::X * 0.1)), None);
        assert!(matches!(why(&|view| view.size = [96, 63]), Some(StereoError::Size { .. })));
        assert!(matches!(
            why(&|view| frustum(view).right += 0.1),
            Some(StereoError::HorizontalExtent { .. })
        ));
        assert!(matches!(why(&|view| frustum(view).up += 0.1), Some(StereoError::VerticalTangents { .. })));
        assert!(matches!(why(&|view| frustum(view).near_m = 0.5), Some(StereoError::DepthRange { .. })));
        assert!(matches!(why(&|view| move_eye(view, DVec3::Y * 0.01)), Some(StereoError::Baseline { .. })));
        assert!(matches!(why(&|view| move_eye(view, DVec3::Z * 0.01)), Some(StereoError::Baseline { .. })));
        let toed_in = why(&|view| {
            view.view_from_world = DAffine3::from_rotation_y(0.03) * view.view_from_world;
        });
        let Some(StereoError::Orientation { angle_rad }) = toed_in else { panic!("{toed_in:?}") };
        assert!((angle_rad - 0.03).abs() < 1e-9);
        let parallel = OrthographicBox::from_height(1.0, SIZE).unwrap();
        let is_parallel = why(&|view| view.projection = Projection::Orthographic(parallel));
        assert_eq!(is_parallel, Some(StereoError::Projection));
        let mut flat = left;
        frustum(&mut flat).right = frustum(&mut flat).left;
        assert!(matches!(Epipolar::new(&flat, &flat), Err(StereoError::HorizontalExtent { .. })));
    }

    #[test]
    fn matrices_of_headsets_are_parallel_enough() {
        let [left, mut right] = pair(1.9, 0.063, f64::INFINITY, [2000, 2200]);
        let (_, rotation, eye) = right.view_from_world.to_scale_rotation_translation();
        let rounded = DQuat::from_array(rotation.to_array().map(|q| f64::from(q as f32)));
        right.view_from_world = DAffine3::from_rotation_translation(rounded, eye);
        assert!(Epipolar::new(&left, &right).is_ok());
    }

    #[test]
    fn an_eye_in_a_body_counts_from_the_near_plane() {
        let [mut left, mut right] = pair(1.0, 0.065, f64::INFINITY, SIZE);
        let corners = |half: f64| -> [DVec3; 8] {
            std::array::from_fn(|i| {
                DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { -half } else { half }))
            })
        };
        frustum(&mut left).near_m = 0.02;
        frustum(&mut right).near_m = 0.02;
        let epipolar = Epipolar::new(&left, &right).unwrap();
        let depths_m = epipolar.depths_m(&corners(0.3)).unwrap();
        assert!(depths_m.start > 1.2 && depths_m.end < 2.3, "{depths_m:?}");
        assert_eq!(epipolar.depths_m(&corners(9.0)).unwrap().start, 0.02);
        let behind = corners(0.3).map(|at| at + left.view_from_world.inverse().translation * 2.0);
        assert_eq!(epipolar.depths_m(&behind), None);
    }

    proptest! {
        #[test]
        fn a_point_that_both_eyes_see_is_where_the_map_says(
            point in prop::array::uniform3(-0.6..0.6_f64), eye_distance_m in -0.3..0.3_f64,
            convergence_m in prop_oneof![Just(f64::INFINITY), 0.3..5.0_f64], shear in -0.5..0.5_f64,
        ) {
            let [left, mut right] = pair(1.2, eye_distance_m, convergence_m, SIZE);
            *frustum(&mut right) = frustum(&mut right).sheared(shear);
            let epipolar = Epipolar::new(&left, &right).unwrap();
            let at = DVec3::from(point);
            let depth_m = -left.view_from_world.transform_point3(at).z;
            let (seen, also) = (left.pixel_position(at).unwrap(), right.pixel_position(at).unwrap());
            prop_assert!((also.y - seen.y).abs() < 1e-9);
            prop_assert!((also.x - epipolar.derived_position(seen.x, depth_m)).abs() < 1e-9);
            // The same in whole sweep columns, if the point is in the middle of its reference column.
            let column = seen.x.floor();
            let middle = epipolar.derived_position(column + 0.5, depth_m);
            let slab = epipolar.slabs().at(depth_m);
            let landed = epipolar.sweep_column(epipolar.sweep_column(column as i32) - slab);
            prop_assert!((middle - (f64::from(landed) + 0.5)).abs() <= 0.5 + 1e-9, "{middle} {landed}");
        }

        #[test]
        fn points_of_a_body_are_in_its_slabs(
            lo in prop::array::uniform3(-1.0..0.9_f64), hi in prop::array::uniform3(0.0..1.0_f64),
            share in prop::array::uniform3(0.0..1.0_f64), convergence_m in 0.5..5.0_f64,
        ) {
            let [left, right] = pair(1.2, 0.2, convergence_m, SIZE);
            let epipolar = Epipolar::new(&left, &right).unwrap();
            let (lo, hi) = (DVec3::from(lo), DVec3::from(lo) + 0.01 + DVec3::from(hi));
            let corners: Vec<DVec3> = (0..8)
                .map(|i| DVec3::from([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { lo[axis] } else { hi[axis] })))
                .collect();
            let point = lo + (hi - lo) * DVec3::from(share);
            let depth_m = -left.view_from_world.transform_point3(point).z;
            prop_assume!(depth_m > 0.001);
            let depths_m = epipolar.depths_m(&corners).unwrap();
            let SlabRange { furthest, nearest } = epipolar.slabs().between(depths_m.start, depths_m.end);
            prop_assert!((furthest..=nearest).contains(&epipolar.slabs().at(depth_m)));
        }
    }
}
