//! Gradients of linear ramps, which both methods must find exactly, seen through what depends on them: the
//! two-dimensional transfer function (magnitude) and Phong shading (direction).

use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::cast::PHONG;
use wheatstone_core::scene::{Clip, GradientMethod, Light, Mode, Settings, Shading};
use wheatstone_core::transfer::OpacityPoint;
use wheatstone_core::view::{Rig, View, Viewpoint};
use wheatstone_core::volume::Volume;

const METHODS: [GradientMethod; 2] = [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron];
const DIMS: [usize; 3] = [16, 14, 18];
/// Rows of the baked two-dimensional table are this far apart in gradient magnitude.
const ROW: f64 = 1.0 / 255.0;

/// A ramp with a given gradient per millimetre, ½ in the middle.
fn ramp(spacing_mm: [f64; 3], per_mm: DVec3) -> Volume {
    let middle = DVec3::from(DIMS.map(|n| 0.5 * n as f64));
    volume_of(DIMS, spacing_mm, |p| 0.5 + per_mm.dot((p - middle) * DVec3::from(spacing_mm)))
}

/// Without the outermost two voxels, whose neighbours beyond the border repeat.
fn inner() -> Clip {
    let margin = DVec3::from(DIMS.map(|n| 2.0 / n as f64));
    Clip { box_lo: margin, box_hi: 1.0 - margin, plane: None }
}

const SPACINGS_MM: [[f64; 3]; 3] = [[1.0, 1.0, 1.0], [2.0, 1.0, 0.5], [0.7, 0.7, 2.1]];
const DIRECTIONS: [DVec3; 4] =
    [DVec3::X, DVec3::NEG_Y, DVec3::new(0.0, 0.6, 0.8), DVec3::new(0.48, -0.6, 0.64)];

#[test]
fn magnitudes_are_exact() {
    let size = [12, 12];
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.05, size), size);
    let mut most_off = 0.0_f64;
    for gradient in METHODS {
        for spacing_mm in SPACINGS_MM {
            let voxel_length_mm = spacing_mm.into_iter().fold(f64::INFINITY, f64::min);
            for direction in DIRECTIONS {
                // Row 4 of the table: per voxel length, values stay within 0 and 1 for all spacings.
                let magnitude = 4.0 * ROW;
                let volume = ramp(spacing_mm, direction * (magnitude / voxel_length_mm));
                // Visible in that row alone: half a row off and nothing is seen.
                let peak =
                    |rows: f64, alpha: f32| OpacityPoint { at: (magnitude + rows * ROW) as f32, alpha };
                let transfer = constant_transfer([1.0; 3], 0.1)
                    .with_gradient_opacity(vec![peak(-1.0, 0.0), peak(0.0, 1.0), peak(1.0, 0.0)])
                    .unwrap();
                let settings =
                    Settings { gradient, clip: inner(), ..exact_settings(unit_window(), transfer) };
                let image = cast(&volume, &settings, &view).image;
                let length = (DIMS[2] as f64 - 4.0) * spacing_mm[2] / voxel_length_mm;
                let expected = 1.0 - 0.9_f64.powf(length);
                let found = f64::from(color_at(&image, 6, 6)[3]);
                most_off = most_off.max((found - expected).abs());
                let case = format!("{gradient:?} {spacing_mm:?} {direction}");
                assert!(
                    (found - expected).abs() <= tolerance::TRANSMITTANCE,
                    "{case}: {found} is not {expected}"
                );
            }
        }
    }
    assert!(most_off < tolerance::TRANSMITTANCE);
}

/// The colour that the Phong formula gives a white sample.
fn phong(normal: DVec3, to_light: DVec3, to_eye: DVec3) -> f64 {
    let [ambient, diffuse, specular, exponent] = PHONG.map(f64::from);
    let half_way = (to_light + to_eye).normalize_or_zero();
    ambient + diffuse * normal.dot(to_light).abs() + specular * normal.dot(half_way).abs().powf(exponent)
}

#[test]
fn directions_are_exact_and_both_sides_are_lit() {
    let size = [12, 12];
    let eyes = [DVec3::Z, DVec3::NEG_Z, DVec3::new(0.6, 0.0, 0.8)];
    let lights = [
        Light::Headlight,
        Light::Directional(DVec3::new(0.0, 0.0, 3.0).as_vec3()),
        Light::Directional(DVec3::new(-0.5, 0.8, 0.6).as_vec3()),
        Light::Directional(DVec3::new(0.5, -0.8, -0.6).as_vec3()),
    ];
    for gradient in METHODS {
        for spacing_mm in SPACINGS_MM {
            for normal in DIRECTIONS {
                let volume = ramp(spacing_mm, normal * (4.0 * ROW / 2.1));
                for eye in eyes {
                    let view = look(eye, DVec3::ZERO, DVec3::Y, orthographic(0.05, size), size);
                    for light in lights {
                        let settings = Settings {
                            gradient,
                            light,
                            clip: inner(),
                            shading: Shading::Phong,
                            ..exact_settings(unit_window(), constant_transfer([1.0; 3], 0.1))
                        };
                        let image = cast(&volume, &settings, &view).image;
                        let [r, _, _, a] = color_at(&image, 6, 6).map(f64::from);
                        let to_light = match light {
                            Light::Headlight => eye,
                            Light::Directional(d) => d.as_dvec3().normalize_or_zero(),
                        };
                        let expected = phong(normal, to_light, eye);
                        let case = format!("{gradient:?} {spacing_mm:?} {normal} {eye} {light:?}");
                        assert!(a > 0.3, "{case}: too clear to tell");
                        assert!(
                            (r / a - expected).abs() <= tolerance::LIT_COLOR,
                            "{case}: {} {expected}",
                            r / a
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn where_the_value_does_not_change_light_falls_head_on() {
    let volume = volume_of([8, 8, 8], [1.0; 3], |_| 0.5);
    let size = [8, 8];
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.05, size), size);
    let settings = Settings {
        shading: Shading::Phong,
        ..exact_settings(unit_window(), constant_transfer([1.0; 3], 0.1))
    };
    let [r, _, _, a] = color_at(&cast(&volume, &settings, &view).image, 4, 4);
    assert!((f64::from(r / a) - 0.9).abs() < tolerance::LIT_COLOR, "{}", r / a);
}

/// Largest difference of a lit plane through the origin from what the formula says for a viewpoint, and from what it says
/// for the view's own eye. Volume and settings are a ramp's, of which the plane is an isosurface.
fn off_from(
    volume: &Volume,
    settings: &Settings,
    normal: DVec3,
    view: &View,
    viewpoint: Viewpoint,
) -> [f64; 2] {
    let image = cast(volume, settings, view).image;
    let to = |viewpoint, at: DVec3| match viewpoint {
        Viewpoint::At(point) => (point - at).normalize_or_zero(),
        Viewpoint::Towards(direction) => direction.normalize_or_zero(),
    };
    let own = View { shaded_from: None, ..*view }.viewpoint();
    let mut most_off = [0.0_f64; 2];
    let mut hits = 0;
    for (x, y) in pixels(view).filter(|&(x, y)| color_at(&image, x, y)[3] > 0.0) {
        let (origin, direction) = world_ray(view, x, y);
        let at = origin - direction * (normal.dot(origin) / normal.dot(direction));
        for (most_off, viewpoint) in most_off.iter_mut().zip([viewpoint, own]) {
            let to_viewer = to(viewpoint, at);
            let to_light = match settings.light {
                Light::Headlight => to_viewer,
                Light::Directional(d) => d.as_dvec3().normalize_or_zero(),
            };
            let expected = phong(normal, to_light, to_viewer);
            *most_off = most_off.max((f64::from(color_at(&image, x, y)[0]) - expected).abs());
        }
        hits += 1;
    }
    assert!(hits > 40, "{hits}");
    most_off
}

#[test]
fn eyes_of_a_rig_are_shaded_from_its_middle() {
    let size = [28, 24];
    let normal = DVec3::new(0.36, -0.48, 0.8);
    // Voxels so small that it does not matter that isosurfaces are lit half a voxel length above them.
    let volume = ramp([0.5, 0.25, 0.125], normal * (4.0 * ROW / 0.5));
    let eye = DVec3::new(0.05, 0.02, 0.3);
    let rig = Rig::Stereo { eye_distance_m: 0.05, convergence_m: 0.3 };
    let near = look(eye, DVec3::ZERO, DVec3::Y, perspective(0.1, size), size);
    let parallel = look(eye, DVec3::ZERO, DVec3::Y, orthographic(0.03, size), size);
    let from_elsewhere = |viewpoint| (View { shaded_from: Some(viewpoint), ..near }, viewpoint);
    let mut views = vec![
        (near, Viewpoint::At(eye)),
        (parallel, Viewpoint::Towards(eye)),
        from_elsewhere(Viewpoint::At(DVec3::new(-0.2, 0.2, 0.4))),
        from_elsewhere(Viewpoint::Towards(DVec3::new(-1.0, 2.0, 3.0))),
    ];
    for (middle, viewpoint) in views.clone() {
        views.extend(rig.views(&middle).into_iter().map(|view| (view, viewpoint)));
    }
    // The plane mirrors it to the eyes.
    let light = Light::Directional(DVec3::new(0.4, -0.8, 0.4).as_vec3());
    for light in [Light::Headlight, light] {
        let settings = Settings {
            light,
            clip: inner(),
            mode: Mode::Isosurface { isovalue: 0.5 },
            shading: Shading::Phong,
            surface_rgb: Some([1.0; 3]),
            ..exact_settings(unit_window(), constant_transfer([1.0; 3], 0.1))
        };
        for (view, viewpoint) in &views {
            let [off, off_from_own_eye] = off_from(&volume, &settings, normal, view, *viewpoint);
            let case = format!("{light:?} {view:?}");
            assert!(off <= tolerance::LIT_COLOR, "{case}: {off}");
            // Of a rig of parallel views, all eyes are infinitely far away in one direction.
            let is_own = *view == near || view.projection == parallel.projection;
            assert!(is_own || off_from_own_eye > 3.0 * tolerance::LIT_COLOR, "{case}: {off_from_own_eye}");
        }
    }
}
