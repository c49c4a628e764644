//! Whatever the volume, the settings and the camera: pictures are finite, opacities are within 0 and 1, and no ray takes
//! more samples than announced.

use crate::scene::*;
use crate::tolerance;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Clip, ClipPlane, GradientMethod, Light, Mode, Placement, Settings, Shading};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Grid, StorageKind, Volume, Voxels, Window};

fn volumes() -> impl Strategy<Value = Volume> {
    let dims = prop::array::uniform3(1_usize..7);
    let spacings = prop::array::uniform3(prop::sample::select(vec![0.1, 0.7, 1.0, 4.0]));
    (dims, spacings, 0..4).prop_flat_map(|(dims, spacing_mm, voxel_type)| {
        let values = prop::collection::vec(0.0_f32..=1.0, dims.iter().product::<usize>());
        values.prop_map(move |values| {
            let voxels = match voxel_type {
                0 => Voxels::U8(values.iter().map(|v| (v * 255.0) as u8).collect()),
                1 => Voxels::I16(values.iter().map(|v| (v * 4000.0 - 1000.0) as i16).collect()),
                2 => Voxels::F32(values.iter().map(|v| v * 1e6 - 3.0).collect()),
                _ => Voxels::F64(
                    values.iter().map(|&v| if v < 0.1 { f64::NAN } else { f64::from(v) }).chain([]).collect(),
                ),
            };
            let grid = Grid::centred(dims, spacing_mm).unwrap();
            Volume::new(grid.clone(), voxels)
                .unwrap_or_else(|_| Volume::new(grid, Voxels::U8(vec![7; values.len()])).unwrap())
        })
    })
}

fn transfers() -> impl Strategy<Value = TransferFunction> {
    let alpha = || prop_oneof![Just(0.0_f32), Just(1.0_f32), 0.0_f32..1.0];
    let opacity = || prop::collection::vec((-0.2_f32..1.2, alpha()), 1..5);
    let color = prop::collection::vec((0.0_f32..1.0, prop::array::uniform3(0.0_f32..=1.0)), 1..4);
    (color, opacity(), prop::option::of(opacity())).prop_map(|(mut color, opacity, gradient)| {
        let sorted = |mut points: Vec<(f32, f32)>| -> Vec<OpacityPoint> {
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
            points.into_iter().map(|(at, alpha)| OpacityPoint { at, alpha }).collect()
        };
        color.sort_by(|a, b| a.0.total_cmp(&b.0));
        let color = color.into_iter().map(|(at, rgb)| ColorPoint { at, rgb }).collect();
        TransferFunction::new(color, sorted(opacity))
            .unwrap()
            .with_gradient_opacity(gradient.map(sorted).unwrap_or_default())
            .unwrap()
    })
}

fn clips() -> impl Strategy<Value = Clip> {
    let corner = || prop::array::uniform3(prop_oneof![Just(0.0), Just(1.0), -0.5..1.5_f64]);
    let plane = (prop::array::uniform3(-1.0..1.0_f64), -0.05..0.05_f64);
    (corner(), corner(), prop::bool::ANY, prop::option::of(plane)).prop_map(|(lo, hi, is_whole, plane)| {
        let whole = Clip::default();
        Clip {
            box_lo: if is_whole { whole.box_lo } else { lo.into() },
            box_hi: if is_whole { whole.box_hi } else { hi.into() },
            plane: plane.map(|(normal, offset_m)| ClipPlane { normal: normal.into(), offset_m }),
        }
    })
}

fn settings() -> impl Strategy<Value = Settings> {
    let mode = prop_oneof![
        4 => Just(Mode::Composite),
        1 => Just(Mode::Mip),
        1 => Just(Mode::MinIp),
        1 => Just(Mode::Mean),
        1 => Just(Mode::XRay),
        3 => (-0.1_f32..1.1).prop_map(|isovalue| Mode::Isosurface { isovalue }),
    ];
    let shading = prop_oneof![
        Just(Shading::None),
        Just(Shading::Phong),
        Just(Shading::Shadow),
        Just(Shading::Ambient),
        (0_u32..100).prop_map(|directions| Shading::Directional { directions }),
    ];
    let light = prop_oneof![
        Just(Light::Headlight),
        Just(Light::Directional(Vec3::ZERO)),
        prop::array::uniform3(-1.0_f32..1.0).prop_map(|v| Light::Directional(v.into())),
    ];
    let gradient =
        prop::sample::select(vec![GradientMethod::CentralDifferences, GradientMethod::Tetrahedron]);
    let early = prop::option::of(0.1_f32..1.0);
    (transfers(), mode, shading, light, gradient, clips(), 0.1_f32..4.0, prop::bool::ANY, early).prop_map(
        |(
            transfer,
            mode,
            shading,
            light,
            gradient,
            clip,
            sampling_factor,
            preintegrated,
            early_termination,
        )| Settings {
            mode,
            shading,
            light,
            gradient,
            clip,
            sampling_factor,
            preintegrated,
            early_termination,
            ..Settings::new(unit_window(), transfer)
        },
    )
}

/// Eyes in, near and far from the volume, many of them looking along an axis.
fn views() -> impl Strategy<Value = View> {
    let place = || prop_oneof![Just(0.0), Just(0.02), Just(-0.5), -0.3..0.3_f64];
    let eye = prop::array::uniform3(place());
    let towards = prop_oneof![
        prop::sample::select(vec![DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z]),
        prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from),
    ];
    (eye, towards, prop::array::uniform2(1_u32..6), prop::bool::ANY).prop_map(
        |(eye, towards, size, is_parallel)| {
            let eye = DVec3::from(eye);
            let up = if towards.cross(DVec3::Y).length() < 1e-3 { DVec3::Z } else { DVec3::Y };
            let projection = if is_parallel { orthographic(0.3, size) } else { perspective(1.2, size) };
            let towards = if towards.length() < 1e-3 { DVec3::NEG_Z } else { towards };
            look(eye, eye + towards, up, projection, size)
        },
    )
}

fn check(cast: &Cast, view: &View) -> Result<(), String> {
    for (color, &depth_m) in cast.image.color.iter().zip(&cast.image.depth_m) {
        if !color.iter().all(|c| c.is_finite() && *c >= 0.0) || color[3] > 1.0 {
            return Err(format!("colour {color:?}"));
        }
        // Phong adds a highlight of at most 0.2 to a colour of at most 0.9.
        if color[..3].iter().any(|c| *c > 1.1 * color[3] + 1e-5) {
            return Err(format!("more colour than opacity: {color:?}"));
        }
        if depth_m.is_nan() || f64::from(depth_m) < view.projection.depth_range_m().0 {
            return Err(format!("depth {depth_m}"));
        }
        if depth_m.is_finite() && color[3] == 0.0 {
            return Err(format!("hit nothing at {depth_m}"));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn every_picture_is_sound(volume in volumes(), settings in settings(), view in views(), narrow in any::<bool>()) {
        let settings = Settings { window: volume.full_window(), ..settings };
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
        let caster = if narrow {
            Caster::with_storage(&volume, StorageKind::U8)
        } else {
            Caster::new(&volume)
        };
        let rays = u64::from(view.size[0]) * u64::from(view.size[1]);
        for cast in [caster.cast(&parameters, &Aids::default(), &[view]).remove(0), caster.cast_exactly(&parameters, &Aids::default(), &[view]).remove(0)] {
            if let Err(reason) = check(&cast, &view) {
                prop_assert!(false, "{}", reason);
            }
            prop_assert!(cast.samples <= rays * u64::from(parameters.most_samples_per_ray()));
        }
    }
}

#[test]
fn volumes_one_voxel_thick_absorb_by_their_thickness() {
    let size = [9, 9];
    for dims in [[1, 1, 1], [1, 7, 5], [7, 1, 5], [7, 5, 1], [64, 1, 1]] {
        let volume = volume_of(dims, [1.0; 3], |_| 0.5);
        for (axis, up) in [(DVec3::X, DVec3::Y), (DVec3::Y, DVec3::Z), (DVec3::Z, DVec3::Y)] {
            let view = look(axis, DVec3::ZERO, up, orthographic(0.1 * METRES_PER_MM, size), size);
            let thickness = axis.dot(DVec3::from(dims.map(|n| n as f64)));
            let settings = exact_settings(unit_window(), constant_transfer([1.0; 3], 0.2));
            let found = f64::from(color_at(&cast(&volume, &settings, &view).image, 4, 4)[3]);
            let expected = 1.0 - 0.8_f64.powf(thickness);
            assert!(
                (found - expected).abs() < tolerance::TRANSMITTANCE,
                "{dims:?} {axis}: {found} {expected}"
            );
        }
    }
}

#[test]
fn every_phantom_in_every_mode_is_sound_one_voxel_thick() {
    let size = [16, 16];
    let view = look(DVec3::new(0.02, 0.01, 0.03), DVec3::ZERO, DVec3::Y, perspective(1.0, size), size);
    let modes =
        [Mode::Composite, Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay, Mode::Isosurface { isovalue: 0.3 }];
    for &phantom in Phantom::ALL {
        for dims in [[1, 1, 1], [1, 9, 6], [6, 1, 9], [9, 6, 1]] {
            let volume = phantom.volume(dims).unwrap();
            for mode in modes {
                for shading in [Shading::Phong, Shading::Shadow, Shading::Ambient] {
                    let transfer = white_transfer(&[(0.1, 0.0), (1.0, 1.0)]);
                    let settings =
                        Settings { mode, shading, ..Settings::new(volume.full_window(), transfer) };
                    if let Err(reason) = check(&cast(&volume, &settings, &view), &view) {
                        panic!("{phantom} {dims:?} {mode:?} {shading:?}: {reason}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_volume_of_one_value_has_no_surface_and_no_gradient() {
    let grid = Grid::centred([4, 4, 4], [1.0; 3]).unwrap();
    let volume = Volume::new(grid, Voxels::I16(vec![-1000; 64])).unwrap();
    let size = [8, 8];
    let view = look(DVec3::Z, DVec3::ZERO, DVec3::Y, orthographic(0.1, size), size);
    let settings = Settings {
        mode: Mode::Isosurface { isovalue: 0.5 },
        shading: Shading::Phong,
        ..Settings::new(Window::new(-1000.0, 1000.0).unwrap(), grey_transfer())
    };
    let cast = cast(&volume, &settings, &view);
    assert!(cast.image.color.iter().all(|c| *c == [0.0; 4]));
    assert!(cast.image.depth_m.iter().all(|d| *d == f32::INFINITY));
}
