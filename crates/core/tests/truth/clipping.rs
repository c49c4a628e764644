//! Clip box and clip plane remove what they should and nothing else.

use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::scene::{Clip, ClipPlane, Mode, Settings};
use wheatstone_core::view::View;

fn views() -> [View; 3] {
    let size = [30, 24];
    [
        look(DVec3::new(0.4, 0.3, 0.5), DVec3::ZERO, DVec3::Y, perspective(0.7, size), size),
        look(DVec3::NEG_Z, DVec3::ZERO, DVec3::Y, orthographic(0.35, size), size),
        look(DVec3::new(-0.03, 0.04, 0.02), DVec3::X, DVec3::Y, perspective(1.6, size), size),
    ]
}

/// What is left of a homogeneous volume absorbs by the length of the ray in it, so the opacity of every pixel tells
/// exactly how much was removed.
#[test]
fn what_is_left_absorbs_by_its_length() {
    const ALPHA: f32 = 0.05;
    let volume = volume_of([24, 20, 16], [1.0, 1.25, 0.8], |_| 1.0);
    let voxel_length_m = 0.8 * METRES_PER_MM;
    let (lo, hi) = volume_box_m(&volume);
    let plane = |normal: DVec3, offset_m: f64| Some(ClipPlane { normal, offset_m });
    let (box_lo, box_hi) = (DVec3::new(0.2, 0.0, 0.45), DVec3::new(0.7, 0.65, 1.0));
    let clips = [
        Clip::default(),
        Clip { box_lo, box_hi, plane: None },
        Clip { plane: plane(DVec3::new(1.0, 0.0, 0.0), 0.03), ..Clip::default() },
        Clip { plane: plane(DVec3::new(-2.0, 1.0, 0.5), -0.02), ..Clip::default() },
        Clip { box_lo, box_hi, plane: plane(DVec3::new(0.3, -0.4, 1.0), 0.01) },
        // Beyond the volume: nothing is removed, and everything.
        Clip { plane: plane(DVec3::Y, -5.0), ..Clip::default() },
        Clip { plane: plane(DVec3::Y, 5.0), ..Clip::default() },
        Clip { box_lo: DVec3::splat(-3.0), box_hi: DVec3::splat(4.0), plane: None },
        // Empty boxes.
        Clip { box_lo: DVec3::splat(0.5), box_hi: DVec3::splat(0.5), plane: None },
        Clip { box_lo: DVec3::splat(0.8), box_hi: DVec3::splat(0.2), plane: None },
    ];
    for clip in clips {
        let settings = Settings { clip, ..exact_settings(unit_window(), constant_transfer([1.0; 3], ALPHA)) };
        let corner = |texture: DVec3| lo + (hi - lo) * texture.clamp(DVec3::ZERO, DVec3::ONE);
        let mut left = box_sides(corner(clip.box_lo), corner(clip.box_hi));
        left.extend(clip.plane.map(|p| HalfSpace { normal: p.normal, offset: p.offset_m }));
        for view in views() {
            let image = cast(&volume, &settings, &view).image;
            for (x, y) in pixels(&view) {
                let ray = world_ray(&view, x, y);
                let (near, far) = depths_within(&view, ray, &left);
                let length = (far - near) * ray.1.length() / voxel_length_m;
                let expected = 1.0 - (1.0 - f64::from(ALPHA)).powf(length);
                let found = f64::from(color_at(&image, x, y)[3]);
                assert!(
                    (found - expected).abs() <= tolerance::TRANSMITTANCE,
                    "{clip:?} ({x}, {y}): {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn what_is_not_touched_does_not_change() {
    let volume = Phantom::MarschnerLobb.cube(24).unwrap();
    let size = [40, 40];
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.3, size), size);
    let whole = exact_settings(unit_window(), white_transfer(&[(0.3, 0.0), (1.0, 0.3)]));
    let modes =
        [Mode::Composite, Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay, Mode::Isosurface { isovalue: 0.5 }];
    for mode in modes {
        let whole = Settings { mode, ..whole.clone() };
        // A plane along the rays, 2 mm to the right of the middle.
        let clip = Clip { plane: Some(ClipPlane { normal: DVec3::X, offset_m: 0.02 }), ..Clip::default() };
        let (unclipped, clipped) = (
            cast(&volume, &whole, &view).image,
            cast(&volume, &Settings { clip, ..whole.clone() }, &view).image,
        );
        for (x, y) in pixels(&view) {
            let world_x = world_ray(&view, x, y).0.x;
            let expected = if world_x > 0.02 { color_at(&unclipped, x, y) } else { [0.0; 4] };
            assert_eq!(color_at(&clipped, x, y), expected, "{mode:?} ({x}, {y})");
        }
    }
}

/// A surface that a clip plane cuts open shows the cut as its inner wall or nothing: a sphere cut in half and seen
/// from the open side is hit at its far wall.
#[test]
fn a_cut_sphere_is_open() {
    let volume = Phantom::Sphere.cube(32).unwrap();
    let size = [32, 32];
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.2, size), size);
    let settings = Settings {
        mode: Mode::Isosurface { isovalue: 0.5 },
        clip: Clip { plane: Some(ClipPlane { normal: DVec3::NEG_Z, offset_m: 0.0 }), ..Clip::default() },
        ..Settings::new(byte_window(), grey_transfer())
    };
    let depth = depth_at_m(&cast(&volume, &settings, &view).image, 16, 16);
    // From 1 m, the far wall of the ball of 12.8 mm is 0.128 m behind the middle.
    assert!((depth - 1.128).abs() < tolerance::SURFACE_DEPTH_VOXELS * METRES_PER_MM, "{depth}");
}
