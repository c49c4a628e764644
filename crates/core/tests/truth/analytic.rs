//! Absorption, surfaces and projections against closed formulas.

use crate::scene::*;
use crate::tolerance;
use glam::{DAffine3, DVec3};
use wheatstone_core::phantom::{Phantom, SPHERE_RADIUS};
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::transfer::{OpacityPoint, TransferFunction};
use wheatstone_core::view::View;
use wheatstone_core::volume::{MOST_VOXEL_LENGTHS, Volume};

/// Views that meet a volume of about 0.25 m squarely, obliquely, and from within.
fn views() -> Vec<(&'static str, View)> {
    let size = [24, 18];
    // A height that puts no pixel's ray on the volume's edge.
    let orthographic = orthographic(0.41, size);
    let wide = perspective(1.5, size);
    let at = DVec3::ZERO;
    vec![
        ("along z", look(DVec3::Z, at, DVec3::Y, orthographic, size)),
        ("along -x", look(DVec3::NEG_X, at, DVec3::Z, orthographic, size)),
        ("oblique", look(DVec3::new(0.7, 0.5, 0.9), at, DVec3::Y, orthographic, size)),
        ("eye near", look(DVec3::new(0.2, 0.15, 0.3), at, DVec3::Y, wide, size)),
        ("eye inside", look(DVec3::new(0.02, -0.03, 0.04), DVec3::new(1.0, 0.3, -0.5), DVec3::Y, wide, size)),
    ]
}

#[test]
fn a_homogeneous_slab_transmits_by_beer_and_lambert() {
    let rgb = [0.9, 0.5, 0.1];
    let mut worst = 0.0_f64;
    for spacing_mm in [[1.0, 1.0, 1.0], [0.5, 1.0, 2.5]] {
        let volume = volume_of([24, 20, 14], spacing_mm, |_| 0.5);
        let voxel_length_m = spacing_mm.into_iter().fold(f64::INFINITY, f64::min) * METRES_PER_MM;
        let (lo, hi) = volume_box_m(&volume);
        for alpha in [0.001, 0.02, 0.2] {
            for sampling_factor in [0.5, 1.0, 2.0] {
                let settings = Settings {
                    sampling_factor,
                    ..exact_settings(unit_window(), constant_transfer(rgb, alpha))
                };
                for (name, view) in views() {
                    let image = cast(&volume, &settings, &view).image;
                    for (x, y) in pixels(&view) {
                        let ray = world_ray(&view, x, y);
                        let (near, far) = depths_within(&view, ray, &box_sides(lo, hi));
                        let length = (far - near) * ray.1.length() / voxel_length_m;
                        let expected = 1.0 - (1.0 - f64::from(alpha)).powf(length);
                        let [r, g, b, a] = color_at(&image, x, y).map(f64::from);
                        let error = (a - expected).abs();
                        worst = worst.max(error);
                        let case = format!("{name} {spacing_mm:?} α={alpha} f={sampling_factor} ({x}, {y})");
                        assert!(error <= tolerance::TRANSMITTANCE, "{case}: {a} is not {expected}");
                        for (channel, level) in [r, g, b].into_iter().zip(rgb) {
                            let expected = expected * f64::from(level);
                            assert!(
                                (channel - expected).abs() <= tolerance::TRANSMITTANCE,
                                "{case}: {channel}"
                            );
                        }
                    }
                }
            }
        }
    }
    assert!(worst > 0.0, "pictures of nothing are no test");
}

#[test]
fn voxels_a_million_times_as_long_as_wide_are_cast_in_steps_of_bounded_number() {
    for spacing_mm in [[1e-3, 1.0, 1e3], [1e-6, 1.0, 1e6], [1e-8, 1.0, 1e8]] {
        let volume = volume_of([8; 3], spacing_mm, |_| 0.5);
        let (long_mm, alpha) = (8.0 * spacing_mm[2], 5e-5);
        let settings = exact_settings(unit_window(), constant_transfer([1.0; 3], alpha));
        // The units of the world are not to matter.
        let world_from_patient = DAffine3::from_scale(DVec3::splat(1.0 / long_mm));
        let view = look(DVec3::Z * 3.0, DVec3::ZERO, DVec3::Y, orthographic(1e-12, [1, 1]), [1, 1]);
        let cast = cast_at(&volume, world_from_patient, &settings, &view);
        let samples = cast.samples;
        assert!((60_000..70_000).contains(&samples), "{spacing_mm:?}: {samples}");
        let expected = 1.0 - (1.0 - f64::from(alpha)).powf(MOST_VOXEL_LENGTHS);
        let found = f64::from(color_at(&cast.image, 0, 0)[3]);
        assert!((found - expected).abs() < 2e-3, "{spacing_mm:?}: {found} is not {expected}");
    }
}

/// Opacity along x through the middle of a volume.
fn opacity_along_x(volume: &Volume, settings: &Settings) -> f64 {
    let size = [1, 1];
    let view = look(DVec3::X * 10.0, DVec3::ZERO, DVec3::Y, orthographic(1e-3, size), size);
    f64::from(color_at(&cast(volume, settings, &view).image, 0, 0)[3])
}

/// Opacities between two entries of any table, with so many voxels that the error of one adds up.
const BETWEEN_ENTRIES: [(f64, usize); 2] = [(0.026, 40), (0.0019, 512)];

#[test]
fn opacities_between_two_entries_of_a_table_add_up_to_the_truth() {
    let ramp = TransferFunction::ramp(0.0, 1.0).unwrap();
    let two_dimensional = TransferFunction::ramp_2d(0.0, 1.0, 0.0, 0.0).unwrap();
    for (alpha, voxels) in BETWEEN_ENTRIES {
        let volume = volume_of([voxels, 4, 4], [1.0; 3], |_| alpha);
        let expected = 1.0 - (1.0 - alpha).powi(voxels as i32);
        for (name, transfer, preintegrated) in
            [("1D", &ramp, false), ("2D", &two_dimensional, false), ("pre-integrated", &ramp, true)]
        {
            for sampling_factor in [0.5, 1.0, 2.0, 7.0] {
                let plain = exact_settings(unit_window(), transfer.clone());
                let settings = Settings { sampling_factor, preintegrated, ..plain };
                let found = opacity_along_x(&volume, &settings);
                assert!(
                    (found - expected).abs() <= tolerance::TRANSMITTANCE,
                    "{name} α={alpha} × {voxels} f={sampling_factor}: {found} is not {expected}"
                );
            }
        }
    }
}

#[test]
fn gradients_between_two_entries_of_a_table_add_up_to_the_truth() {
    // A value of 0.4 on the ray that rises across it by a gradient that gives the rest of the opacity.
    const VALUE: f64 = 0.4;
    const FULL_GRADIENT: f64 = 0.9;
    for (alpha, voxels) in BETWEEN_ENTRIES {
        let slope = alpha / VALUE * FULL_GRADIENT;
        let volume = volume_of([voxels, 5, 4], [1.0; 3], |p| VALUE + slope * (p.y - 2.5));
        let expected = 1.0 - (1.0 - alpha).powi(voxels as i32);
        let gradient_opacity = [(0.0, 0.0), (FULL_GRADIENT as f32, 1.0)];
        let transfer = TransferFunction::ramp(0.0, 1.0)
            .unwrap()
            .with_gradient_opacity(gradient_opacity.map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec())
            .unwrap();
        for sampling_factor in [0.5, 1.0, 2.0, 7.0] {
            let plain = exact_settings(unit_window(), transfer.clone());
            let found = opacity_along_x(&volume, &Settings { sampling_factor, ..plain });
            assert!(
                (found - expected).abs() <= tolerance::TRANSMITTANCE,
                "α={alpha} × {voxels} f={sampling_factor}: {found} is not {expected}"
            );
        }
    }
}

#[test]
fn a_ray_takes_as_many_samples_as_its_length_asks_for() {
    let volume = volume_of([24, 20, 14], [0.5, 1.0, 2.5], |_| 0.5);
    let size = [16, 16];
    // 14 voxels of 2.5 mm are 70 lengths of 0.5 mm; all 256 rays meet the 12 mm × 20 mm face.
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.1, size), size);
    for (sampling_factor, per_ray) in [(0.5, 35), (1.0, 70), (2.0, 140)] {
        let settings =
            Settings { sampling_factor, ..exact_settings(unit_window(), constant_transfer([1.0; 3], 0.1)) };
        let found = cast(&volume, &settings, &view).samples;
        // Rounding may put the length just above a whole number.
        assert!((256 * per_ray..=256 * (per_ray + 1)).contains(&found), "f={sampling_factor}: {found}");
    }
}

/// First depth at which a ray crosses the phantom's sphere in front of the eye, and the cosine of the angle to its
/// normal; lengths in metres.
fn sphere_crossing((origin, direction): (DVec3, DVec3), radius: f64) -> Option<(f64, f64)> {
    let (a, b) = (direction.length_squared(), origin.dot(direction));
    let discriminant = b * b - a * (origin.length_squared() - radius * radius);
    let root = (discriminant >= 0.0).then(|| discriminant.sqrt())?;
    let depth = [(-b - root) / a, (-b + root) / a].into_iter().find(|&depth| depth > 0.0)?;
    Some((depth, root / (a.sqrt() * radius)))
}

#[test]
fn the_isosurface_of_a_sphere_is_where_the_sphere_is() {
    const SIDE: usize = 48;
    let volume = Phantom::Sphere.cube(SIDE).unwrap();
    let voxel_m = METRES_PER_MM;
    let radius_m = SPHERE_RADIUS * SIDE as f64 * voxel_m;
    let settings = Settings {
        mode: Mode::Isosurface { isovalue: 0.5 },
        ..Settings::new(byte_window(), grey_transfer())
    };
    let size = [96, 80];
    let at = DVec3::new(0.01, -0.02, 0.0);
    let views = [
        ("outside", look(DVec3::new(0.5, 0.3, 0.6), at, DVec3::Y, perspective(0.6, size), size)),
        ("along an axis", look(DVec3::X, DVec3::ZERO, DVec3::Z, orthographic(0.5, size), size)),
        ("inside", look(DVec3::new(0.05, 0.02, -0.07), DVec3::ONE, DVec3::Y, perspective(1.8, size), size)),
    ];
    for (name, view) in views {
        let image = cast(&volume, &settings, &view).image;
        let mut hits = 0;
        for (x, y) in pixels(&view) {
            let (origin, direction) = world_ray(&view, x, y);
            let depth = depth_at_m(&image, x, y);
            let passes_m = origin.cross(direction).length() / direction.length();
            let case = format!("{name} ({x}, {y})");
            if depth.is_finite() {
                hits += 1;
                let off_surface = ((origin + direction * depth).length() - radius_m) / voxel_m;
                assert!(off_surface.abs() <= tolerance::SURFACE_DEPTH_VOXELS, "{case}: {off_surface} off");
                // Where a ray grazes the surface a small shift of it is a large one of depth, of any renderer.
                if let Some((expected, cosine)) = sphere_crossing((origin, direction), radius_m)
                    && cosine > 0.25
                {
                    let error = (depth - expected) * direction.length() / voxel_m;
                    assert!(error.abs() <= tolerance::SURFACE_DEPTH_VOXELS, "{case}: depth {error} off");
                }
                assert_eq!(color_at(&image, x, y)[3], 1.0, "{case}");
            } else {
                let inside_by = (radius_m - passes_m) / voxel_m;
                assert!(name != "inside" && inside_by < tolerance::SURFACE_DEPTH_VOXELS, "{case}: missed");
                assert_eq!(color_at(&image, x, y), [0.0; 4], "{case}");
            }
        }
        assert!(hits > 1000, "{name}: only {hits} pixels show the sphere");
    }
}

/// The grey level of every pixel that shows the volume, with the part of the ray that lies in it: start and end in
/// voxels, and length in voxel lengths (1 mm voxels).
fn levels(volume: &Volume, mode: Mode, view: &View) -> Vec<(f64, DVec3, DVec3, f64)> {
    let settings = Settings { mode, sampling_factor: 4.0, ..Settings::new(unit_window(), grey_transfer()) };
    let image = cast(volume, &settings, view).image;
    let (lo, hi) = volume_box_m(volume);
    pixels(view)
        .filter_map(|(x, y)| {
            let ray = world_ray(view, x, y);
            let (near, far) = depths_within(view, ray, &box_sides(lo, hi));
            let at = |depth: f64| (ray.0 + ray.1 * depth - lo) / METRES_PER_MM;
            (far > near + 1e-6).then(|| {
                let [r, g, b, a] = color_at(&image, x, y);
                assert_eq!((r, g, a), (b, b, 1.0));
                (f64::from(r), at(near), at(far), at(near).distance(at(far)))
            })
        })
        .collect()
}

#[test]
fn projections_of_a_ramp_are_its_ends_its_middle_and_its_integral() {
    let dims = [24, 16, 12];
    let volume = Phantom::Ramp.volume(dims).unwrap();
    // The value is the texture coordinate, but constant within half a voxel of the ends.
    let value = |p: DVec3| (p.x / 24.0).clamp(0.5 / 24.0, 1.0 - 0.5 / 24.0);
    // Of the value along x, for the mean.
    let integral = |x: f64| {
        let (lo, hi) = (0.5, 23.5);
        let inner = x.clamp(lo, hi);
        (inner * inner - lo * lo) / 2.0 / 24.0 + (x.min(lo) - lo) * lo / 24.0 + (x.max(hi) - hi) * hi / 24.0
    };
    for (name, view) in views() {
        // A sample stands for a quarter of a voxel, so extremes are met to an eighth of its value per voxel.
        let eighth = 0.125 / 24.0;
        for (level, from, to, _) in levels(&volume, Mode::Mip, &view) {
            let expected = value(from).max(value(to));
            assert!(level <= expected + tolerance::PROJECTED_VALUE, "{name}: MIP {level} above {expected}");
            assert!(
                level >= expected - eighth - tolerance::PROJECTED_VALUE,
                "{name}: MIP {level} for {expected}"
            );
        }
        for (level, from, to, _) in levels(&volume, Mode::MinIp, &view) {
            let expected = value(from).min(value(to));
            assert!(level >= expected - tolerance::PROJECTED_VALUE, "{name}: MinIP {level} below {expected}");
            assert!(
                level <= expected + eighth + tolerance::PROJECTED_VALUE,
                "{name}: MinIP {level} for {expected}"
            );
        }
        let mean = |from: DVec3, to: DVec3| {
            if (to.x - from.x).abs() > 1e-6 {
                (integral(to.x) - integral(from.x)) / (to.x - from.x)
            } else {
                value(from)
            }
        };
        for (level, from, to, length) in levels(&volume, Mode::Mean, &view) {
            let expected = mean(from, to);
            // A step of up to a quarter voxel across the ramp's kinks is off by a 32nd of its value per voxel.
            let kink = 2.0 / 32.0 / 24.0 / (4.0 * length).max(1.0);
            assert!(
                (level - expected).abs() <= tolerance::PROJECTED_VALUE + kink,
                "{name}: mean {level}, {expected}"
            );
        }
        for (level, from, to, length) in levels(&volume, Mode::XRay, &view) {
            let expected = (mean(from, to) * length / 24.0).min(1.0);
            assert!(
                (level - expected).abs() <= tolerance::PROJECTED_VALUE + 1e-3 / 24.0,
                "{name}: X-ray {level} is not {expected}"
            );
        }
    }
}

#[test]
fn x_ray_lengths_count_in_millimetres_not_in_voxels() {
    // 10 voxels of 3 mm along x (30 mm, the longest side), 20 of 1 mm along z.
    let volume = volume_of([10, 8, 20], [3.0, 1.0, 1.0], |_| 0.6);
    let size = [8, 8];
    let settings = Settings { mode: Mode::XRay, ..Settings::new(unit_window(), grey_transfer()) };
    for (eye, up, expected) in [(DVec3::X, DVec3::Y, 0.6), (DVec3::Z, DVec3::Y, 0.6 * 20.0 / 30.0)] {
        let view = look(eye, DVec3::ZERO, up, orthographic(0.05, size), size);
        let level = f64::from(color_at(&cast(&volume, &settings, &view).image, 4, 4)[0]);
        assert!((level - expected).abs() <= tolerance::PROJECTED_VALUE, "{eye}: {level} is not {expected}");
    }
}

#[test]
fn extremes_are_deep_where_they_are() {
    let volume = Phantom::Ramp.volume([24, 16, 12]).unwrap();
    let size = [8, 8];
    // From the far end of the ramp: the maximum is the first sample, the minimum the first of the last half voxel.
    let view = look(DVec3::X, DVec3::ZERO, DVec3::Z, orthographic(0.08, size), size);
    let depth = |mode| {
        let settings = Settings { mode, ..Settings::new(unit_window(), grey_transfer()) };
        depth_at_m(&cast(&volume, &settings, &view).image, 3, 3)
    };
    let face_m = 1.0 - 0.12;
    let voxel_m = METRES_PER_MM;
    let (nearest, furthest) = (depth(Mode::Mip), depth(Mode::MinIp));
    assert!((nearest - (face_m + 0.5 * voxel_m)).abs() < 0.51 * voxel_m, "{nearest}");
    assert!((furthest - (face_m + 23.5 * voxel_m)).abs() < 0.51 * voxel_m, "{furthest}");
    assert!((depth(Mode::Mean) - face_m).abs() < 0.51 * voxel_m);
}
