//! Slab-wise upload: progress counts to the end, and slabs join without a seam.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use std::time::Duration;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::scene::{Mode, Settings};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::volume::{Encoding, StoredVoxels};
use wheatstone_core::volume::{Grid, Volume, Voxels};
use wheatstone_render::{Gpu, GpuVolume, Slab, Sources, TexelFormat, VolumeUpload};

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

/// All but quads, of which a texel is no voxel.
const FORMATS: [TexelFormat; 5] = [
    TexelFormat::R8Unorm,
    TexelFormat::R16FloatOf8Bit,
    TexelFormat::R16Unorm,
    TexelFormat::R16FloatOf16Bit,
    TexelFormat::R32Float,
];

fn is_offered(gpu: &Gpu, format: TexelFormat) -> bool {
    match format {
        TexelFormat::R16Unorm => gpu.capabilities().has_16bit_norm,
        TexelFormat::R32Float => gpu.capabilities().has_f32_filtering,
        _ => true,
    }
}

/// Voxels that are all but regular.
fn noise(dims: [usize; 3]) -> Volume {
    let count = dims.iter().product::<usize>();
    let voxels = Voxels::U16((0..count).map(|i| (i * i * 97 % 65_521) as u16).collect());
    Volume::new(Grid::centred(dims, [1.0; 3]).unwrap(), voxels).unwrap()
}

/// Uploads with the same time for each step; the volume, and the steps that it took.
fn stepped(gpu: &Gpu, volume: &Volume, format: TexelFormat, time: Duration) -> (GpuVolume, usize) {
    let mut upload = VolumeUpload::begin(gpu, volume, format).unwrap();
    let mut slabs = Slab::all_of(volume, format);
    let (mut steps, mut slices) = (0, 0);
    while !upload.is_whole() {
        if upload.wants_slab() {
            upload.take(slabs.next().unwrap());
        }
        upload.step(gpu, time).unwrap();
        steps += 1;
        assert!((slices..=volume.grid().dims()[2]).contains(&upload.slices().0));
        slices = upload.slices().0;
    }
    assert!(!upload.wants_slab() && slabs.next().is_none());
    (upload.finish(), steps)
}

#[test]
fn an_upload_in_steps_is_the_upload_in_one_go() {
    on_device(|gpu, _| {
        let all = FORMATS.into_iter().chain([TexelFormat::Rgba8UnormQuads]);
        for format in all.filter(|&format| is_offered(gpu, format)) {
            // The last has slices of more bytes than a first step.
            for dims in [[1, 1, 1], [1, 5, 3], [33, 17, 1], [257, 3, 2], [7, 300, 9], [301, 299, 5]] {
                let volume = noise(dims);
                let whole = GpuVolume::upload_as(gpu, &volume, format, &mut |_, _| {}).unwrap();
                let texels = whole.read(gpu).unwrap();
                assert_eq!(texels.len(), whole.byte_size() as usize);
                for time in [Duration::ZERO, Duration::from_micros(300), Duration::MAX] {
                    let (found, _) = stepped(gpu, &volume, format, time);
                    assert!(found.read(gpu).unwrap() == texels, "{dims:?} {format:?} {time:?}");
                    assert_eq!((found.dims(), found.format()), (whole.dims(), whole.format()));
                }
            }
        }
    });
}

#[test]
fn texels_are_the_stored_voxels() {
    on_device(|gpu, _| {
        let volume = noise([301, 9, 7]);
        let count = volume.grid().voxel_count();
        let stored = |kind| Encoding::new(&volume, kind).encode(volume.voxels(), 0..count);
        for format in FORMATS.into_iter().filter(|&format| is_offered(gpu, format)) {
            let expected: Vec<u8> = match (format, stored(storage_kind(format))) {
                (TexelFormat::R8Unorm, StoredVoxels::U8(v)) => v,
                (TexelFormat::R16Unorm, StoredVoxels::U16(v)) => {
                    v.into_iter().flat_map(u16::to_ne_bytes).collect()
                }
                (TexelFormat::R32Float, StoredVoxels::F32(v)) => {
                    v.into_iter().flat_map(f32::to_ne_bytes).collect()
                }
                _ => continue,
            };
            let (found, _) = stepped(gpu, &volume, format, Duration::ZERO);
            assert!(found.read(gpu).unwrap() == expected, "{format:?}");
        }
    });
}

#[test]
fn steps_without_time_are_as_small_as_can_be() {
    on_device(|gpu, _| {
        // Rows of 1,000 bytes. Of the first two steps nobody knows what they take.
        let dims = [1000, 40, 9];
        let voxels = Voxels::U8((0..dims.iter().product()).map(|i: usize| i as u8).collect());
        let volume = Volume::new(Grid::centred(dims, [1.0; 3]).unwrap(), voxels).unwrap();
        let (_, steps) = stepped(gpu, &volume, TexelFormat::R8Unorm, Duration::ZERO);
        let (_, in_one_go) = stepped(gpu, &volume, TexelFormat::R8Unorm, Duration::MAX);
        assert!(steps > 9 * 40 - 2 * 80, "{steps} steps for {} rows", 9 * 40);
        assert!(in_one_go < 10, "{in_one_go} steps for so little");
    });
}

#[test]
fn every_format_takes_rows_of_any_length() {
    on_device(|gpu, renderer| {
        // Rows of 1, 3 and 257 voxels fill no multiple of 4 or 256 bytes.
        for dims in [[1, 5, 3], [3, 7, 2], [257, 3, 2]] {
            let count = dims.iter().product::<usize>();
            let voxels = Voxels::U8((0..count).map(|i| (i * 97 % 256) as u8).collect());
            let volume = Volume::new(Grid::centred(dims, [1.0; 3]).unwrap(), voxels).unwrap();
            for format in FORMATS.into_iter().filter(|&format| is_offered(gpu, format)) {
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
