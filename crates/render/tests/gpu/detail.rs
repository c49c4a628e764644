//! Level of detail: slabs of coarser levels, each behind the nearer ones.

use crate::device::on_device;
use crate::projectors;
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::{LevelOfDetail, Slab};
use wheatstone_core::lightfield::Resolution;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume, VoxelType};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuVolume, Leap, Renderer, Sources, Target, TexelFormat};

const SIZE: [u32; 2] = [61, 47];

const DETAIL: LevelOfDetail = LevelOfDetail::Pixels(1.0);

fn seen_from(distance_m: f64) -> View {
    let eye = distance_m * DVec3::new(0.5, 0.3, 0.81).normalize_or_zero();
    look(eye, DVec3::ZERO, perspective(1.4 / distance_m, SIZE), SIZE)
}

/// On the CPU, every sample of every slab.
fn on_cpu(
    levels: &[Volume],
    kind: StorageKind,
    parameters: &CastParameters,
    slabs: &[Slab],
    view: &View,
) -> Cast {
    slabs.iter().fold(Cast::nothing(view.size), |front, slab| {
        let caster = Caster::with_storage(&levels[slab.level], kind);
        let parameters = parameters.of_level(slab.level);
        caster.cast_behind(&parameters, &Aids::default(), &slab.part_of(view), front)
    })
}

/// On the GPU, leaping by each level's own map.
fn on_gpu(
    gpu: &Gpu,
    renderer: &mut Renderer,
    levels: &[Volume],
    format: TexelFormat,
    parameters: &CastParameters,
    slabs: &[Slab],
    view: &View,
) -> Cast {
    let kernels = SkipKernels::new(gpu).unwrap();
    let mut target = Target::new(gpu, view.size).unwrap();
    for (i, slab) in slabs.iter().enumerate() {
        let parameters = parameters.of_level(slab.level);
        let volume = GpuVolume::upload_as(gpu, &levels[slab.level], format, &mut |_, _| {}).unwrap();
        let block = BlockSize::cube(3).unwrap();
        let map = SkipBuilder::new(gpu, &kernels, &volume, block)
            .and_then(|mut builder| builder.map(gpu, &parameters, Structure::Anisotropic))
            .unwrap();
        let sources = Sources { leap: Leap::EmptyBlocks(&map), ..Sources::volume(&volume) };
        let mut prepared = renderer.prepare(gpu, &sources, parameters).unwrap();
        if i > 0 {
            prepared = renderer.behind(gpu, &prepared).unwrap();
        }
        let part = slab.part_of(view);
        renderer.render(gpu, &prepared, &[part], std::slice::from_mut(&mut target)).unwrap();
    }
    target.read(gpu).unwrap()
}

#[test]
fn slabs_are_those_of_the_reference() {
    let volume = blob_volume([90, 76, 60], oblique([1.0, 1.0, 1.3]), VoxelType::U8);
    let levels = [std::slice::from_ref(&volume), &volume.coarser_levels()].concat();
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::new(volume.full_window(), transfer(0.5));
        change(&mut settings);
        CastParameters::new(&settings, &placement(&volume))
    };
    let cases = [
        (TexelFormat::Rgba8UnormQuads, with(&|_| {})),
        (TexelFormat::R16FloatOf8Bit, with(&|s| s.early_termination = None)),
        (TexelFormat::R16FloatOf8Bit, with(&|s| s.shading = Shading::Phong)),
        (TexelFormat::R16FloatOf8Bit, with(&|s| s.preintegrated = true)),
    ];
    on_device(|gpu, renderer| {
        for (format, parameters) in &cases {
            for distance_m in [0.9, 1.3] {
                let view = seen_from(distance_m);
                let slabs = DETAIL.slabs(&view, parameters, levels.len());
                assert!(slabs.len() > 1, "{distance_m} m: {slabs:?}");
                let expected = on_cpu(&levels, StorageKind::U8, parameters, &slabs, &view);
                let found = on_gpu(gpu, renderer, &levels, *format, parameters, &slabs, &view);
                let difference = largest_difference(&expected, &found);
                assert!(
                    difference < 4e-3,
                    "{format:?} {:?} {distance_m} m: {difference}",
                    parameters.shading
                );
                assert!(found.samples < expected.samples, "nothing was leapt over");
                let depths = expected.image.depth_m.iter().zip(&found.image.depth_m);
                let apart = depths.filter(|(a, b)| (*a - *b).abs() > 0.02 || a.is_finite() != b.is_finite());
                assert!(apart.count() < 12, "{distance_m} m: depths");
            }
        }
    });
}

/// Of light-field displays: slabs before and behind the screen, as fine as is resolved there.
#[test]
fn slabs_that_displays_resolve_are_those_of_the_reference() {
    let volume = blob_volume([90, 76, 60], oblique([1.0, 1.0, 1.3]), VoxelType::U8);
    let levels = [std::slice::from_ref(&volume), &volume.coarser_levels()].concat();
    let settings = Settings { shading: Shading::Phong, ..Settings::new(volume.full_window(), transfer(0.5)) };
    let parameters = CastParameters::new(&settings, &placement(&volume));
    let resolution = Resolution { pixel_size_m: 0.012, beam_angle_rad: 0.08 };
    on_device(|gpu, renderer| {
        for view in projectors::views() {
            let (near_m, far_m) = view.depths_m(&parameters.visible_corners_world());
            let slabs = resolution.slabs(parameters.voxel_length_m(), &(near_m..far_m), levels.len());
            assert!(slabs.len() >= 5 && slabs[0].level > 0, "{slabs:?}");
            let format = TexelFormat::R16FloatOf8Bit;
            let expected = on_cpu(&levels, StorageKind::U8, &parameters, &slabs, &view);
            let found = on_gpu(gpu, renderer, &levels, format, &parameters, &slabs, &view);
            let difference = largest_difference(&expected, &found);
            assert!(difference < 4e-3, "{difference}");
            assert!(found.samples < expected.samples, "nothing was leapt over");
        }
    });
}
