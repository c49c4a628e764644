//! Left is left and right is right: disparities of a stereo pair have the sign and the size of DESIGN §4.

use crate::scene::*;
use crate::tolerance;
use glam::{DAffine3, DVec3};
use wheatstone_core::image::Image;
use wheatstone_core::scene::Mode;
use wheatstone_core::scene::Settings;
use wheatstone_core::view::{Orbit, Projection, Rig, View};

const SIZE: [u32; 2] = [96, 96];
/// Wider than any head, so that disparities of a small picture are many pixels.
const EYE_DISTANCE_M: f64 = 0.2;
const DISTANCE_M: f64 = 1.7;
const SIDE: usize = 48;

/// Balls with soft edges, at heights (rows) of their own, by their centre in voxels.
const BALLS: [DVec3; 3] =
    [DVec3::new(20.0, 38.0, 42.0), DVec3::new(28.0, 24.0, 24.0), DVec3::new(24.0, 10.0, 6.0)];

fn world_from_voxel() -> DAffine3 {
    DAffine3::from_scale(DVec3::splat(1.0 / SIDE as f64))
        * DAffine3::from_translation(DVec3::splat(-0.5 * SIDE as f64))
}

fn pair(rig: Rig) -> Vec<(View, Image)> {
    let volume = volume_of([SIDE; 3], [1.0; 3], |p| {
        BALLS.iter().map(|ball| (-(p - *ball).length_squared() / 8.0).exp()).fold(0.0, f64::max)
    });
    let world_from_patient = DAffine3::from_scale(DVec3::splat(1.0 / SIDE as f64));
    let settings =
        Settings { mode: Mode::Mip, sampling_factor: 2.0, ..Settings::new(unit_window(), grey_transfer()) };
    let middle = Orbit { distance_m: DISTANCE_M, ..Orbit::default() }.view(perspective(1.0, SIZE), SIZE);
    rig.views(&middle)
        .into_iter()
        .map(|view| (view, cast_at(&volume, world_from_patient, &settings, &view).image))
        .collect()
}

/// Row and column of a world point in a picture.
fn pixel_of(view: &View, world: DVec3) -> (f64, f64) {
    let Projection::Perspective(f) = view.projection else { panic!("these views are perspective") };
    let p = view.view_from_world.transform_point3(world);
    let across = (p.x / -p.z - f.left) / (f.right - f.left);
    let down = (f.up - p.y / -p.z) / (f.up - f.down);
    (across * f64::from(SIZE[0]), down * f64::from(SIZE[1]))
}

/// How far to the left a block of the left picture lies in the right one: the shift with the smallest sum of squared
/// differences, refined by a parabola. Positive: further left for the right eye.
fn disparity(left: &Image, right: &Image, (column, row): (f64, f64)) -> f64 {
    const HALF: i64 = 5;
    let (column, row) = (column as i64, row as i64);
    let level = |image: &Image, x: i64, y: i64| {
        if (0..i64::from(SIZE[0])).contains(&x) {
            f64::from(color_at(image, x as u32, y as u32)[0])
        } else {
            0.0
        }
    };
    let cost = |shift: i64| -> f64 {
        (row - HALF..=row + HALF)
            .flat_map(|y| (column - HALF..=column + HALF).map(move |x| (x, y)))
            .map(|(x, y)| (level(left, x, y) - level(right, x - shift, y)).powi(2))
            .sum()
    };
    let best = (-25..=25).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap();
    let [before, at, after] = [cost(best - 1), cost(best), cost(best + 1)];
    best as f64 + 0.5 * (before - after) / (before - 2.0 * at + after)
}

#[test]
fn disparity_is_k_over_z_and_grows_towards_the_eyes() {
    let pair = pair(Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY });
    // k = w·e / (2 tan α), α half of the field of view of 1 rad.
    let k = f64::from(SIZE[0]) * EYE_DISTANCE_M / (2.0 * 0.5_f64.tan());
    let mut found = Vec::new();
    for ball in BALLS {
        let world = world_from_voxel().transform_point3(ball);
        let disparity = disparity(&pair[0].1, &pair[1].1, pixel_of(&pair[0].0, world));
        let expected = k / (DISTANCE_M - world.z);
        assert!(
            (disparity - expected).abs() < tolerance::DISPARITY_PIXELS,
            "{ball}: {disparity}, not {expected}"
        );
        found.push(disparity);
    }
    assert!(found[0] > found[1] + 1.0 && found[1] > found[2] + 1.0 && found[2] > 1.0, "{found:?}");
}

#[test]
fn convergence_leaves_its_depth_in_place() {
    let pair = pair(Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: DISTANCE_M });
    let k = f64::from(SIZE[0]) * EYE_DISTANCE_M / (2.0 * 0.5_f64.tan());
    for ball in BALLS {
        let world = world_from_voxel().transform_point3(ball);
        let disparity = disparity(&pair[0].1, &pair[1].1, pixel_of(&pair[0].0, world));
        let expected = k / (DISTANCE_M - world.z) - k / DISTANCE_M;
        assert!(
            (disparity - expected).abs() < tolerance::DISPARITY_PIXELS,
            "{ball}: {disparity}, not {expected}"
        );
    }
}

#[test]
fn the_left_eye_sees_more_of_the_left_side() {
    // A wall across the middle hides what is behind it; its left face is seen by the left eye alone.
    let volume = volume_of([SIDE; 3], [1.0; 3], |p| {
        if p.x > 23.0 && p.x < 25.0 { if p.z > 24.0 { 1.0 } else { 0.6 } } else { 0.0 }
    });
    let world_from_patient = DAffine3::from_scale(DVec3::splat(1.0 / SIDE as f64));
    let settings = exact_settings(unit_window(), white_transfer(&[(0.2, 0.0), (0.6, 0.9)]));
    let middle = Orbit { distance_m: DISTANCE_M, ..Orbit::default() }.view(perspective(1.0, SIZE), SIZE);
    let eyes = Rig::Stereo { eye_distance_m: EYE_DISTANCE_M, convergence_m: f64::INFINITY }.views(&middle);
    // How far the wall reaches to the left and to the right of its front edge's middle, in solid pixels of one row.
    let reach = |view: &View| {
        let image = cast_at(&volume, world_from_patient, &settings, view).image;
        let front = pixel_of(view, DVec3::new(0.0, 0.0, 0.5)).0;
        let solid: Vec<f64> =
            (0..SIZE[0]).filter(|&x| color_at(&image, x, 48)[3] > 0.5).map(|x| f64::from(x) + 0.5).collect();
        (front - solid[0], solid[solid.len() - 1] - front)
    };
    let (left_eye, right_eye) = (reach(&eyes[0]), reach(&eyes[1]));
    // The far edge of a wall that is seen from its left lies to the left of its front edge, towards the middle of the
    // picture's vanishing point: for the left eye, which is left of the wall, the wall recedes to the left.
    assert!(left_eye.0 > left_eye.1 + 1.0, "left eye: {left_eye:?}");
    assert!(right_eye.1 > right_eye.0 + 1.0, "right eye: {right_eye:?}");
}
