//! The value under a pointer.

use crate::hands::at;
use glam::{DAffine3, DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{pointing_settings, value_under};
use wheatstone_core::phantom::{Phantom, SPHERE_RADIUS};
use wheatstone_core::reference::Caster;
use wheatstone_core::scene::{Clip, ClipPlane, Mode, Placement, Settings, Shading};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::volume::{Grid, Volume, Voxels, Window};

const SIDE: usize = 64;

fn world_from_patient() -> DAffine3 {
    DAffine3::from_scale(DVec3::splat(1.0 / SIDE as f64))
}

fn settings(mode: Mode) -> Settings {
    let transfer = TransferFunction::ramp(0.5, 0.5).unwrap();
    Settings { mode, sampling_factor: 8.0, ..Settings::new(Window::new(0.0, 255.0).unwrap(), transfer) }
}

fn aimed(from: DVec3) -> Pose {
    let orientation = DQuat::from_rotation_arc(DVec3::NEG_Z, -from.normalize_or_zero());
    Pose { position_m: from, orientation }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn a_pointer_meets_the_surface_of_a_sphere(direction in prop::array::uniform3(-1.0..1.0_f64), distance_m in 0.6..3.0_f64) {
        prop_assume!(DVec3::from(direction).length() > 0.1);
        let volume = Phantom::Sphere.cube(SIDE).unwrap();
        let placement = Placement::new(&volume, world_from_patient());
        let from = DVec3::from(direction).normalize_or_zero() * distance_m;
        let caster = Caster::new(&volume);
        for mode in [Mode::Composite, Mode::Isosurface { isovalue: 0.5 }] {
            let parameters = CastParameters::new(&settings(mode), &placement);
            let pointed = value_under(&aimed(from), &caster, &parameters).unwrap();
            // Within an eighth of a voxel, of which the value rises by a sixteenth of 255, and the shape's own rounding.
            prop_assert!((pointed.distance_m - (distance_m - SPHERE_RADIUS)).abs() < 0.5 / SIDE as f64, "{:?}", pointed);
            prop_assert!((pointed.point_m - aimed(from).position_m).length() - pointed.distance_m < 1e-9);
            prop_assert!((pointed.value - 127.5).abs() < 12.0, "{:?}", pointed);
        }
    }
}

#[test]
fn settings_for_pointing_meet_the_same_place() {
    let volume = Phantom::Sphere.cube(SIDE).unwrap();
    let placement = Placement::new(&volume, world_from_patient());
    let caster = Caster::new(&volume);
    let soft = TransferFunction::ramp(0.1, 1.0).unwrap();
    for mode in [Mode::Composite, Mode::Isosurface { isovalue: 0.5 }, Mode::Mip] {
        let lit = Settings {
            transfer: soft.clone(),
            shading: Shading::Directional { directions: 3 },
            ..settings(mode)
        };
        let [all, pointing] = [lit.clone(), pointing_settings(lit)].map(|settings| {
            let parameters = CastParameters::new(&settings, &placement);
            value_under(&aimed(DVec3::new(0.3, 0.8, 1.1)), &caster, &parameters).unwrap()
        });
        assert_eq!(all, pointing, "{mode:?}");
    }
}

#[test]
fn values_are_the_volumes_own_beyond_the_window_and_clipped_parts_are_passed() {
    // Values along x, far beyond the window.
    let grid = Grid::centred([SIDE, 4, 4], [1.0; 3]).unwrap();
    let voxels = (0..SIDE * 16).map(|index| (index % SIDE) as f64 * 1000.0 - 20_000.0).collect();
    let volume = Volume::new(grid, Voxels::F64(voxels)).unwrap();
    let placement = Placement::new(&volume, world_from_patient());
    let caster = Caster::new(&volume);
    let plane = Some(ClipPlane { normal: DVec3::X, offset_m: 0.25 });
    let settings = Settings {
        window: Window::new(0.0, 100.0).unwrap(),
        clip: Clip { plane, ..Clip::default() },
        ..settings(Mode::Composite)
    };
    let parameters = CastParameters::new(&settings, &placement);
    let pointed = value_under(&aimed(DVec3::new(-2.0, 0.0, 0.0)), &caster, &parameters).unwrap();
    // A quarter of a metre from the middle is voxel 48's side: half a voxel before its centre, and a sample further at most.
    let expected = 47.5 * 1000.0 - 20_000.0;
    assert!((0.0..=130.0).contains(&(pointed.value - expected)), "{pointed:?}");
    let backwards = Pose { orientation: DQuat::from_rotation_y(1.0), ..at(-2.0, 0.0, 0.0) };
    assert_eq!(value_under(&backwards, &caster, &parameters), None);
    let broken = Pose { position_m: DVec3::NAN, ..backwards };
    assert_eq!(value_under(&broken, &caster, &parameters), None);
}

#[test]
fn projections_point_at_their_extreme_or_at_nothing() {
    let volume = Phantom::Sphere.cube(16).unwrap();
    let placement = Placement::new(&volume, DAffine3::from_scale(DVec3::splat(1.0 / 16.0)));
    let caster = Caster::new(&volume);
    let pointed =
        |mode| value_under(&aimed(DVec3::Z), &caster, &CastParameters::new(&settings(mode), &placement));
    assert_eq!(pointed(Mode::Mip).map(|pointed| pointed.value), Some(255.0));
    assert_eq!(pointed(Mode::Mean), None);
    assert_eq!(pointed(Mode::XRay), None);
}

#[test]
fn values_at_voxel_centres_are_the_voxels() {
    for volume in [
        Volume::new(
            Grid::centred([3, 2, 2], [1.0; 3]).unwrap(),
            Voxels::I16((0..12).map(|i| i * 700 - 4000).collect()),
        ),
        Volume::new(
            Grid::centred([3, 2, 2], [1.0; 3]).unwrap(),
            Voxels::F32((0..12).map(|i| 0.1 * i as f32 - 0.5).collect()),
        ),
    ] {
        let volume = volume.unwrap();
        let caster = Caster::new(&volume);
        for index in 0..12_usize {
            let [x, y, z] = [index % 3, index / 3 % 2, index / 6].map(|i| i as f64 + 0.5);
            let value = caster.value_at(DVec3::new(x / 3.0, y / 2.0, z / 2.0));
            assert!((value - volume.voxels().value(index)).abs() < 1e-4, "{index} {value}");
        }
        let between = caster.value_at(DVec3::new(1.0 / 3.0, 0.25, 0.25));
        let expected = 0.5 * (volume.voxels().value(0) + volume.voxels().value(1));
        assert!((between - expected).abs() < 1e-4 * expected.abs().max(1.0));
    }
}
