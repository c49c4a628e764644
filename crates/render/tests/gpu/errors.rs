//! What a device cannot do is a clear error and does no harm; what it can do it does in any order.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::view::Rig;
use wheatstone_core::volume::{Grid, Volume, VoxelType, Voxels};
use wheatstone_render::{GpuError, GpuVolume, Sources, Target, TexelFormat};

#[test]
fn a_volume_beyond_the_largest_side_is_refused() {
    on_device(|gpu, _| {
        let allowed = gpu.capabilities().largest_3d_side;
        let side = allowed as usize + 1;
        for dims in [[side, 1, 1], [1, side, 1], [1, 1, side]] {
            let grid = Grid::centred(dims, [1.0; 3]).unwrap();
            let volume = Volume::new(grid, Voxels::U8((0..side).map(|i| i as u8).collect())).unwrap();
            let mut progressed = false;
            let error = GpuVolume::upload(gpu, &volume, &mut |_, _| progressed = true).unwrap_err();
            match &error {
                GpuError::VolumeTooLarge { dims: found, largest_side, allowed_side, .. } => {
                    assert_eq!((*found, *largest_side, *allowed_side), (dims, side, allowed));
                }
                other => panic!("{other}"),
            }
            assert!(error.to_string().contains(&side.to_string()), "{error}");
            assert!(!progressed, "nothing is uploaded");
        }
        gpu.check().unwrap();
    });
}

#[test]
fn a_volume_of_the_largest_side_is_shown() {
    on_device(|gpu, renderer| {
        let side = gpu.capabilities().largest_3d_side as usize;
        let grid = Grid::centred([1, 1, side], [1.0; 3]).unwrap();
        let voxels = (0..side).map(|i| (i * 250 / side) as u8).collect();
        let volume = Volume::new(grid, Voxels::U8(voxels)).unwrap();
        let size = [8, 40];
        let view = look(DVec3::Z, DVec3::ZERO, orthographic(1.2, size), size);
        let settings = Settings { mode: Mode::Mip, ..Settings::new(volume.full_window(), transfer(0.5)) };
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let format = TexelFormat::R16FloatOf8Bit;
        let cpu = cast_on_cpu(&volume, format, &parameters, &[view]).remove(0);
        let found = cast_on_gpu(gpu, renderer, &volume, format, &settings, &[view]).unwrap().remove(0);
        assert_eq!(cpu.samples, found.samples);
        assert!(largest_difference(&cpu, &found) < 1e-3);
    });
}

#[test]
fn impossible_picture_sizes_are_refused() {
    on_device(|gpu, _| {
        let allowed = gpu.capabilities().largest_2d_side;
        for size in [[0, 5], [5, 0], [0, 0], [allowed + 1, 1], [1, allowed + 1], [u32::MAX, u32::MAX]] {
            let error = Target::new(gpu, size).unwrap_err();
            let [width, height] = size;
            assert_eq!(error, GpuError::PictureSize { width, height, allowed });
        }
        gpu.check().unwrap();
        assert_eq!(Target::new(gpu, [1, 1]).unwrap().size(), [1, 1]);
    });
}

#[test]
fn views_of_one_call_are_those_of_several() {
    on_device(|gpu, renderer| {
        let volume = blob_volume([20, 22, 18], spacing([1.0; 3]), VoxelType::U8);
        let settings =
            Settings { shading: Shading::Phong, ..Settings::new(volume.full_window(), transfer(0.5)) };
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let prepared = renderer
            .prepare(gpu, &Sources::volume(&uploaded), CastParameters::new(&settings, &placement(&volume)))
            .unwrap();
        let mut views = Rig::Stereo { eye_distance_m: 0.1, convergence_m: 1.5 }.views(&outside());
        let size = [17, 30];
        views.push(look(DVec3::new(-1.0, 0.2, 0.3), DVec3::ZERO, orthographic(1.0, size), size));
        let together = renderer.render_to_host(gpu, &prepared, &views).unwrap();
        assert_eq!(together.len(), 3);
        for (view, expected) in views.iter().zip(&together) {
            let alone = renderer.render_to_host(gpu, &prepared, &[*view]).unwrap().remove(0);
            assert_eq!((alone.image, alone.samples), (expected.image.clone(), expected.samples));
        }
        assert!(largest_difference(&together[0], &together[1]) > 0.05, "two eyes see two pictures");
        assert!(renderer.render_to_host(gpu, &prepared, &[]).unwrap().is_empty());
    });
}

#[test]
fn volumes_and_settings_alternate_on_one_renderer() {
    on_device(|gpu, renderer| {
        let small = blob_volume([20, 22, 18], spacing([1.0; 3]), VoxelType::U8);
        let oblique = blob_volume([13, 25, 19], oblique([1.0, 0.6, 0.9]), VoxelType::F32);
        let mut shown = Vec::new();
        for volume in [&small, &oblique] {
            let uploaded = GpuVolume::upload(gpu, volume, &mut |_, _| {}).unwrap();
            for mode in [Mode::Composite, Mode::Mip] {
                let settings = Settings { mode, ..Settings::new(volume.full_window(), transfer(0.5)) };
                let parameters = CastParameters::new(&settings, &placement(volume));
                let cpu =
                    Caster::new(volume).cast_exactly(&parameters, &Aids::default(), &[outside()]).remove(0);
                shown.push((renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap(), cpu));
            }
        }
        for round in 0..2 {
            for (i, (prepared, cpu)) in shown.iter().enumerate() {
                let found = renderer.render_to_host(gpu, prepared, &[outside()]).unwrap().remove(0);
                let difference = largest_difference(cpu, &found);
                assert!(difference < 0.02, "picture {i} of round {round} differs by {difference}");
            }
        }
    });
}
