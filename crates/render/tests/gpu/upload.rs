//! Slab-wise upload: progress counts to the end, and slabs join without a seam.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::volume::{Grid, Volume, Voxels};
use wheatstone_render::{GpuVolume, Sources, TexelFormat};

/// 300×300 voxels of 16 bits are 180,000 bytes, so that a slab of 16 MiB holds 93 slices and this volume needs two.
const DIMS: [usize; 3] = [300, 300, 110];

/// Each slice has a value of its own, far from its neighbours'.
fn slice_value(z: usize) -> u16 {
    (z * 40_503 % 65_536) as u16
}

fn slices() -> Volume {
    let slice = DIMS[0] * DIMS[1];
    let voxels = (0..DIMS[2]).flat_map(|z| std::iter::repeat_n(slice_value(z), slice)).collect();
    Volume::new(Grid::centred(DIMS, [1.0; 3]).unwrap(), Voxels::U16(voxels)).unwrap()
}

fn grey() -> TransferFunction {
    let color = [0.0, 1.0].map(|at| ColorPoint { at, rgb: [at; 3] }).to_vec();
    TransferFunction::new(color, vec![OpacityPoint { at: 0.0, alpha: 1.0 }]).unwrap()
}

#[test]
fn slabs_join_without_a_seam_and_progress_reaches_the_end() {
    on_device(|gpu, renderer| {
        let volume = slices();
        let mut steps = Vec::new();
        let uploaded = GpuVolume::upload_as(gpu, &volume, TexelFormat::R16Unorm, &mut |done, total| {
            steps.push((done, total));
        })
        .unwrap();
        assert!(steps.len() >= 2, "one slab shows no seam: {steps:?}");
        assert!(steps.iter().all(|&(_, total)| total == DIMS[2]), "{steps:?}");
        assert!(steps.windows(2).all(|pair| pair[0].0 < pair[1].0), "{steps:?}");
        assert_eq!(steps.last(), Some(&(DIMS[2], DIMS[2])));
        assert_eq!(uploaded.byte_size(), (DIMS.iter().product::<usize>() * 2) as u64);

        // From the side, one row of pixels per slice: 110 of 300 mm, which are one metre.
        let size = [3, DIMS[2] as u32];
        let view = look(DVec3::Z, DVec3::ZERO, orthographic(110.0 / 300.0, size), size);
        let window = wheatstone_core::volume::Window::new(0.0, 65_535.0).unwrap();
        let settings = Settings { mode: Mode::Mean, sampling_factor: 0.1, ..Settings::new(window, grey()) };
        let prepared = renderer
            .prepare(gpu, &Sources::volume(&uploaded), CastParameters::new(&settings, &placement(&volume)))
            .unwrap();
        let image = renderer.render_to_host(gpu, &prepared, &[view]).unwrap().remove(0).image;
        for z in 0..DIMS[2] {
            // The patient's head is up: the last slice is the first row.
            let [level, ..] = image.color[(DIMS[2] - 1 - z) * 3 + 1];
            let expected = f32::from(slice_value(z)) / 65_535.0;
            // Half an entry of the table, and a rounding error of the row's height against neighbours half the range away.
            assert!((level - expected).abs() < 2e-3, "slice {z} shows {level}, not {expected}");
        }
    });
}

#[test]
fn every_format_takes_rows_of_any_length() {
    on_device(|gpu, renderer| {
        let formats = [
            TexelFormat::R8Unorm,
            TexelFormat::R16FloatOf8Bit,
            TexelFormat::R16Unorm,
            TexelFormat::R16FloatOf16Bit,
            TexelFormat::R32Float,
        ];
        // Rows of 1, 3 and 257 voxels fill no multiple of 4 or 256 bytes.
        for dims in [[1, 5, 3], [3, 7, 2], [257, 3, 2]] {
            let count = dims.iter().product::<usize>();
            let voxels = Voxels::U8((0..count).map(|i| (i * 97 % 256) as u8).collect());
            let volume = Volume::new(Grid::centred(dims, [1.0; 3]).unwrap(), voxels).unwrap();
            for format in formats {
                let is_offered = match format {
                    TexelFormat::R16Unorm => gpu.capabilities().has_16bit_norm,
                    TexelFormat::R32Float => gpu.capabilities().has_f32_filtering,
                    _ => true,
                };
                if !is_offered {
                    continue;
                }
                let mut last = (0, 0);
                GpuVolume::upload_as(gpu, &volume, format, &mut |done, total| last = (done, total)).unwrap();
                assert_eq!(last, (dims[2], dims[2]), "{dims:?} {format:?}");
                let size = [32, 8];
                let view = look(DVec3::new(0.0, 0.3, 1.0), DVec3::ZERO, orthographic(0.3, size), size);
                let settings = Settings { mode: Mode::XRay, ..Settings::new(volume.full_window(), grey()) };
                let parameters = CastParameters::new(&settings, &placement(&volume));
                let cpu = cast_on_cpu(&volume, format, &parameters, &[view]).remove(0);
                let found =
                    cast_on_gpu(gpu, renderer, &volume, format, &settings, &[view]).unwrap().remove(0);
                // 8-bit filtering is off by up to 0.004 per sample, the table by half an entry.
                let difference = largest_difference(&cpu, &found);
                assert!(difference < 0.006, "{dims:?} {format:?}: {difference}");
            }
        }
    });
}
