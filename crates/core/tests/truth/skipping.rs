//! Skipping changes nothing: not one bit of a picture, whatever is skipped.

use crate::properties::views;
use crate::scene::*;
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::{Cast, Caster};
use wheatstone_core::scene::{GradientMethod, Mode, Placement, Settings, Shading};
use wheatstone_core::skip::{BlockRanges, BlockSize, Occupancy, SkipMap, Structure, Visibility};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::volume::{Encoding, Grid, StorageKind, Volume, Voxels};

const STRUCTURES: [Structure; 3] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic];

/// Few things in much that is empty: boxes of random values in a constant background.
fn sparse_volumes() -> impl Strategy<Value = (Volume, StorageKind)> {
    let dims = prop::array::uniform3(1_usize..20);
    let corner = || prop::array::uniform3(0.0..1.0_f64);
    let boxes = prop::collection::vec((corner(), corner(), 0_u64..1000), 0..4);
    let spacing = prop::sample::select(vec![[1.0, 1.0, 1.0], [0.5, 1.0, 2.0]]);
    let kind = prop::sample::select(vec![StorageKind::U8, StorageKind::U16, StorageKind::F32]);
    (dims, boxes, prop::sample::select(vec![0.0_f32, 0.2, 1.0]), spacing, kind).prop_map(
        |(dims, boxes, background, spacing_mm, kind)| {
            let [nx, ny, nz] = dims;
            let voxels = (0..nx * ny * nz)
                .map(|i| {
                    let at = [i % nx, i / nx % ny, i / (nx * ny)];
                    let holder = boxes.iter().find(|(a, b, _)| {
                        (0..3).all(|axis| {
                            let p = (at[axis] as f64 + 0.5) / dims[axis] as f64;
                            (a[axis].min(b[axis])..=a[axis].max(b[axis])).contains(&p)
                        })
                    });
                    holder.map_or(background, |(.., seed)| {
                        let hash = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15 ^ seed << 17);
                        (hash >> 40) as f32 / (1 << 24) as f32
                    })
                })
                .map(|value| if kind == StorageKind::F32 { value } else { (value * 255.0).round() })
                .collect();
            (Volume::new(Grid::centred(dims, spacing_mm).unwrap(), Voxels::F32(voxels)).unwrap(), kind)
        },
    )
}

/// Ramps, plateaus between gaps, spikes one entry wide, steps, nothing at all.
fn gapped_transfers() -> impl Strategy<Value = TransferFunction> {
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

fn looks() -> impl Strategy<Value = Settings> {
    let mode = prop_oneof![
        5 => Just(Mode::Composite),
        1 => Just(Mode::Mip),
        1 => Just(Mode::MinIp),
        1 => Just(Mode::Mean),
        1 => Just(Mode::XRay),
        3 => prop_oneof![Just(0.2_f32), 0.01_f32..1.0].prop_map(|isovalue| Mode::Isosurface { isovalue }),
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

fn map(
    volume: &Volume,
    kind: StorageKind,
    parameters: &CastParameters,
    size: BlockSize,
    structure: Structure,
) -> SkipMap {
    let normalised = Encoding::new(volume, kind).normalised_from_stored(parameters.window);
    let ranges = BlockRanges::of_values(volume, kind, size);
    SkipMap::new(
        &Occupancy::new(ranges.normalised(normalised), None, &Visibility::new(parameters)),
        structure,
    )
}

fn bits(cast: &Cast) -> (Vec<[u32; 4]>, Vec<u32>) {
    let color = cast.image.color.iter().map(|c| c.map(f32::to_bits)).collect();
    (color, cast.image.depth_m.iter().map(|d| d.to_bits()).collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn skipping_changes_nothing(
        (volume, kind) in sparse_volumes(),
        settings in looks(),
        view in views(),
        sides in prop::array::uniform3(2_u32..=16),
    ) {
        let window = if kind == StorageKind::F32 { unit_window() } else { byte_window() };
        let settings = Settings { window, ..settings };
        let parameters = CastParameters::new(&settings, &Placement::new(&volume, world_from_patient()));
        let caster = Caster::with_storage(&volume, kind);
        let whole = caster.cast(&parameters, None, &[view]).remove(0);
        let whole_exactly = caster.cast_exactly(&parameters, None, &[view]).remove(0);
        for structure in STRUCTURES {
            let map = map(&volume, kind, &parameters, BlockSize::new(sides).unwrap(), structure);
            let skipped = caster.cast(&parameters, Some(&map), &[view]).remove(0);
            prop_assert_eq!(bits(&skipped), bits(&whole), "{:?}, f32 lanes", structure);
            let skipped = caster.cast_exactly(&parameters, Some(&map), &[view]).remove(0);
            prop_assert_eq!(bits(&skipped), bits(&whole_exactly), "{:?}, f64 lane", structure);
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
    let view = look(
        glam::DVec3::new(0.3, 0.5, 1.5),
        glam::DVec3::ZERO,
        glam::DVec3::Y,
        perspective(0.5, size),
        size,
    );
    let caster = Caster::with_storage(&volume, kind);
    let whole = caster.cast(&parameters, None, &[view]).remove(0);
    assert_eq!(whole.map_reads, 0);
    let block_size = BlockSize::cube(4).unwrap();
    let costs = STRUCTURES.map(|structure| {
        let map = map(&volume, kind, &parameters, block_size, structure);
        let cast = caster.cast(&parameters, Some(&map), &[view]).remove(0);
        assert!(cast.samples * 2 < whole.samples, "{structure:?}: {} of {}", cast.samples, whole.samples);
        cast.map_reads
    });
    assert!(costs[1] < costs[0], "distances leap further than single blocks: {costs:?}");
    assert!(costs[2] <= costs[1], "distances in one octant are no shorter: {costs:?}");
}
