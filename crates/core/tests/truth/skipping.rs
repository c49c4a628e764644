//! Skipping changes nothing: not one bit of a picture, whatever is skipped.

use crate::scene::*;
use glam::DVec3;
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::{GradientDepth, GradientMap};
use wheatstone_core::reference::{Aids, Cast, Caster, HeldGradientMap, Leap};
use wheatstone_core::scene::{GradientMethod, Mode, Placement, Settings, Shading};
use wheatstone_core::skip::{
    BlockExtremes, BlockRanges, BlockSize, Occupancy, SkipMap, Structure, Visibility,
};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Encoding, Grid, StorageKind, Volume, Voxels};

const STRUCTURES: [Structure; 3] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic];

/// Few things in much that is empty: small boxes of random values in a constant background or one of faint noise.
pub(crate) fn sparse_volumes(
    side: impl Strategy<Value = usize>,
) -> impl Strategy<Value = (Volume, StorageKind)> {
    let dims = prop::array::uniform3(side);
    let lo = prop::array::uniform3(0.0..1.0_f64);
    let sides = prop::array::uniform3(prop_oneof![3 => 1_usize..4, 1 => 1_usize..20]);
    let boxes = prop::collection::vec((lo, sides, any::<u64>()), 0..10);
    let spacing = prop::sample::select(vec![[1.0, 1.0, 1.0], [0.5, 1.0, 2.0]]);
    let kind = prop::sample::select(vec![StorageKind::U8, StorageKind::U16, StorageKind::F32]);
    let background = prop::sample::select(vec![(0.0_f32, 0.0_f32), (0.2, 0.0), (1.0, 0.0), (0.0, 0.15)]);
    (dims, boxes, background, spacing, kind).prop_map(|(dims, boxes, background, spacing_mm, kind)| {
        let [nx, ny, nz] = dims;
        let value = |i: usize| {
            let at = [i % nx, i / nx % ny, i / (nx * ny)];
            let holds = |(lo, sides, _): &&([f64; 3], [usize; 3], u64)| {
                (0..3).all(|axis| {
                    let first = (lo[axis] * dims[axis] as f64) as usize;
                    (first..first + sides[axis]).contains(&at[axis])
                })
            };
            let noise = |seed: u64| {
                let hash = (i as u64 ^ seed).wrapping_mul(0x9e37_79b9_7f4a_7c15);
                (hash >> 40) as f32 / (1 << 24) as f32
            };
            let (level, amplitude) = background;
            boxes.iter().find(holds).map_or(level + amplitude * noise(0), |(.., seed)| noise(*seed))
        };
        let scale = if kind == StorageKind::F32 { 1.0 } else { 255.0 };
        let voxels = (0..nx * ny * nz).map(|i| value(i) * scale).collect();
        (Volume::new(Grid::centred(dims, spacing_mm).unwrap(), Voxels::F32(voxels)).unwrap(), kind)
    })
}

/// Eyes around and in the volume that look at its middle or along an axis.
fn views() -> impl Strategy<Value = View> {
    let eye = prop::array::uniform3(prop_oneof![Just(0.0), Just(0.03), -0.4..0.4_f64]);
    let axis = prop::sample::select(vec![DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z]);
    (eye, axis, 0..3, prop::bool::ANY, prop::array::uniform2(12_u32..24)).prop_map(
        |(eye, axis, aim, is_parallel, size)| {
            let eye = DVec3::from(eye);
            let towards = if aim == 0 || eye.length() < 0.05 { axis } else { -eye };
            let up = if towards.cross(DVec3::Y).length() < 1e-3 { DVec3::Z } else { DVec3::Y };
            let projection = if is_parallel { orthographic(0.15, size) } else { perspective(0.6, size) };
            look(eye, eye + towards, up, projection, size)
        },
    )
}

/// Ramps, plateaus between gaps, spikes one entry wide, steps, nothing at all.
pub(crate) fn gapped_transfers() -> impl Strategy<Value = TransferFunction> {
    let alphas = |points: &[(f32, f32)]| -> Vec<OpacityPoint> {
        points.iter().map(|&(at, alpha)| OpacityPoint { at, alpha }).collect()
    };
    let opacity = prop_oneof![
        (0.0_f32..0.9, 0.1_f32..1.0).prop_map(|(at, alpha)| vec![(at, 0.0), (1.0, alpha)]),
        Just(vec![(0.0, 0.0), (1.0, 0.8)]),
        (0.1_f32..0.9).prop_map(|at| vec![(at, 0.0), (at, 0.7), (at + 0.1, 0.7), (at + 0.1, 0.0)]),
        (0.1_f32..0.9).prop_map(|at| vec![(at, 0.0), (at + 1.2e-4, 1.0), (at + 2.4e-4, 0.0)]),
        (0.1_f32..0.4, 0.6_f32..0.9).prop_map(|(a, b)| vec![
            (a, 0.3),
            (a, 0.0),
            (b, 0.0),
            (b, 1.0),
            (b + 0.05, 0.0)
        ]),
        Just(vec![(0.0, 0.0)]),
    ];
    let gradient = prop::option::of((0.0_f32..0.2).prop_map(|at| vec![(at, 0.0), (at + 0.1, 1.0)]));
    (opacity, gradient).prop_map(move |(opacity, gradient)| {
        let color =
            vec![ColorPoint { at: 0.0, rgb: [0.9, 0.2, 0.1] }, ColorPoint { at: 1.0, rgb: [0.3, 1.0, 0.8] }];
        TransferFunction::new(color, alphas(&opacity))
            .unwrap()
            .with_gradient_opacity(gradient.map(|points| alphas(&points)).unwrap_or_default())
            .unwrap()
    })
}

fn depths() -> impl Strategy<Value = GradientDepth> {
    prop::sample::select(vec![GradientDepth::Bits8, GradientDepth::Bits16])
}

fn looks() -> impl Strategy<Value = Settings> {
    let mode = prop_oneof![
        6 => Just(Mode::Composite),
        1 => Just(Mode::Mip),
        1 => Just(Mode::MinIp),
        1 => Just(Mode::Mean),
        1 => Just(Mode::XRay),
        4 => prop_oneof![Just(0.2_f32), 0.01_f32..1.0].prop_map(|isovalue| Mode::Isosurface { isovalue }),
    ];
    let shading = prop_oneof![
        3 => Just(Shading::None),
        1 => Just(Shading::Phong),
        1 => Just(Shading::Shadow),
        1 => Just(Shading::Ambient),
        1 => Just(Shading::Directional { directions: 5 }),
    ];
    let gradient =
        prop::sample::select(vec![GradientMethod::CentralDifferences, GradientMethod::Tetrahedron]);
    let factor = prop::sample::select(vec![0.3_f32, 1.0, 2.5]);
    let early = prop::option::weighted(0.3, Just(0.95_f32));
    (gapped_transfers(), mode, shading, gradient, factor, prop::bool::ANY, early).prop_map(
        |(transfer, mode, shading, gradient, sampling_factor, preintegrated, early_termination)| Settings {
            mode,
            shading,
            gradient,
            sampling_factor,
            preintegrated,
            early_termination,
            ..Settings::new(unit_window(), transfer)
        },
    )
}

pub(crate) fn map(
    volume: &Volume,
    kind: StorageKind,
    parameters: &CastParameters,
    gradient_map: Option<&GradientMap>,
    size: BlockSize,
    structure: Structure,
) -> SkipMap {
    let normalised = Encoding::new(volume, kind).normalised_from_stored(parameters.window);
    let values = BlockRanges::of_values(volume, kind, size);
    let gradients = gradient_map
        .map(|map| (BlockRanges::of_gradients(map, size), map.normalised_from_code(normalised.0)));
    let occupancy = Occupancy::new(
        values.normalised(normalised),
        gradients.as_ref().map(|(ranges, normalised)| ranges.normalised(*normalised)),
        &Visibility::new(parameters),
    );
    SkipMap::new(&occupancy, structure)
}

pub(crate) fn bits(cast: &Cast) -> (Vec<[u32; 4]>, Vec<u32>) {
    let color = cast.image.color.iter().map(|c| c.map(f32::to_bits)).collect();
    (color, cast.image.depth_m.iter().map(|d| d.to_bits()).collect())
}

/// Looks whose samples depend on what lies a step away.
fn looks_behind() -> impl Strategy<Value = Settings> {
    let mode = prop_oneof![
        Just(Mode::Composite),
        prop_oneof![Just(0.2_f32), 0.01_f32..1.0].prop_map(|isovalue| Mode::Isosurface { isovalue }),
    ];
    let factor = prop::sample::select(vec![0.3_f32, 0.6, 1.0]);
    (gapped_transfers(), mode, factor).prop_map(|(transfer, mode, sampling_factor)| Settings {
        mode,
        sampling_factor,
        preintegrated: true,
        ..exact_settings(unit_window(), transfer)
    })
}

fn assert_skipping_changes_nothing(
    (volume, kind): &(Volume, StorageKind),
    settings: Settings,
    depth: Option<GradientDepth>,
    view: View,
    sides: [u32; 3],
) -> Result<(), TestCaseError> {
    let window = if *kind == StorageKind::F32 { unit_window() } else { byte_window() };
    let settings = Settings { window, ..settings };
    let parameters = CastParameters::new(&settings, &Placement::new(volume, world_from_patient()));
    let caster = Caster::with_storage(volume, *kind);
    let gradient_map = depth.map(|depth| GradientMap::new(volume, *kind, settings.gradient, depth));
    let held = gradient_map.as_ref().map(HeldGradientMap::new);
    let plain = Aids { gradient_map: held.as_ref(), leap: Leap::Nothing };
    let whole = bits(&caster.cast(&parameters, &plain, &[view])[0]);
    let whole_exactly = bits(&caster.cast_exactly(&parameters, &plain, &[view])[0]);
    let size = BlockSize::new(sides).unwrap();
    for structure in STRUCTURES {
        let map = map(volume, *kind, &parameters, gradient_map.as_ref(), size, structure);
        let aids = Aids { leap: Leap::EmptyBlocks(&map), ..plain };
        let skipped = bits(&caster.cast(&parameters, &aids, &[view])[0]);
        prop_assert!(skipped == whole, "{:?}, f32 lanes", structure);
        let skipped = bits(&caster.cast_exactly(&parameters, &aids, &[view])[0]);
        prop_assert!(skipped == whole_exactly, "{:?}, f64 lane", structure);
    }
    let normalised = Encoding::new(volume, *kind).normalised_from_stored(parameters.window);
    let ranges = BlockRanges::of_values(volume, *kind, size);
    let extremes = BlockExtremes::new(ranges.normalised(normalised), parameters.mode);
    prop_assert_eq!(extremes.is_some(), matches!(parameters.mode, Mode::Mip | Mode::MinIp));
    if let Some(extremes) = extremes {
        let aids = Aids { leap: Leap::IdleBlocks(&extremes), ..plain };
        prop_assert!(bits(&caster.cast(&parameters, &aids, &[view])[0]) == whole, "extremes, f32 lanes");
        let skipped = bits(&caster.cast_exactly(&parameters, &aids, &[view])[0]);
        prop_assert!(skipped == whole_exactly, "extremes, f64 lane");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn skipping_changes_nothing(
        volume in sparse_volumes(prop_oneof![1 => 1_usize..4, 3 => 5_usize..32]),
        settings in looks(),
        depth in prop::option::of(depths()),
        view in views(),
        sides in prop::array::uniform3(prop_oneof![2_u32..5, 2_u32..=16]),
    ) {
        assert_skipping_changes_nothing(&volume, settings, depth, view, sides)?;
    }

    #[test]
    fn extremes_of_blocks_change_nothing(
        volume in sparse_volumes(prop_oneof![1 => 1_usize..4, 3 => 5_usize..32]),
        settings in projections(),
        view in views(),
        sides in prop::array::uniform3(prop_oneof![2_u32..5, 2_u32..=16]),
    ) {
        assert_skipping_changes_nothing(&volume, settings, None, view, sides)?;
    }

    #[test]
    fn skipping_changes_nothing_for_samples_that_read_behind_them(
        volume in sparse_volumes(12_usize..28),
        settings in looks_behind(),
        view in views(),
        side in 2_u32..4,
    ) {
        assert_skipping_changes_nothing(&volume, settings, None, view, [side; 3])?;
    }
}

/// Projections of an extreme.
fn projections() -> impl Strategy<Value = Settings> {
    let mode = prop::sample::select(vec![Mode::Mip, Mode::MinIp]);
    let factor = prop::sample::select(vec![0.3_f32, 1.0, 2.5]);
    (gapped_transfers(), mode, factor).prop_map(|(transfer, mode, sampling_factor)| Settings {
        mode,
        sampling_factor,
        ..Settings::new(unit_window(), transfer)
    })
}

/// A slab in faint noise, wherever it is among the blocks and the samples.
#[test]
fn a_slab_is_seen_wherever_it_is() {
    let size = [4, 3];
    let kind = StorageKind::F32;
    let views = [DVec3::new(1.0, 0.02, 0.03), DVec3::new(-1.0, 0.0, 0.0)]
        .map(|eye| look(eye, DVec3::ZERO, DVec3::Y, orthographic(0.03, size), size));
    let modes =
        [(Mode::Composite, false), (Mode::Composite, true), (Mode::Isosurface { isovalue: 0.5 }, false)];
    for (first, thickness) in (8..16).flat_map(|first| (1..3).map(move |thickness| (first, thickness))) {
        let slab = f64::from(first)..f64::from(first + thickness);
        let noise = |p: DVec3| 0.15 * (91.7 * p.x + 37.1 * p.y + 53.9 * p.z).sin().abs();
        let volume = volume_of([27, 6, 5], [1.0; 3], |p| if slab.contains(&p.x) { 1.0 } else { noise(p) });
        let caster = Caster::with_storage(&volume, kind);
        for (mode, preintegrated) in modes {
            for sampling_factor in [0.3, 0.6, 1.0, 2.5] {
                let transfer = white_transfer(&[(0.2, 0.0), (0.4, 0.3)]);
                let settings = Settings {
                    mode,
                    preintegrated,
                    sampling_factor,
                    ..exact_settings(unit_window(), transfer)
                };
                let parameters =
                    CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
                let whole: Vec<_> =
                    caster.cast(&parameters, &Aids::default(), &views).iter().map(bits).collect();
                for (structure, side) in STRUCTURES.into_iter().flat_map(|s| [2, 3, 4].map(|side| (s, side)))
                {
                    let size = BlockSize::cube(side).unwrap();
                    let map = map(&volume, kind, &parameters, None, size, structure);
                    let skipped: Vec<_> = caster
                        .cast(&parameters, &Leap::EmptyBlocks(&map).into(), &views)
                        .iter()
                        .map(bits)
                        .collect();
                    assert!(
                        skipped == whole,
                        "{mode:?} {preintegrated}, factor {sampling_factor}, {structure:?} of {side}³, slab {slab:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn skipping_saves_samples_and_a_better_map_reads() {
    let size = [64, 64];
    let volume = wheatstone_core::phantom::Phantom::Beetle.volume([64; 3]).unwrap();
    let kind = StorageKind::lossless_for(&volume);
    let settings = exact_settings(volume.full_window(), TransferFunction::ramp(0.3, 1.0).unwrap());
    let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
    let view = look(DVec3::new(0.3, 0.5, 1.5), DVec3::ZERO, DVec3::Y, perspective(0.5, size), size);
    let caster = Caster::with_storage(&volume, kind);
    let whole = caster.cast(&parameters, &Aids::default(), &[view]).remove(0);
    assert_eq!(whole.map_reads, 0);
    let block_size = BlockSize::cube(4).unwrap();
    let costs = STRUCTURES.map(|structure| {
        let map = map(&volume, kind, &parameters, None, block_size, structure);
        let cast = caster.cast(&parameters, &Leap::EmptyBlocks(&map).into(), &[view]).remove(0);
        assert!(cast.samples * 2 < whole.samples, "{structure:?}: {} of {}", cast.samples, whole.samples);
        cast.map_reads
    });
    assert!(costs[1] < costs[0], "distances leap further than single blocks: {costs:?}");
    assert!(costs[2] <= costs[1], "distances in one octant are no shorter: {costs:?}");
}

#[test]
fn projections_leap_over_what_is_no_better() {
    let size = [64, 64];
    let volume = wheatstone_core::phantom::Phantom::Beetle.volume([64; 3]).unwrap();
    let kind = StorageKind::lossless_for(&volume);
    let view = look(DVec3::new(0.3, 0.5, 1.5), DVec3::ZERO, DVec3::Y, perspective(0.5, size), size);
    let caster = Caster::with_storage(&volume, kind);
    let ranges = BlockRanges::of_values(&volume, kind, BlockSize::cube(4).unwrap());
    for mode in [Mode::Mip, Mode::MinIp] {
        let transfer = TransferFunction::ramp(0.0, 1.0).unwrap();
        let settings = Settings { mode, ..exact_settings(volume.full_window(), transfer) };
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
        let normalised = Encoding::new(&volume, kind).normalised_from_stored(parameters.window);
        let extremes = BlockExtremes::new(ranges.normalised(normalised), mode).unwrap();
        let leap = Leap::IdleBlocks(&extremes).into();
        for (exactly, whole) in [
            (false, caster.cast(&parameters, &Aids::default(), &[view]).remove(0)),
            (true, caster.cast_exactly(&parameters, &Aids::default(), &[view]).remove(0)),
        ] {
            let leapt = if exactly {
                caster.cast_exactly(&parameters, &leap, &[view]).remove(0)
            } else {
                caster.cast(&parameters, &leap, &[view]).remove(0)
            };
            assert!(bits(&leapt) == bits(&whole), "{mode:?}");
            assert!(leapt.map_reads > 0 && leapt.samples * 2 < whole.samples, "{mode:?}: {}", leapt.samples);
        }
    }
}
