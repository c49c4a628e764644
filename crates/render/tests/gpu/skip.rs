//! Block ranges, gradient maps and skip maps against those of the reference, number for number.

use crate::device::on_device;
use crate::scene::{placement, storage_kind};
use std::time::Duration;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::scene::{GradientMethod, Mode, Settings};
use wheatstone_core::skip::{
    BlockGrid, BlockRanges, BlockSize, Occupancy, RangeCodes, SkipMap, Structure, Visibility,
};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::volume::{Encoding, Grid, StoredVoxels, Volume, VoxelType, Voxels};
use wheatstone_render::skip::{DmBaseline, GpuBlockRanges, RangeSearch, SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuError, GpuGradientMap, GpuVolume, TexelFormat};

const STRUCTURES: [Structure; 3] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic];
const METHODS: [GradientMethod; 2] = [GradientMethod::CentralDifferences, GradientMethod::Tetrahedron];

/// Odd sizes, flat, thin, of one voxel; rows of more than 64 and of more than 256 blocks.
const SIZES: [([usize; 3], [u32; 3]); 8] = [
    ([1, 1, 1], [2, 2, 2]),
    ([5, 9, 3], [2, 2, 2]),
    ([33, 18, 21], [4, 4, 4]),
    ([40, 3, 37], [3, 16, 5]),
    ([2, 70, 33], [2, 3, 2]),
    ([141, 7, 6], [2, 4, 3]),
    ([530, 5, 4], [2, 2, 2]),
    ([7, 6, 610], [16, 2, 2]),
];

fn random(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as f64 / (1_u64 << 31) as f64
}

/// Mostly nothing, with values from 0 to 1 here and there.
fn sparse_volume(dims: [usize; 3], voxel_type: VoxelType, share: f64, seed: u64) -> Volume {
    let mut state = seed;
    let values: Vec<f64> = (0..dims.iter().product())
        .map(|_| if random(&mut state) < share { random(&mut state) } else { 0.0 })
        .collect();
    let scaled = |lo: f64, hi: f64| values.iter().map(move |v| lo + v * (hi - lo));
    let voxels = match voxel_type {
        VoxelType::U8 => Voxels::U8(scaled(0.0, 255.0).map(|v| v as u8).collect()),
        VoxelType::U16 => Voxels::U16(scaled(100.0, 60_000.0).map(|v| v as u16).collect()),
        VoxelType::I16 => Voxels::I16(scaled(-1024.0, 3071.0).map(|v| v as i16).collect()),
        VoxelType::F32 => Voxels::F32(scaled(-0.5, 12.0).map(|v| v as f32).collect()),
        other => panic!("no volume of {other}"),
    };
    Volume::new(Grid::centred(dims, [1.0, 0.8, 2.5]).unwrap(), voxels).unwrap()
}

fn upload(gpu: &Gpu, volume: &Volume, format: TexelFormat) -> GpuVolume {
    GpuVolume::upload_as(gpu, volume, format, &mut |_, _| {}).unwrap()
}

fn offered(gpu: &Gpu, formats: &[TexelFormat]) -> Vec<TexelFormat> {
    let is_offered = |format: &TexelFormat| match format {
        TexelFormat::R16Unorm => gpu.capabilities().has_16bit_norm,
        TexelFormat::R32Float => gpu.capabilities().has_f32_filtering,
        _ => true,
    };
    formats.iter().copied().filter(is_offered).collect()
}

/// Clear but for one interval of values.
fn visible_between(lo: f32, hi: f32) -> TransferFunction {
    let color = vec![ColorPoint { at: 0.0, rgb: [1.0; 3] }];
    let opacity = [(lo - 0.001, 0.0), (lo, 0.5), (hi, 0.5), (hi + 0.001, 0.0)]
        .map(|(at, alpha)| OpacityPoint { at: at.clamp(0.0, 1.0), alpha });
    TransferFunction::new(color, opacity.to_vec()).unwrap()
}

/// Settings of every kind of visibility.
fn all_settings(volume: &Volume) -> Vec<Settings> {
    let base = Settings::new(volume.full_window(), visible_between(0.6, 0.7));
    vec![
        Settings { preintegrated: true, ..base.clone() },
        Settings { mode: Mode::Isosurface { isovalue: 0.9 }, ..base.clone() },
        Settings { mode: Mode::Mip, ..base.clone() },
        Settings { mode: Mode::MinIp, ..base.clone() },
        Settings { mode: Mode::Mean, ..base.clone() },
        Settings { transfer: visible_between(0.98, 1.0), ..base.clone() },
        base,
    ]
}

fn parameters(volume: &Volume, settings: &Settings) -> CastParameters {
    CastParameters::new(settings, &placement(volume))
}

fn reference_occupancy(
    volume: &Volume,
    format: TexelFormat,
    block_size: BlockSize,
    parameters: &CastParameters,
) -> Occupancy {
    let kind = storage_kind(format);
    let ranges = BlockRanges::of_values(volume, kind, block_size);
    let map = Encoding::new(volume, kind).normalised_from_stored(parameters.window);
    Occupancy::new(ranges.normalised(map), None, &Visibility::new(parameters))
}

#[test]
fn ranges_of_values_are_those_of_the_reference() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let whole = offered(gpu, &[TexelFormat::R8Unorm, TexelFormat::R16FloatOf8Bit, TexelFormat::R16Unorm]);
        for (dims, sides) in SIZES {
            let block_size = BlockSize::new(sides).unwrap();
            for (voxel_type, seed) in [(VoxelType::U8, 1), (VoxelType::I16, 2), (VoxelType::U16, 3)] {
                let volume = sparse_volume(dims, voxel_type, 0.2, seed);
                for &format in &whole {
                    let uploaded = upload(gpu, &volume, format);
                    let found = GpuBlockRanges::of_values(gpu, &kernels, &uploaded, block_size).unwrap();
                    let expected = BlockRanges::of_values(&volume, storage_kind(format), block_size);
                    assert_eq!(found.grid(), expected.grid());
                    assert_eq!(found.codes(), expected.codes());
                    assert_eq!(found.byte_size() as usize, expected.byte_size());
                    assert!(
                        found.read(gpu).unwrap() == expected.intervals(),
                        "{dims:?} {sides:?} {format:?}"
                    );
                }
            }
        }
    });
}

#[test]
fn ranges_that_are_found_in_steps_are_those_of_one_go() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for (dims, sides) in SIZES {
            let block_size = BlockSize::new(sides).unwrap();
            let volume =
                upload(gpu, &sparse_volume(dims, VoxelType::U8, 0.2, 5), TexelFormat::R16FloatOf8Bit);
            let whole = GpuBlockRanges::of_values(gpu, &kernels, &volume, block_size).unwrap();
            for time in [Duration::ZERO, Duration::from_micros(500)] {
                let mut search = RangeSearch::of_values(gpu, &kernels, &volume, block_size).unwrap();
                let [_, height, depth] = whole.grid().dims();
                assert_eq!(search.rows(), (0, height * depth));
                // A step goes through eight rows at least.
                let most_steps = height.div_ceil(8) * depth;
                let mut steps = 0;
                while !search.is_whole() {
                    search.step(gpu, time).unwrap();
                    steps += 1;
                    assert!(steps <= most_steps, "a step that did nothing");
                }
                let is_small = height <= 8;
                assert!(
                    time > Duration::ZERO || is_small || steps == most_steps,
                    "{steps} of {most_steps} steps"
                );
                let found = search.finish();
                assert!(found.read(gpu).unwrap() == whole.read(gpu).unwrap(), "{dims:?} {sides:?} {time:?}");
            }
        }
    });
}

/// Floats are rounded outward to codes. The GPU may round the product of a code before it adds to it, or not.
#[test]
fn ranges_of_floats_hold_their_voxels_and_little_more() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for format in offered(gpu, &[TexelFormat::R32Float, TexelFormat::R16FloatOf16Bit]) {
            for (dims, sides) in SIZES {
                let block_size = BlockSize::new(sides).unwrap();
                let volume = sparse_volume(dims, VoxelType::F32, 0.2, 7);
                let found =
                    GpuBlockRanges::of_values(gpu, &kernels, &upload(gpu, &volume, format), block_size)
                        .unwrap();
                let expected = BlockRanges::of_values(&volume, storage_kind(format), block_size);
                // Half floats have 11 bits.
                let most = if format == TexelFormat::R32Float { 1 } else { 17 };
                for (found, expected) in found.read(gpu).unwrap().iter().zip(expected.intervals()) {
                    for end in [0, 1] {
                        let difference = found[end].abs_diff(expected[end]);
                        assert!(difference <= most, "{dims:?} {sides:?} {format:?}: {found:?} {expected:?}");
                    }
                }
            }
        }
    });
}

#[test]
fn maps_are_those_of_the_reference() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for (i, (dims, sides)) in SIZES.into_iter().enumerate() {
            let block_size = BlockSize::new(sides).unwrap();
            let voxel_type = [VoxelType::U8, VoxelType::I16, VoxelType::F32][i % 3];
            let share = [0.3, 0.01, 0.003][i / 3];
            let volume = sparse_volume(dims, voxel_type, share, 11 + i as u64);
            let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
            let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
            for settings in all_settings(&volume) {
                let parameters = parameters(&volume, &settings);
                let occupancy = reference_occupancy(&volume, uploaded.format(), block_size, &parameters);
                for structure in STRUCTURES {
                    let found = builder.map(gpu, &parameters, structure).unwrap();
                    let expected = SkipMap::new(&occupancy, structure);
                    assert_eq!(found.byte_size() as usize, expected.byte_size());
                    assert!(
                        found.read(gpu).unwrap() == expected.distances(),
                        "{dims:?} {sides:?} {structure:?} {:?} occupied {}",
                        settings.mode,
                        occupancy.fraction()
                    );
                }
            }
        }
    });
}

#[test]
fn nothing_and_everything_occupied() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let dims = [9, 14, 11];
        let volume = sparse_volume(dims, VoxelType::U8, 0.5, 5);
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut builder =
            SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::new([2, 3, 4]).unwrap()).unwrap();
        let nothing = TransferFunction::new(
            vec![ColorPoint { at: 0.0, rgb: [1.0; 3] }],
            vec![OpacityPoint { at: 0.0, alpha: 0.0 }],
        )
        .unwrap();
        for structure in STRUCTURES {
            let empty = if structure == Structure::Occupancy { 1 } else { 255 };
            for (transfer, number) in [(nothing.clone(), empty), (visible_between(0.0, 1.0), 0)] {
                let settings = Settings::new(volume.full_window(), transfer);
                let map = builder.map(gpu, &parameters(&volume, &settings), structure).unwrap();
                assert!(
                    map.read(gpu).unwrap().iter().all(|&found| found == number),
                    "{structure:?} {number}"
                );
            }
        }
    });
}

#[test]
fn distances_saturate() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for axis in 0..3 {
            let mut dims = [3, 4, 2];
            dims[axis] = 600;
            for occupied in [0, dims.iter().product::<usize>() - 1] {
                let mut voxels = vec![0; dims.iter().product()];
                voxels[occupied] = 255;
                let volume = Volume::new(Grid::centred(dims, [1.0; 3]).unwrap(), Voxels::U8(voxels)).unwrap();
                let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
                let block_size = BlockSize::cube(2).unwrap();
                let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
                let settings = Settings::new(volume.full_window(), visible_between(0.5, 1.0));
                let parameters = parameters(&volume, &settings);
                let occupancy = reference_occupancy(&volume, uploaded.format(), block_size, &parameters);
                for structure in STRUCTURES {
                    let found = builder.map(gpu, &parameters, structure).unwrap().read(gpu).unwrap();
                    let largest = if structure == Structure::Occupancy { 1 } else { 255 };
                    assert_eq!(found.iter().max(), Some(&largest));
                    let expected = SkipMap::new(&occupancy, structure);
                    assert!(found == expected.distances(), "{dims:?} {structure:?}");
                }
            }
        }
    });
}

#[test]
fn an_updated_map_is_a_new_one() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let volume = sparse_volume([31, 22, 40], VoxelType::U8, 0.02, 21);
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let block_size = BlockSize::cube(2).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
        let settings = all_settings(&volume);
        let maps = STRUCTURES
            .map(|structure| builder.map(gpu, &parameters(&volume, &settings[0]), structure).unwrap());
        for settings in &settings {
            let parameters = parameters(&volume, settings);
            let occupancy = reference_occupancy(&volume, uploaded.format(), block_size, &parameters);
            for map in &maps {
                builder.update(gpu, &parameters, map).unwrap();
                let expected = SkipMap::new(&occupancy, map.structure());
                assert!(map.read(gpu).unwrap() == expected.distances(), "{:?}", map.structure());
            }
        }
    });
}

#[test]
fn gradient_maps_are_those_of_the_reference() {
    on_device(|gpu, _| {
        let formats = [
            TexelFormat::R8Unorm,
            TexelFormat::R16FloatOf8Bit,
            TexelFormat::R16Unorm,
            TexelFormat::R16FloatOf16Bit,
        ];
        for (dims, _) in SIZES {
            for (voxel_type, method) in [(VoxelType::U8, METHODS[0]), (VoxelType::F32, METHODS[1])] {
                let volume = sparse_volume(dims, voxel_type, 0.5, 31);
                let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
                for format in offered(gpu, &formats) {
                    let found = GpuGradientMap::new_as(gpu, &uploaded, method, format).unwrap();
                    let depth = match format {
                        TexelFormat::R8Unorm | TexelFormat::R16FloatOf8Bit => GradientDepth::Bits8,
                        _ => GradientDepth::Bits16,
                    };
                    let kind = storage_kind(uploaded.format());
                    let expected = GradientMap::new(&volume, kind, method, depth);
                    let difference = (found.largest() - expected.largest()).abs();
                    assert!(difference <= 1e-6 * expected.largest(), "{dims:?} {format:?}");
                    // Half floats have 11 bits.
                    let most = if format == TexelFormat::R16FloatOf16Bit { 17 } else { 1 };
                    let codes: Vec<u16> = match expected.codes() {
                        StoredVoxels::U8(v) => v.iter().copied().map(u16::from).collect(),
                        StoredVoxels::U16(v) => v.clone(),
                        StoredVoxels::F32(_) => panic!("codes are whole numbers"),
                    };
                    for (found, expected) in found.read(gpu).unwrap().into_iter().zip(codes) {
                        assert!(found.abs_diff(expected) <= most, "{dims:?} {format:?}: {found} {expected}");
                    }
                }
            }
        }
    });
}

#[test]
fn maps_by_value_and_gradient_ask_for_both() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for (i, (dims, sides)) in SIZES.into_iter().enumerate() {
            let block_size = BlockSize::new(sides).unwrap();
            let voxel_type = [VoxelType::U8, VoxelType::I16][i % 2];
            let depth = [GradientDepth::Bits8, GradientDepth::Bits16][i / 2 % 2];
            let volume = sparse_volume(dims, voxel_type, 0.02, 41 + i as u64);
            let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
            let gradient_map = GpuGradientMap::new(gpu, &uploaded, METHODS[i % 2], depth).unwrap();
            let gradients = GpuBlockRanges::of_gradients(gpu, &kernels, &gradient_map, block_size).unwrap();
            let mut builder =
                SkipBuilder::with_gradients(gpu, &kernels, &uploaded, &gradient_map, block_size).unwrap();
            let transfer = TransferFunction::ramp_2d(0.2, 0.5, 0.1, 0.3).unwrap();
            let settings = Settings::new(volume.full_window(), transfer);
            let parameters = parameters(&volume, &settings);

            // The reference's own gradients may differ by a code: its decision is taken from the device's ranges.
            let visibility = Visibility::new(&parameters);
            let encoding = Encoding::new(&volume, storage_kind(uploaded.format()));
            let map = encoding.normalised_from_stored(parameters.window);
            let per_code = gradient_map.largest() / f64::from(depth.largest_code()) * map.0.abs();
            let columns = visibility.value_entries(builder.values().codes(), map);
            let rows = visibility.gradient_entries(&RangeCodes::of_gradients(depth), (per_code, 0.0));
            let spanned = |entries: &[[u16; 2]], [lo, hi]: [u16; 2]| {
                [entries[usize::from(lo)][0], entries[usize::from(hi)][1]]
            };
            let values = builder.values().read(gpu).unwrap();
            let occupied = values
                .into_iter()
                .zip(gradients.read(gpu).unwrap())
                .map(|(value, gradient)| {
                    visibility.is_any_visible(spanned(&columns, value), spanned(&rows, gradient))
                })
                .collect();
            let occupancy = Occupancy::from_flags(BlockGrid::new(dims, block_size), occupied);
            for structure in STRUCTURES {
                let found = builder.map(gpu, &parameters, structure).unwrap();
                let expected = SkipMap::new(&occupancy, structure);
                assert!(found.read(gpu).unwrap() == expected.distances(), "{dims:?} {structure:?}");
            }

            let own_map = GradientMap::new(&volume, storage_kind(uploaded.format()), METHODS[i % 2], depth);
            let own_values = BlockRanges::of_values(&volume, storage_kind(uploaded.format()), block_size);
            let own_gradients = BlockRanges::of_gradients(&own_map, block_size);
            let own_occupancy = Occupancy::new(
                own_values.normalised(map),
                Some(own_gradients.normalised(own_map.normalised_from_code(map.0))),
                &visibility,
            );
            let blocks = own_occupancy.occupied().len();
            let others =
                own_occupancy.occupied().iter().zip(occupancy.occupied()).filter(|(a, b)| a != b).count();
            assert!(
                others * 50 <= blocks,
                "{dims:?}: {others} of {blocks} blocks differ from the reference's"
            );

            // Without gradient ranges any gradient may occur.
            let mut by_value = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
            let found = by_value.map(gpu, &parameters, Structure::Distance).unwrap();
            let occupancy = reference_occupancy(&volume, uploaded.format(), block_size, &parameters);
            let expected = SkipMap::new(&occupancy, Structure::Distance);
            assert!(found.read(gpu).unwrap() == expected.distances(), "{dims:?}");
        }
    });
}

#[test]
fn the_baseline_agrees_where_voxels_decide() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        for (dims, sides) in SIZES {
            let block_size = BlockSize::new(sides).unwrap();
            let volume = sparse_volume(dims, VoxelType::U8, 0.02, 51);
            let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
            // Visible from a threshold upwards, so that an interval is visible where its largest voxel is.
            let settings = Settings::new(volume.full_window(), TransferFunction::ramp(0.5, 0.9).unwrap());
            let by_value = parameters(&volume, &settings);
            let expected = SkipBuilder::new(gpu, &kernels, &uploaded, block_size)
                .and_then(|mut builder| builder.map(gpu, &by_value, Structure::Distance))
                .unwrap();
            let found = DmBaseline::new(gpu, &kernels, &uploaded, None, block_size)
                .and_then(|baseline| baseline.map(gpu, &by_value))
                .unwrap();
            assert!(found.read(gpu).unwrap() == expected.read(gpu).unwrap(), "{dims:?} {sides:?}");

            let gradient_map = GpuGradientMap::new(gpu, &uploaded, METHODS[0], GradientDepth::Bits8).unwrap();
            let transfer = TransferFunction::ramp_2d(0.5, 0.9, 0.2, 0.3).unwrap();
            let by_both = parameters(&volume, &Settings::new(volume.full_window(), transfer));
            let at_least = SkipBuilder::with_gradients(gpu, &kernels, &uploaded, &gradient_map, block_size)
                .and_then(|mut builder| builder.map(gpu, &by_both, Structure::Distance))
                .unwrap();
            let found = DmBaseline::new(gpu, &kernels, &uploaded, Some(&gradient_map), block_size)
                .and_then(|baseline| baseline.map(gpu, &by_both))
                .unwrap();
            // What a voxel shows, its block's intervals show.
            let distances = found.read(gpu).unwrap();
            assert!(distances.iter().zip(at_least.read(gpu).unwrap()).all(|(found, least)| *found >= least));
        }
    });
}

#[test]
fn more_blocks_than_the_device_holds_are_refused() {
    on_device(|gpu, _| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let side = gpu.capabilities().largest_3d_side as usize;
        let volume = sparse_volume([1, 1, side], VoxelType::U8, 0.5, 61);
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(2).unwrap()).unwrap();
        let parameters = parameters(&volume, &all_settings(&volume)[0]);
        builder.map(gpu, &parameters, Structure::Distance).unwrap();
        // Eight octants of half the side.
        let error = builder.map(gpu, &parameters, Structure::Anisotropic).unwrap_err();
        assert!(matches!(error, GpuError::TooManyBlocks { largest_side, .. } if largest_side == 4 * side));
        gpu.check().unwrap();
    });
}
