//! Leaping over empty space changes no picture: every structure, mode, shading and kind of transfer function, blocks of
//! several sizes, eyes outside and inside, rays along the axes, steps longer and shorter than a voxel.

use crate::device::on_device;
use crate::scene::*;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::gradient_map::GradientDepth;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Light, Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Grid, Volume, VoxelType, Voxels, Window};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuGradientMap, GpuVolume, Leap, Renderer, Sources, TexelFormat};

/// Largest difference of a channel that leaping may make: one level of an 8-bit picture.
const LARGEST_DIFFERENCE: f64 = 1.0 / 255.0;

const STRUCTURES: [Structure; 3] = [Structure::Occupancy, Structure::Distance, Structure::Anisotropic];

/// Clear but for two bands of values, one of them narrow: most of the volume is empty, and values pass through both.
fn banded() -> TransferFunction {
    let opacity = [(0.2, 0.0), (0.25, 0.4), (0.3, 0.0), (0.8, 0.0), (0.802, 0.9), (0.804, 0.0)];
    TransferFunction::new(
        vec![ColorPoint { at: 0.0, rgb: [0.9, 0.4, 0.2] }, ColorPoint { at: 1.0, rgb: [0.3, 0.6, 1.0] }],
        opacity.map(|(at, alpha)| OpacityPoint { at, alpha }).to_vec(),
    )
    .unwrap()
}

fn all_settings(volume: &Volume) -> Vec<(String, Settings)> {
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::new(volume.full_window(), banded());
        settings.early_termination = None;
        change(&mut settings);
        settings
    };
    let mut all = vec![
        ("phong".into(), with(&|s| s.shading = Shading::Phong)),
        ("ambient".into(), with(&|s| s.shading = Shading::Ambient)),
        ("directional".into(), with(&|s| s.shading = Shading::Directional { directions: 4 })),
        ("2D".into(), with(&|s| s.transfer = transfer_2d())),
    ];
    all.push((
        "shadow".into(),
        with(&|s| {
            s.shading = Shading::Shadow;
            s.light = Light::Directional(glam::Vec3::new(0.3, 0.8, 0.2).normalize_or_zero());
        }),
    ));
    for factor in [0.3, 1.0, 2.5] {
        all.push((format!("plain f={factor}"), with(&|s| s.sampling_factor = factor)));
        all.push((
            format!("pre-integrated f={factor}"),
            with(&|s| {
                s.preintegrated = true;
                s.sampling_factor = factor;
            }),
        ));
        all.push((
            format!("isosurface f={factor}"),
            with(&|s| {
                s.mode = Mode::Isosurface { isovalue: 0.4 };
                s.shading = Shading::Shadow;
                s.sampling_factor = factor;
            }),
        ));
    }
    for mode in [Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay] {
        all.push((format!("{mode:?}"), with(&|s| s.mode = mode)));
    }
    all
}

fn views() -> [View; 3] {
    let size = [41, 37];
    let along_x = look(DVec3::X * 1.7, DVec3::ZERO, orthographic(1.1, size), size);
    let inside = look(DVec3::new(0.05, 0.1, 0.12), DVec3::new(-0.4, 0.1, 0.3), perspective(1.4, size), size);
    [outside(), along_x, inside]
}

fn cast(gpu: &Gpu, renderer: &mut Renderer, sources: &Sources<'_>, parameters: &CastParameters) -> Vec<Cast> {
    let prepared = renderer.prepare(gpu, sources, parameters.clone()).unwrap();
    renderer.render_to_host(gpu, &prepared, &views()).unwrap()
}

/// Compares every structure with none, and returns the samples that were left out.
fn check(volume: &Volume, format: TexelFormat, block_size: BlockSize, failures: &mut Vec<String>) -> u64 {
    let mut samples_saved = 0;
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload_as(gpu, volume, format, &mut |_, _| {}).unwrap();
        let kernels = SkipKernels::new(gpu).unwrap();
        for (name, settings) in all_settings(volume) {
            let parameters = CastParameters::new(&settings, &placement(volume));
            let map =
                GpuGradientMap::new(gpu, &uploaded, parameters.gradient, GradientDepth::Bits16).unwrap();
            let gradient_map = settings.transfer.is_2d().then_some(&map);
            let mut builder = match gradient_map {
                Some(map) => SkipBuilder::with_gradients(gpu, &kernels, &uploaded, map, block_size),
                None => SkipBuilder::new(gpu, &kernels, &uploaded, block_size),
            }
            .unwrap();
            let plain = Sources { volume: &uploaded, gradient_map, leap: Leap::Nothing };
            let expected = cast(gpu, renderer, &plain, &parameters);
            let mut compare = |what: &str, leap: Leap<'_>| {
                let found = cast(gpu, renderer, &Sources { leap, ..plain }, &parameters);
                for (view, (expected, found)) in expected.iter().zip(&found).enumerate() {
                    let difference = largest_difference(expected, found);
                    if difference > LARGEST_DIFFERENCE || difference.is_nan() {
                        failures.push(format!("{name}, {block_size:?} {what}, view {view}: {difference}"));
                    }
                    samples_saved += expected.samples.saturating_sub(found.samples);
                    assert!(found.map_reads > 0, "{name}, {what}, view {view}: no look-up of the map");
                }
            };
            if matches!(settings.mode, Mode::Mip | Mode::MinIp) {
                compare("extremes", Leap::IdleBlocks(builder.values()));
                continue;
            }
            for structure in STRUCTURES {
                let map = builder.map(gpu, &parameters, structure).unwrap();
                compare(&format!("{structure:?}"), Leap::EmptyBlocks(&map));
            }
        }
    });
    samples_saved
}

#[test]
fn leaping_changes_no_picture() {
    let volumes = [
        (blob_volume([45, 38, 41], spacing([1.0; 3]), VoxelType::U8), TexelFormat::Rgba8UnormQuads),
        (blob_volume([30, 47, 22], oblique([1.0, 0.7, 2.1]), VoxelType::I16), TexelFormat::R16Unorm),
        (blob_volume([40, 1, 33], spacing([1.0; 3]), VoxelType::F32), TexelFormat::R32Float),
    ];
    let blocks = [BlockSize::cube(4).unwrap(), BlockSize::new([2, 7, 16]).unwrap()];
    let mut failures = Vec::new();
    let mut samples_saved = 0;
    for (volume, format) in &volumes {
        for block_size in blocks {
            samples_saved += check(volume, *format, block_size, &mut failures);
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(samples_saved > 1_000_000, "only {samples_saved} samples were left out");
}

/// Floats have codes between their smallest and largest; here they are one number.
#[test]
fn a_volume_of_one_value_is_not_skipped() {
    let grid = Grid::centred([9, 8, 7], [1.0; 3]).unwrap();
    let volume = Volume::new(grid, Voxels::F32(vec![5.0; 9 * 8 * 7])).unwrap();
    let mut settings =
        Settings::new(Window::new(0.0, 10.0).unwrap(), TransferFunction::ramp(0.0, 1.0).unwrap());
    settings.early_termination = None;
    let parameters = CastParameters::new(&settings, &placement(&volume));
    on_device(|gpu, renderer| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(4).unwrap()).unwrap();
        let map = builder.map(gpu, &parameters, Structure::Distance).unwrap();
        let mut cast = |leap: Leap<'_>| {
            let sources = Sources { leap, ..Sources::volume(&uploaded) };
            let prepared = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
            renderer.render_to_host(gpu, &prepared, &[outside()]).unwrap().remove(0)
        };
        let (every_sample, leapt) = (cast(Leap::Nothing), cast(Leap::EmptyBlocks(&map)));
        assert!(every_sample.image.color.iter().any(|pixel| pixel[3] > 0.5));
        assert!(largest_difference(&every_sample, &leapt) <= LARGEST_DIFFERENCE);
    });
}
