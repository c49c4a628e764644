//! The picture on a plane.

use crate::scene::*;
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use wheatstone_core::image::Image;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::view::{Frustum, Projection, View};
use wheatstone_core::warp::{PixelMap, quad};

#[test]
fn the_same_pose_returns_the_picture() {
    let view = front();
    let image = caster_of(Phantom::Beetle)(&view);
    assert!(largest_difference(&quad(&view, &image, &view, 0.7).unwrap(), &image) < 1e-6);
}

#[test]
fn a_turn_shows_what_a_cast_shows() {
    let (cast, view) = (caster_of(Phantom::Sphere), front());
    let turned = moved(&view, DVec3::ZERO, DMat3::from_rotation_y(0.06) * DMat3::from_rotation_z(0.1));
    let (image, truth) = (cast(&view), cast(&turned));
    let (still, warped) = (dssim(&image, &truth), dssim(&quad(&view, &image, &turned, 0.7).unwrap(), &truth));
    assert!(warped < 0.003 && warped < 0.1 * still, "{warped}, {still} without");
}

#[test]
fn a_step_aside_moves_what_is_on_the_plane() {
    let (cast, view) = (caster_of(Phantom::Sphere), front());
    let aside = moved(&view, DVec3::new(0.02, -0.01, 0.0), DMat3::IDENTITY);
    let (image, truth) = (cast(&view), cast(&aside));
    let [at_infinity, at_middle] = [0.0, 1.0 / 1.4]
        .map(|inverse_depth| dssim(&quad(&view, &image, &aside, inverse_depth).unwrap(), &truth));
    assert!(at_middle < 0.5 * at_infinity, "{at_middle}, {at_infinity} at infinity");
}

#[test]
fn a_plane_that_the_eye_comes_to_stays_in_front() {
    let view = front();
    let forward = moved(&view, DVec3::new(0.0, 0.0, -2.0), DMat3::IDENTITY);
    let map = PixelMap::between(&forward, &view).unwrap();
    for (inverse_depth, taken) in [(0.0, 0.0), (0.2, 0.2), (0.4, 0.25), (1.0, 0.25)] {
        assert!((map.plane_before_eye(inverse_depth) - taken).abs() < 1e-12, "{inverse_depth}");
    }
}

#[test]
fn windows_and_sizes_may_differ() {
    let (cast, view) = (caster_of(Phantom::Sphere), front());
    let frustum = Frustum::from_fov(0.7, [90, 110]).unwrap().sheared(0.05);
    let wanted = View { projection: Projection::Perspective(frustum), size: [90, 110], ..view };
    let warped = quad(&view, &cast(&view), &wanted, 0.7).unwrap();
    let error = dssim(&warped, &cast(&wanted));
    assert!(error < 0.005, "{error}");
}

#[test]
fn outside_of_the_picture_and_behind_the_eye_is_transparent() {
    let view = front();
    let mut image = Image::transparent(SIZE[0], SIZE[1]);
    image.color.fill([1.0; 4]);
    let back = moved(&view, DVec3::ZERO, DMat3::from_rotation_y(std::f64::consts::PI));
    assert!(quad(&view, &image, &back, 0.0).unwrap().color.iter().all(|&color| color == [0.0; 4]));
    let turned = moved(&view, DVec3::ZERO, DMat3::from_rotation_y(0.2));
    let aside = quad(&view, &image, &turned, 0.7).unwrap();
    let row = &aside.color[65 * SIZE[0] as usize..][..SIZE[0] as usize];
    assert_eq!((row[0], row[SIZE[0] as usize - 1]), ([0.0; 4], [1.0; 4]));
}

proptest! {
    #[test]
    fn points_land_where_the_other_view_sees_them(
        x in 0.0..149.0_f64, y in 0.0..131.0_f64, depth_m in 0.5..4.0_f64, angle in -0.3..0.3_f64, step in -0.2..0.2_f64,
    ) {
        let view = front();
        let wanted = moved(&view, DVec3::new(step, 0.1, -0.5 * step), DMat3::from_rotation_x(angle));
        let (origin, direction) = wheatstone_core::view::RayField::new(&view, glam::DAffine3::IDENTITY).at(x, y);
        let world = origin + depth_m * direction;
        let landing = PixelMap::between(&view, &wanted).unwrap().at(glam::DVec2::new(x, y), 1.0 / depth_m).unwrap();
        prop_assert!(landing.position.distance(wanted.pixel_position(world).unwrap()) < 1e-8);
        let back = PixelMap::between(&wanted, &view).unwrap().onto_plane(1.0 / depth_m);
        let returned = back.at(landing.position, 0.0).unwrap().position;
        prop_assert!(returned.distance(glam::DVec2::new(x, y)) < 1e-8, "{returned}");
        let wanted_depth_m = -wanted.view_from_world.transform_point3(world).z;
        prop_assert!((landing.inverse_depth * wanted_depth_m - 1.0).abs() < 1e-10);
    }
}
