//! Shadows, ambient occlusion and directional light on scenes where it is plain what must be dark.

use crate::scene::*;
use glam::{DVec3, Vec3};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::scene::{Light, Mode, Settings, Shading};
use wheatstone_core::view::View;
use wheatstone_core::volume::Volume;

/// Opaque from a value of ½ upwards, so that one sample decides.
fn solid_settings(mode: Mode, shading: Shading) -> Settings {
    let transfer = white_transfer(&[(0.5, 0.0), (0.5, 1.0)]);
    Settings {
        mode,
        shading,
        surface_rgb: Some([1.0; 3]),
        light: Light::Directional(Vec3::new(1.0, 0.0, 1.0)),
        ..exact_settings(unit_window(), transfer)
    }
}

const SOLID_MODES: [Mode; 2] = [Mode::Composite, Mode::Isosurface { isovalue: 0.5 }];

/// A wall behind a floating block: 40 mm cubed, the wall at z < 6, the block at x 20–30, y 12–24, z 18–21.
fn wall_and_block() -> Volume {
    volume_of([40, 40, 40], [1.0; 3], |p| {
        let is_wall = p.z < 6.0;
        let is_block =
            (20.0..30.0).contains(&p.x) && (12.0..24.0).contains(&p.y) && (18.0..21.0).contains(&p.z);
        f64::from(u8::from(is_wall || is_block))
    })
}

/// One pixel per millimetre, seen from +z: pixel (x, y) shows x + ½ mm and 39½ mm − y.
fn front_view() -> View {
    let size = [40, 40];
    look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(40.0 * METRES_PER_MM, size), size)
}

#[test]
fn a_block_shadows_what_lies_behind_it_from_the_light_and_nothing_else() {
    let (volume, view) = (wall_and_block(), front_view());
    for mode in SOLID_MODES {
        let unlit = cast(&volume, &solid_settings(mode, Shading::None), &view).image;
        let shadowed = cast(&volume, &solid_settings(mode, Shading::Shadow), &view).image;
        let (mut dark, mut light) = (0, 0);
        for (x, y) in pixels(&view) {
            let (mm_x, mm_y) = (f64::from(x) + 0.5, 39.5 - f64::from(y));
            let before = color_at(&unlit, x, y);
            let after = color_at(&shadowed, x, y);
            assert_eq!(before, [1.0; 4], "{mode:?} ({x}, {y})");
            assert_eq!(after[3], 1.0, "shadow is no hole: {mode:?} ({x}, {y})");
            // The light comes along (1, 0, 1): from the wall's face at z = 6 the block at z 18–21 is 12–15 mm to the
            // right. A voxel on either side of an edge is left out.
            let within = |v: f64, lo: f64, hi: f64| v > lo && v < hi;
            let in_block_rows = within(mm_y, 11.0, 25.0);
            let in_inner_rows = within(mm_y, 13.0, 23.0);
            let may_be_dark = in_block_rows && within(mm_x, 20.0 - 15.0 - 2.0, 30.0 - 12.0 + 2.0);
            let may_be_block = in_block_rows && within(mm_x, 19.0, 31.0);
            let is_dark = in_inner_rows && within(mm_x, 20.0 - 12.0 + 1.0, 30.0 - 15.0 - 1.0);
            let is_lit_block = in_inner_rows && within(mm_x, 21.0, 29.0);
            if is_dark {
                assert!(after[0] < 1e-3, "{mode:?}: light in the shadow at ({x}, {y}): {}", after[0]);
                dark += 1;
            } else if is_lit_block || (!may_be_dark && !may_be_block) {
                assert_eq!(after, before, "{mode:?}: shadow in the light at ({x}, {y})");
                light += 1;
            }
        }
        assert!(dark > 40 && light > 900, "{mode:?}: {dark} dark, {light} light");
    }
}

#[test]
fn a_shadow_turns_with_the_light() {
    let (volume, view) = (wall_and_block(), front_view());
    let darkest_column = |light: Vec3| {
        let settings =
            Settings { light: Light::Directional(light), ..solid_settings(SOLID_MODES[1], Shading::Shadow) };
        let image = cast(&volume, &settings, &view).image;
        // Mean column of the dark pixels of the wall in the row through the block's middle.
        let dark: Vec<f64> = (0..40).filter(|&x| color_at(&image, x, 21)[0] < 0.5).map(f64::from).collect();
        assert!(!dark.is_empty(), "{light}");
        dark.iter().sum::<f64>() / dark.len() as f64
    };
    let (from_right, from_left) =
        (darkest_column(Vec3::new(1.0, 0.0, 1.0)), darkest_column(Vec3::new(-0.6, 0.0, 1.0)));
    assert!(from_right < 15.0 && from_left > 29.0, "{from_right} {from_left}");
}

#[test]
fn a_crevice_is_darker_than_a_face() {
    // A wall at z < 12 with a step up to z < 24 where x < 20: the inner edge is at x = 20, z = 12.
    let volume =
        volume_of([40, 40, 40], [1.0; 3], |p| f64::from(u8::from(p.z < 12.0 || (p.z < 24.0 && p.x < 20.0))));
    let view = front_view();
    for mode in SOLID_MODES {
        let image = cast(&volume, &solid_settings(mode, Shading::Ambient), &view).image;
        let level = |x: u32| color_at(&image, x, 20)[0];
        let (crevice, face, edge) = (level(20), level(33), level(19));
        // Of 14 points around a spot on a plane, 5 lie behind it and 4 on it.
        assert!((5.0 / 14.0 - 1e-3..=9.0 / 14.0 + 1e-3).contains(&face), "{mode:?}: {face}");
        assert!(crevice < face - 0.1, "{mode:?}: crevice {crevice}, face {face}");
        assert!(edge > face, "{mode:?}: an outer edge is more open than a face: {edge} {face}");
    }
}

#[test]
fn a_flat_face_is_evenly_lit_from_around() {
    // A cube of 24 mm: on the faces' inner 12 mm no sample of the surroundings comes near an edge.
    let cube = |p: DVec3, middle: DVec3| f64::from(u8::from((p - middle).abs().max_element() < 12.0));
    let volumes = [
        ("cubes", volume_of([40, 40, 40], [1.0; 3], |p| cube(p, DVec3::splat(20.0)))),
        (
            "bricks",
            volume_of([40, 40, 20], [1.0, 1.0, 2.0], |p| {
                cube(p * DVec3::new(1.0, 1.0, 2.0), DVec3::splat(20.0))
            }),
        ),
    ];
    let size = [48, 48];
    let at = DVec3::ZERO;
    let views = [
        ("front", look(DVec3::Z, at, DVec3::Y, orthographic(0.3, size), size)),
        ("oblique", look(DVec3::new(0.21, 0.13, 0.5), at, DVec3::Y, perspective(0.7, size), size)),
    ];
    for (lattice, volume) in &volumes {
        for (name, view) in &views {
            for isovalue in [0.3, 0.5] {
                let settings = solid_settings(Mode::Isosurface { isovalue }, Shading::Ambient);
                let image = cast(volume, &settings, view).image;
                let levels: Vec<f32> = pixels(view)
                    .filter(|&(x, y)| {
                        let (origin, direction) = world_ray(view, x, y);
                        let mm = (origin + direction * depth_at_m(&image, x, y)) / METRES_PER_MM;
                        mm.x.abs() < 6.0 && mm.y.abs() < 6.0 && (mm.z - 12.0).abs() < 1.5
                    })
                    .map(|(x, y)| color_at(&image, x, y)[0])
                    .collect();
                assert!(levels.len() > 100, "{lattice} {name}: {} pixels", levels.len());
                let (lo, hi) = levels.iter().fold((1.0_f32, 0.0_f32), |(lo, hi), &l| (lo.min(l), hi.max(l)));
                assert!(hi - lo <= 2.0 / 255.0, "{lattice} {name} {isovalue}: from {lo} to {hi}");
                assert!((0.3..0.9).contains(&lo), "{lattice} {name} {isovalue}: a face is half open: {lo}");
            }
        }
    }
}

#[test]
fn clear_surroundings_cast_no_shade() {
    // One voxel in the middle of nothing: every shading but Phong must leave it as it is.
    let volume =
        volume_of([24, 24, 24], [1.0; 3], |p| f64::from(u8::from((p - 12.5).abs().max_element() < 0.1)));
    let view = front_view();
    let none = cast(&volume, &solid_settings(Mode::Composite, Shading::None), &view);
    assert!(none.image.color.iter().any(|c| c[3] > 0.9));
    for shading in [Shading::Shadow, Shading::Ambient, Shading::Directional { directions: 16 }] {
        let lit = cast(&volume, &solid_settings(Mode::Composite, shading), &view);
        assert!(largest_difference(&none, &lit) < 1e-6, "{shading:?}");
    }
}

#[test]
fn no_directions_are_no_shading() {
    let volume = Phantom::SheppLogan.cube(24).unwrap();
    let view = front_view();
    for mode in [Mode::Composite, Mode::Isosurface { isovalue: 0.5 }] {
        let settings = |shading| Settings {
            mode,
            shading,
            ..exact_settings(byte_window(), white_transfer(&[(0.1, 0.0), (1.0, 0.4)]))
        };
        let none = cast(&volume, &settings(Shading::None), &view);
        let zero = cast(&volume, &settings(Shading::Directional { directions: 0 }), &view);
        assert_eq!(none.image, zero.image);
        assert_eq!(none.samples, zero.samples);
    }
}

#[test]
fn shading_only_darkens_and_never_touches_opacity() {
    let volume = Phantom::SheppLogan.cube(24).unwrap();
    let view = front_view();
    let settings = |shading| Settings {
        shading,
        ..exact_settings(byte_window(), white_transfer(&[(0.1, 0.0), (1.0, 0.4)]))
    };
    let none = cast(&volume, &settings(Shading::None), &view);
    for shading in [Shading::Shadow, Shading::Ambient, Shading::Directional { directions: 4 }] {
        let lit = cast(&volume, &settings(shading), &view);
        let mut darker = 0;
        for (lit, none) in lit.image.color.iter().zip(&none.image.color) {
            assert_eq!(lit[3], none[3], "{shading:?}");
            assert!((0..3).all(|c| lit[c] <= none[c] + 1e-6), "{shading:?}: {lit:?} {none:?}");
            darker += u32::from(lit[0] < 0.9 * none[0]);
        }
        assert!(darker > 100, "{shading:?}: {darker}");
        assert_eq!(lit.image.depth_m, none.image.depth_m, "{shading:?}");
    }
}
