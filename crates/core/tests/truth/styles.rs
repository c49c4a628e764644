//! Illustrative shading: lit spheres are looked up by the normal in eye space, and boundaries are denser by the formula.

use crate::scene::*;
use crate::tolerance;
use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::lit_sphere::{LIT_SPHERE_SIDE, LitSphere, Style};
use wheatstone_core::phantom::{Phantom, SPHERE_RADIUS};
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{BoundaryEnhancement, Mode, Placement, Settings, Shading};
use wheatstone_core::view::{Mcop, Projection, View};
use wheatstone_core::volume::Volume;

const SIZE: [u32; 2] = [48, 48];

fn sphere() -> Volume {
    Phantom::Sphere.cube(64).unwrap()
}

/// An isosurface of white in a style.
fn surface(low: Style, high: Style) -> Settings {
    Settings {
        mode: Mode::Isosurface { isovalue: 0.5 },
        shading: Shading::LitSphere { low, high },
        surface_rgb: Some([1.0; 3]),
        ..exact_settings(byte_window(), white_transfer(&[(0.0, 1.0)]))
    }
}

/// What a map tells of a normal, and whether it is a channel that the white surface shows.
fn looked_up(style: Style, x: f64, y: f64) -> [f64; 3] {
    let map = LitSphere::of(style);
    let last = (LIT_SPHERE_SIDE - 1) as f64;
    let at = |channel: usize, column: usize, row: usize| {
        f64::from(map.plane(channel)[row * LIT_SPHERE_SIDE + column])
    };
    let (u, v) = ((0.5 * x + 0.5) * last, (0.5 * y + 0.5) * last);
    let (column, row) = (u.floor().min(last - 1.0), v.floor().min(last - 1.0));
    let (s, t) = (u - column, v - row);
    let channel = |channel: usize| {
        let (column, row) = (column as usize, row as usize);
        let along = |row: usize| at(channel, column, row) * (1.0 - s) + at(channel, column + 1, row) * s;
        along(row) * (1.0 - t) + along(row + 1) * t
    };
    [0, 1, 2].map(|c| (channel(c) + channel(3)).min(1.0))
}

#[test]
fn spheres_look_as_the_lit_sphere_does_from_wherever_they_are_seen() {
    let volume = sphere();
    let radius_m = SPHERE_RADIUS * 64.0 * METRES_PER_MM;
    let ups = [(DVec3::Z, DVec3::Y), (DVec3::new(1.0, 0.6, -0.4), DVec3::Y), (DVec3::Y, DVec3::X)];
    for &style in Style::ALL {
        for (towards, up) in ups {
            let view = look(2.0 * towards, DVec3::ZERO, up, orthographic(2.2 * radius_m, SIZE), SIZE);
            let image = cast(&volume, &surface(style, style), &view).image;
            let mut looked_at = 0;
            for (x, y) in pixels(&view) {
                let across = ((f64::from(x) + 0.5) / f64::from(SIZE[0]) - 0.5) * 2.2;
                let upwards = (0.5 - (f64::from(y) + 0.5) / f64::from(SIZE[1])) * 2.2;
                // Where normals are known well: not at the outline.
                if across.hypot(upwards) > 0.8 {
                    continue;
                }
                let (found, expected) = (color_at(&image, x, y), looked_up(style, across, upwards));
                for c in 0..3 {
                    let difference = (f64::from(found[c]) - expected[c]).abs();
                    assert!(
                        difference < tolerance::STYLED_COLOR,
                        "{style:?} {towards} at {across} {upwards}: {found:?}, not {expected:?}"
                    );
                }
                looked_at += 1;
            }
            assert!(looked_at > 300);
        }
    }
}

#[test]
fn the_style_is_that_of_the_value() {
    let volume = sphere();
    let view = look(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.4, SIZE), SIZE);
    let of = |low, high| cast(&volume, &surface(low, high), &view).image;
    let (clay, metal, between) =
        (of(Style::Clay, Style::Clay), of(Style::Metal, Style::Metal), of(Style::Clay, Style::Metal));
    for (x, y) in pixels(&view) {
        let [a, b, half] = [&clay, &metal, &between].map(|image| color_at(image, x, y)[1]);
        // Highlights are cut off at white.
        if a.max(b) > 0.98 {
            continue;
        }
        // The surface is at the value ½.
        let middle = 0.5 * (a + b);
        assert!((half - middle).abs() < 0.02, "{half}, not {middle}");
    }
}

#[test]
fn glass_is_clear_where_it_faces_the_eye_and_dense_along_its_outline() {
    let volume = sphere();
    let radius_m = SPHERE_RADIUS * 64.0 * METRES_PER_MM;
    let view = look(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(2.2 * radius_m, SIZE), SIZE);
    let settings = |shading| Settings {
        shading,
        ..exact_settings(byte_window(), white_transfer(&[(0.1, 0.0), (0.5, 0.3), (0.9, 0.0)]))
    };
    let glass =
        cast(&volume, &settings(Shading::LitSphere { low: Style::Glass, high: Style::Glass }), &view).image;
    let plain = cast(&volume, &settings(Shading::None), &view).image;
    let transmitted =
        |image: &wheatstone_core::image::Image, x: u32| f64::from(1.0 - color_at(image, x, 24)[3]).ln();
    let density_ratio = |x: u32| transmitted(&glass, x) / transmitted(&plain, x);
    // Pixels of the middle row from the middle to the outline, a pixel being 2.2/48 of a radius wide.
    let ratios: Vec<f64> = [24, 30, 36, 42, 44].map(density_ratio).to_vec();
    assert!((ratios[0] - 0.1).abs() < 0.02, "{ratios:?}");
    assert!(ratios.windows(2).all(|pair| pair[0] < pair[1]), "{ratios:?}");
    assert!(ratios[4] > 0.4, "{ratios:?}");
}

#[test]
fn boundaries_are_denser_by_the_formula() {
    let alpha = 0.05_f64;
    let boundaries = BoundaryEnhancement { inside: 0.3, gain: 4.0, exponent: 2 };
    // The value rises by a fortieth per voxel along x.
    let volume = volume_of([40, 40, 20], [1.0; 3], |p| p.x / 40.0);
    let settings = Settings {
        boundaries: Some(boundaries),
        ..exact_settings(unit_window(), white_transfer(&[(0.0, alpha as f32)]))
    };
    let view = look(2.0 * DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.2, SIZE), SIZE);
    let image = cast(&volume, &settings, &view).image;
    let factor = 0.3 + 4.0 / (40.0 * 40.0);
    let expected = 1.0 - (1.0 - alpha).powf(20.0 * factor);
    for (x, y) in pixels(&view) {
        let found = f64::from(color_at(&image, x, y)[3]);
        assert!((found - expected).abs() < tolerance::TRANSMITTANCE, "{found}, not {expected}");
    }
    // Projections have no densities.
    let projected = |boundaries| {
        cast(&volume, &Settings { mode: Mode::Mip, boundaries, ..settings.clone() }, &view).image
    };
    assert_eq!(projected(Some(boundaries)), projected(None));
}

/// Narrow and wide lanes, and views of light-field displays.
#[test]
fn all_rays_are_styled_alike() {
    let volume = sphere();
    let settings = Settings {
        boundaries: Some(BoundaryEnhancement { inside: 0.2, gain: 3.0, exponent: 1 }),
        shading: Shading::LitSphere { low: Style::Clay, high: Style::Glass },
        ..exact_settings(byte_window(), white_transfer(&[(0.1, 0.0), (0.5, 0.3)]))
    };
    let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
    let caster = Caster::new(&volume);
    let mcop = Mcop {
        emitter_x_m: 0.2,
        emitter_z_m: -1.0,
        viewer_y_m: 0.1,
        viewer_z_m: 1.5,
        left_m: -0.4,
        right_m: 0.4,
        down_m: -0.4,
        up_m: 0.4,
        near_m: -1.5,
        far_m: 1.0,
    };
    let turned = DAffine3::from_mat3(DMat3::from_rotation_y(0.3));
    let views = [
        look(DVec3::new(0.9, 0.5, 1.2), DVec3::ZERO, DVec3::Y, perspective(0.6, SIZE), SIZE),
        View { view_from_world: turned, projection: Projection::Mcop(mcop), size: SIZE, shaded_from: None },
    ];
    let exact = caster.cast_exactly(&parameters, &Aids::default(), &views);
    let wide = caster.cast(&parameters, &Aids::default(), &views);
    for (a, b) in exact.iter().zip(&wide) {
        assert!(largest_difference(a, b) < tolerance::STYLED_LANES, "{}", largest_difference(a, b));
        assert!(a.image.color.iter().any(|pixel| pixel[3] > 0.3));
    }
}
