//! The picture as a mesh of its first hits.

use crate::scene::*;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::Image;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::view::{Frustum, Orbit, Projection, View};
use wheatstone_core::warp::{GridSettings, grid, quad};

const PLAIN: GridSettings = GridSettings { tear_px: 1.0, close_px: 64.0 };

/// An eye at world (0, 0, 1), looking along −Z.
fn before_plates() -> View {
    let frustum = Frustum::from_fov(0.9, SIZE).unwrap();
    let orbit = Orbit { azimuth_rad: 0.0, elevation_rad: 0.0, distance_m: 1.0 };
    orbit.view(Projection::Perspective(frustum), SIZE)
}

/// Dissimilarity from the true picture of the wanted view: of the picture as it is, of the quad and of the grid.
fn dissimilarities(cast: impl Fn(&View) -> Image, shown: &View, wanted: &View) -> [f64; 3] {
    let (image, truth) = (cast(shown), cast(wanted));
    let by_quad = quad(shown, &image, wanted, 0.0).unwrap();
    let by_grid = grid(shown, &image, wanted, PLAIN).unwrap();
    [&image, &by_quad, &by_grid].map(|picture| dssim(picture, &truth))
}

#[test]
fn the_same_pose_returns_the_picture() {
    let view = front();
    for phantom in [Phantom::Sphere, Phantom::Beetle, Phantom::Present] {
        let image = caster_of(phantom)(&view);
        let warped = grid(&view, &image, &view, PLAIN).unwrap();
        assert!(largest_difference(&warped, &image) < 1e-6);
        for (warped_m, depth_m) in warped.depth_m.iter().zip(&image.depth_m) {
            assert!((warped_m.recip() - depth_m.recip()).abs() < 1e-6, "{warped_m} {depth_m}");
        }
    }
}

#[test]
fn a_turn_is_no_worse_than_that_of_the_quad() {
    let view = front();
    let turned = moved(&view, DVec3::ZERO, DMat3::from_rotation_y(0.06) * DMat3::from_rotation_z(0.1));
    for phantom in [Phantom::Sphere, Phantom::Beetle] {
        let [none, quad, grid] = dissimilarities(caster_of(phantom), &view, &turned);
        assert!(grid < 1.01 * quad && quad < none, "{none} {quad} {grid}");
    }
}

#[test]
fn without_depth_it_is_the_quad() {
    let view = front();
    let mut image = caster_of(Phantom::Beetle)(&view);
    image.depth_m.fill(f32::INFINITY);
    let wanted = moved(&view, DVec3::splat(0.03), DMat3::from_rotation_x(0.05));
    let difference = largest_difference(
        &grid(&view, &image, &wanted, PLAIN).unwrap(),
        &quad(&view, &image, &wanted, 0.0).unwrap(),
    );
    assert!(difference < 1e-3, "{difference}");
}

#[test]
fn a_step_and_a_turn_are_nearer_to_the_truth_than_the_quads() {
    for phantom in [Phantom::Sphere, Phantom::Beetle, Phantom::Present] {
        let cast = caster_of(phantom);
        for step_m in [0.01, 0.03, 0.05] {
            let stepped =
                moved(&front(), DVec3::new(step_m, 0.3 * step_m, 0.0), DMat3::from_rotation_y(-0.03));
            let [none, quad, grid] = dissimilarities(&cast, &front(), &stepped);
            assert!(grid < quad && quad < none, "{phantom} {step_m}: {none} {quad} {grid}");
        }
    }
}

#[test]
fn a_step_aside_before_a_plane_is_all_but_exact() {
    let plane = [Plate { z_m: -0.2, x_m: [-2.0, 2.0], rgb: waves }];
    for step_m in [0.01, 0.05] {
        let stepped = moved(&before_plates(), DVec3::X * step_m, DMat3::IDENTITY);
        let (image, truth) = (painted(&before_plates(), &plane), painted(&stepped, &plane));
        let warped = grid(&before_plates(), &image, &stepped, PLAIN).unwrap();
        // What comes into view at the edge was not seen.
        let seen: Vec<bool> = warped.color.iter().map(|color| color[3] > 0.999).collect();
        assert!(seen.iter().filter(|&&seen| seen).count() > seen.len() * 9 / 10);
        let differences = warped.color.iter().zip(&truth.color).zip(&seen);
        let largest = differences
            .filter(|&(_, &seen)| seen)
            .flat_map(|((warped, truth), _)| {
                warped.iter().zip(truth).map(|(a, b)| (a - b).abs()).collect::<Vec<_>>()
            })
            .fold(0.0, f32::max);
        assert!(largest < 0.01, "{largest}");
    }
}

/// A red plate before a green one; the step opens a hole at its left edge.
fn plates() -> [Plate; 2] {
    [
        Plate { z_m: 0.4, x_m: [-0.1, 0.1], rgb: |_, _| [1.0, 0.0, 0.0] },
        Plate { z_m: -0.3, x_m: [-3.0, 3.0], rgb: |_, _| [0.0, 1.0, 0.0] },
    ]
}

#[test]
fn edges_of_depth_are_torn_and_closed_with_what_is_behind() {
    let view = before_plates();
    for step_m in [-0.05, -0.02, 0.02, 0.05] {
        let stepped = moved(&view, DVec3::new(step_m, 0.01, 0.0), DMat3::IDENTITY);
        let (image, truth) = (painted(&view, &plates()), painted(&stepped, &plates()));
        let warped = grid(&view, &image, &stepped, PLAIN).unwrap();
        let mut wrong = 0;
        let interior = 12..SIZE[0] as usize - 12;
        for (index, (&color, &true_color)) in warped.color.iter().zip(&truth.color).enumerate() {
            let (x, y) = (index % SIZE[0] as usize, index / SIZE[0] as usize);
            if interior.contains(&x) && (4..SIZE[1] as usize - 4).contains(&y) {
                let is_pure = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0]]
                    .iter()
                    .any(|plate| plate.iter().zip(color).all(|(a, b)| (a - b).abs() < 1e-6));
                assert!(is_pure, "{step_m}: {color:?} at {x}, {y}");
                wrong += usize::from((color[0] - true_color[0]).abs() > 1e-6);
            }
        }
        // At most half a pixel at either edge of the near plate.
        assert!(wrong <= 2 * SIZE[1] as usize, "{step_m}: {wrong}");
    }
}

#[test]
fn a_hole_before_nothing_or_wider_than_wanted_is_transparent() {
    let view = before_plates();
    let stepped = moved(&view, DVec3::X * 0.05, DMat3::IDENTITY);
    let clear = |image: &Image| image.color.iter().filter(|color| color[3] < 0.5).count();
    let alone = &plates()[..1];
    let warped = grid(&view, &painted(&view, alone), &stepped, PLAIN).unwrap();
    let truth = painted(&stepped, alone);
    assert!(clear(&warped).abs_diff(clear(&truth)) <= 2 * SIZE[1] as usize);
    let open = GridSettings { close_px: 0.0, ..PLAIN };
    let image = painted(&view, &plates());
    let [closed, open] = [PLAIN, open].map(|settings| grid(&view, &image, &stepped, settings).unwrap());
    assert!(clear(&open) > clear(&closed) + 3 * SIZE[1] as usize, "{} {}", clear(&open), clear(&closed));
}

#[test]
fn any_number_of_threads_makes_one_picture() {
    let view = front();
    let image = caster_of(Phantom::Beetle)(&view);
    let wanted = moved(&view, DVec3::new(0.03, 0.02, -0.05), DMat3::from_rotation_z(0.3));
    let by = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| grid(&view, &image, &wanted, PLAIN).unwrap())
    };
    assert_eq!(by(1), by(3));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_depths_leave_the_same_pose_as_it_is(
        depths_m in prop::collection::vec(prop_oneof![0.1..5.0_f32, Just(f32::INFINITY)], 9 * 7),
        levels in prop::collection::vec(0.0..1.0_f32, 9 * 7),
    ) {
        let size = [9, 7];
        let view = View { size, ..front() };
        let image =
            Image { width: 9, height: 7, color: levels.iter().map(|&l| [l; 4]).collect(), depth_m: depths_m };
        prop_assert!(largest_difference(&grid(&view, &image, &view, PLAIN).unwrap(), &image) < 1e-6);
    }

    #[test]
    fn no_colour_is_beyond_those_of_the_picture(
        depths_m in prop::collection::vec(prop_oneof![0.1..5.0_f32, Just(f32::INFINITY)], 9 * 7),
        levels in prop::collection::vec(0.0..1.0_f32, 9 * 7), step in -0.3..0.3_f64, turn in -0.3..0.3_f64,
    ) {
        let size = [9, 7];
        let view = View { size, ..front() };
        let highest = levels.iter().copied().fold(0.0, f32::max);
        let image =
            Image { width: 9, height: 7, color: levels.iter().map(|&l| [l; 4]).collect(), depth_m: depths_m };
        let wanted = moved(&view, DVec3::new(step, -step, 0.3 * step), DMat3::from_rotation_y(turn));
        let warped = grid(&view, &image, &wanted, PLAIN).unwrap();
        prop_assert!(warped.color.iter().flatten().all(|c| (0.0..=highest + 1e-6).contains(c)));
        prop_assert!(warped.depth_m.iter().all(|&depth_m| depth_m > 0.0));
    }
}
