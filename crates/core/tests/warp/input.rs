//! Input that is no picture, no view, or no pair of them.

use crate::scene::*;
use glam::{DAffine3, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::Image;
use wheatstone_core::view::{Frustum, OrthographicBox, Projection, View};
use wheatstone_core::warp::{GridSettings, WarpError, grid, quad};

type Warp = fn(&View, &Image, &View) -> Result<Image, WarpError>;

/// Every warp at its default.
const WARPS: [Warp; 2] = [
    |shown, image, wanted| quad(shown, image, wanted, 0.7),
    |shown, image, wanted| grid(shown, image, wanted, GridSettings::default()),
];

fn blank() -> Image {
    Image::transparent(SIZE[0], SIZE[1])
}

/// What every warp answers with either view replaced.
fn errors(spoiled: View) -> Vec<WarpError> {
    let of = |shown: View, wanted: View| WARPS.map(|warp| warp(&shown, &blank(), &wanted).unwrap_err());
    [of(spoiled, front()), of(front(), spoiled)].concat()
}

#[test]
fn a_picture_of_another_size_is_refused() {
    for warp in WARPS {
        let other = Image::transparent(SIZE[0], 7);
        let mismatch = WarpError::Mismatch { image: [SIZE[0], 7], view: SIZE };
        assert_eq!(warp(&front(), &other, &front()).unwrap_err(), mismatch);
        let mut short = blank();
        short.color.pop();
        assert!(matches!(warp(&front(), &short, &front()), Err(WarpError::Pixels { .. })));
    }
}

#[test]
fn views_without_pixels_or_with_too_many_are_refused() {
    for size in [[0, 5], [5, 0], [u32::MAX, u32::MAX]] {
        let found = errors(View { size, ..front() });
        assert!(found.iter().all(|error| matches!(error, WarpError::Size { .. })), "{found:?}");
    }
}

#[test]
fn parallel_projections_are_refused() {
    let parallel = Projection::Orthographic(OrthographicBox::from_height(1.0, SIZE).unwrap());
    let found = errors(View { projection: parallel, ..front() });
    assert!(found.iter().all(|error| matches!(error, WarpError::Projection(_))), "{found:?}");
}

#[test]
fn poses_and_windows_without_meaning_are_refused() {
    let window = Frustum::from_fov(0.9, SIZE).unwrap();
    let seen_through = |frustum| View { projection: Projection::Perspective(frustum), ..front() };
    let posed = |view_from_world| View { view_from_world, ..front() };
    for view in [
        posed(DAffine3::from_translation(DVec3::NAN)),
        posed(DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0))),
        posed(DAffine3::from_scale(DVec3::splat(f64::INFINITY))),
        seen_through(Frustum { left: f64::NAN, ..window }),
        seen_through(Frustum { up: f64::INFINITY, ..window }),
        seen_through(Frustum { right: window.left, ..window }),
        seen_through(Frustum { near_m: f64::NAN, ..window }),
    ] {
        let found = errors(view);
        assert!(found.iter().all(|error| matches!(error, WarpError::View(_))), "{found:?}");
    }
}

#[test]
fn settings_that_are_no_distances_are_refused() {
    for distance_px in [-1.0, f64::NAN, f64::INFINITY] {
        let plain = GridSettings::default();
        for settings in
            [GridSettings { tear_px: distance_px, ..plain }, GridSettings { close_px: distance_px, ..plain }]
        {
            let answer = grid(&front(), &blank(), &front(), settings);
            assert!(matches!(answer, Err(WarpError::Distance(..))), "{settings:?}");
        }
    }
}

proptest! {
    #[test]
    fn any_numbers_give_a_picture_or_an_error(
        pose in prop::array::uniform12(prop::num::f64::ANY), sides in prop::array::uniform4(prop::num::f64::ANY),
        depth_m in prop::num::f32::ANY, color in prop::array::uniform4(prop::num::f32::ANY),
    ) {
        let [left, right, down, up] = sides;
        let frustum = Frustum { left, right, down, up, near_m: 0.01, far_m: f64::INFINITY };
        let size = [5, 4];
        let strange = View {
            view_from_world: DAffine3::from_cols_array(&pose),
            projection: Projection::Perspective(frustum),
            size,
            shaded_from: None,
        };
        let plain = View { size, ..front() };
        let image = Image { width: 5, height: 4, color: vec![color; 20], depth_m: vec![depth_m; 20] };
        for warp in WARPS {
            let _ = (warp(&strange, &image, &plain), warp(&plain, &image, &strange));
        }
    }
}
