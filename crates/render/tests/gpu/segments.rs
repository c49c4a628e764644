//! Casts that are split along their rays or into rows of the picture equal casts in one go.

use crate::device::on_device;
use crate::scene::*;
use crate::tolerance;
use glam::DVec3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::reference::Cast;
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::View;
use wheatstone_core::volume::{Grid, Volume, VoxelType, Voxels};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{GpuVolume, Leap, Renderer, Sources, TexelFormat};

/// Loop iterations per invocation that the renderer never exceeds in one dispatch: above it rays are split.
const ITERATION_LIMIT: f32 = 60_000.0;

fn volume() -> Volume {
    blob_volume([16, 14, 12], spacing([1.0; 3]), VoxelType::U16)
}

/// Along x, so that every ray that meets the volume has 16 voxels of it.
fn view() -> View {
    let size = [9, 7];
    look(DVec3::new(1.5, 0.0, 0.0), DVec3::ZERO, orthographic(0.8, size), size)
}

/// A mode or shading, and the least loop iterations that a sample can cost with it.
fn cases(volume: &Volume) -> Vec<(String, Settings, f32)> {
    // Never opaque, so that rays reach their last segment.
    let plain = Settings { early_termination: None, ..Settings::new(volume.full_window(), transfer(0.15)) };
    let mut cases: Vec<(String, Settings, f32)> = Vec::new();
    for mode in [Mode::Composite, Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay] {
        cases.push((format!("{mode:?}"), Settings { mode, ..plain.clone() }, 1.0));
    }
    cases.push(("pre-integrated".into(), Settings { preintegrated: true, ..plain.clone() }, 1.0));
    let shadings =
        [(Shading::Shadow, 25.0), (Shading::Ambient, 15.0), (Shading::Directional { directions: 64 }, 65.0)];
    for (shading, cost) in shadings {
        cases.push((format!("composite {shading:?}"), Settings { shading, ..plain.clone() }, cost));
    }
    for isovalue in [0.3, 0.8] {
        let settings =
            Settings { mode: Mode::Isosurface { isovalue }, shading: Shading::Phong, ..plain.clone() };
        cases.push((format!("iso {isovalue}"), settings, 1.0));
    }
    cases
}

#[test]
fn rays_in_segments_are_whole_rays() {
    let volume = volume();
    on_device(|gpu, renderer| {
        let mut failures = Vec::new();
        let mut worst = (0.0, String::new());
        for (name, settings, cost) in cases(&volume) {
            // At least two and a half segments over the 16 voxels of a ray.
            let sampling_factor = 2.5 * ITERATION_LIMIT / cost / 16.0;
            let settings = Settings { sampling_factor, ..settings };
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let views = [view()];
            let cpu = cast_on_cpu(&volume, TexelFormat::R16Unorm, &parameters, &views).remove(0);
            let found = cast_on_gpu(gpu, renderer, &volume, TexelFormat::R16Unorm, &settings, &views)
                .unwrap()
                .remove(0);
            let difference = largest_difference(&cpu, &found);
            if difference > worst.0 {
                worst = (difference, name.clone());
            }
            let is_composite = settings.mode == Mode::Composite;
            if difference > if is_composite { tolerance::MANY_SAMPLES } else { tolerance::PROJECTIONS } {
                failures.push(format!("{name}: largest difference {difference}"));
            }
            // A driver that stops a loop in silence takes fewer.
            if cpu.samples.abs_diff(found.samples) as f64 > 1e-4 * cpu.samples as f64 {
                failures.push(format!(
                    "{name}: {} samples on the CPU, {} on the GPU",
                    cpu.samples, found.samples
                ));
            }
            // The depth of a composite is where a slowly growing opacity passes a threshold, and extremes recur; surfaces
            // are sharp.
            let tenth_of_a_voxel_m = 0.1 * placement(&volume).voxel_length_m();
            let depths = cpu.image.depth_m.iter().zip(&found.image.depth_m);
            let is_sharp = matches!(settings.mode, Mode::Isosurface { .. });
            for (a, b) in depths.filter(|_| is_sharp) {
                if a != b && f64::from((a - b).abs()) > tenth_of_a_voxel_m {
                    failures.push(format!("{name}: depth {a} on the CPU, {b} on the GPU"));
                }
            }
        }
        eprintln!("segments: largest difference {:.5} ({})", worst.0, worst.1);
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}

/// A rod along x of oblique waves: neighbouring rays along it meet visible samples at different times.
fn long_rod() -> Volume {
    const DIMS: [usize; 3] = [2600, 6, 6];
    let value = |i: usize| {
        let [x, y, z] = [i % DIMS[0], i / DIMS[0] % DIMS[1], i / DIMS[0] / DIMS[1]].map(|i| i as f64);
        30_000.0 + 20_000.0 * (0.3 * x + 1.1 * y + 0.7 * z).sin()
    };
    let voxels = Voxels::U16((0..DIMS.into_iter().product()).map(|i| value(i) as u16).collect());
    Volume::new(Grid::new(DIMS, spacing([1.0; 3])).unwrap(), voxels).unwrap()
}

/// So faint that 2,600 voxels do not hide the last one.
fn faint(opacity: [(f32, f32); 2], gradient_opacity: &[(f32, f32)]) -> TransferFunction {
    let points =
        |points: &[(f32, f32)]| points.iter().map(|&(at, alpha)| OpacityPoint { at, alpha }).collect();
    let color = [(0.0, [0.1, 0.2, 0.9]), (1.0, [1.0, 0.8, 0.3])];
    TransferFunction::new(color.map(|(at, rgb)| ColorPoint { at, rgb }).to_vec(), points(&opacity))
        .and_then(|transfer| transfer.with_gradient_opacity(points(gradient_opacity)))
        .unwrap()
}

/// Where samples cost much to blend, more loop iterations than those over the samples may count for the drivers' limit:
/// those of gradients, and of neighbouring rays that are waited for.
#[test]
fn long_rays_with_gradients_are_whole_rays() {
    const SAMPLES_PER_RAY: u64 = 2600 * 32;
    let volume = long_rod();
    let plain = |transfer| Settings {
        sampling_factor: 32.0,
        early_termination: None,
        ..Settings::new(volume.full_window(), transfer)
    };
    let (everywhere, crests) = ([(0.0, 2e-4), (1.0, 8e-4)], [(0.6, 0.0), (1.0, 3e-3)]);
    let slopes = [(0.0, 0.2), (0.1, 1.0)];
    let mut cases = Vec::new();
    for (visible, opacity) in [("everywhere", everywhere), ("on crests", crests)] {
        let phong = Settings { shading: Shading::Phong, ..plain(faint(opacity, &[])) };
        cases.push((format!("phong {visible}"), phong));
        cases.push((format!("2d {visible}"), plain(faint(opacity, &slopes))));
    }
    on_device(|gpu, renderer| {
        // A single ray, and neighbours that share a processor.
        for size in [[1, 1], [8, 2]] {
            let view = look(DVec3::new(1.5, 0.0, 0.0), DVec3::ZERO, orthographic(5e-4, size), size);
            let rays = u64::from(size[0] * size[1]);
            for (name, settings) in &cases {
                let name = format!("{name}, {rays} rays");
                let parameters = CastParameters::new(settings, &placement(&volume));
                let cpu = cast_on_cpu(&volume, TexelFormat::R16Unorm, &parameters, &[view]).remove(0);
                let found = cast_on_gpu(gpu, renderer, &volume, TexelFormat::R16Unorm, settings, &[view])
                    .unwrap()
                    .remove(0);
                for (caster, samples) in [("CPU", cpu.samples), ("GPU", found.samples)] {
                    // Rounding may put a length just above a whole number.
                    let all = rays * SAMPLES_PER_RAY..=rays * (SAMPLES_PER_RAY + 1);
                    assert!(all.contains(&samples), "{name}: {samples} samples on the {caster}");
                }
                let alpha = cpu.image.color[0][3];
                assert!((0.2..0.95).contains(&alpha), "{name}: the whole ray must count: {alpha}");
                let difference = largest_difference(&cpu, &found);
                assert!(difference <= tolerance::MANY_SAMPLES, "{name}: largest difference {difference}");
            }
        }
    });
}

/// The first dispatch of a renderer takes 65,536 pixels, so this narrow tower is cast in at least two pieces, and in
/// other pieces once the renderer has learnt how long they take.
#[test]
fn rows_in_pieces_are_whole_pictures() {
    let volume = volume();
    let size = [8, 9001];
    let view = look(DVec3::new(0.6, 0.4, 1.2), DVec3::ZERO, off_axis(1.2, size, 0.0), size);
    on_device(|gpu, shared| {
        let settings =
            Settings { shading: Shading::Phong, ..Settings::new(volume.full_window(), transfer(0.6)) };
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let uploaded = GpuVolume::upload_as(gpu, &volume, TexelFormat::R16Unorm, &mut |_, _| {}).unwrap();
        let mut fresh = Renderer::new(gpu).unwrap();
        let cpu = cast_on_cpu(&volume, TexelFormat::R16Unorm, &parameters, &[view]).remove(0);
        let mut pictures = Vec::new();
        for renderer in [&mut fresh, shared] {
            let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters.clone()).unwrap();
            for _ in 0..3 {
                pictures.push(renderer.render_to_host(gpu, &prepared, &[view]).unwrap().remove(0));
            }
        }
        let black = |cast: &Cast| cast.image.over_background([0.0; 3]);
        let found = wheatstone_core::metrics::compare(&black(&cpu), &black(&pictures[0])).unwrap();
        assert!(found.dssim() <= tolerance::dssim(TexelFormat::R16Unorm), "{found:?}");
        for (i, picture) in pictures.iter().enumerate() {
            let difference = largest_difference(&pictures[0], picture);
            assert!(difference <= tolerance::PIECES, "picture {i} differs by {difference}");
            assert_eq!(picture.samples, pictures[0].samples, "picture {i}");
            assert_eq!(picture.image.depth_m, pictures[0].image.depth_m, "picture {i}");
        }
    });
}

/// The state of a ray is kept between dispatches, wherever in a block or a leap they part.
#[test]
fn rays_in_segments_leap_as_they_march() {
    let volume = volume();
    let block_size = BlockSize::cube(2).unwrap();
    let format = TexelFormat::R16Unorm;
    on_device(|gpu, renderer| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let uploaded = GpuVolume::upload_as(gpu, &volume, format, &mut |_, _| {}).unwrap();
        let mut builder = SkipBuilder::new(gpu, &kernels, &uploaded, block_size).unwrap();
        let mut failures = Vec::new();
        for (name, settings, cost) in cases(&volume) {
            let sampling_factor = 2.5 * ITERATION_LIMIT / cost / 16.0;
            let transfer = TransferFunction::ramp(0.55, 0.9).unwrap();
            let settings = Settings { sampling_factor, transfer, ..settings };
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let mut cast = |leap: Leap<'_>| {
                let sources = Sources { leap, ..Sources::volume(&uploaded) };
                let prepared = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
                renderer.render_to_host(gpu, &prepared, &[view()]).unwrap().remove(0)
            };
            let marched = cast(Leap::Nothing);
            let mut compare = |what: &str, leapt: Cast| {
                let difference = largest_difference(&marched, &leapt);
                let is_composite = settings.mode == Mode::Composite;
                let tolerance = if is_composite { tolerance::MANY_SAMPLES } else { tolerance::PROJECTIONS };
                if difference > tolerance || difference.is_nan() {
                    failures.push(format!("{name}, {what}: largest difference {difference}"));
                }
                // Means have samples wherever there is anything at all.
                let most = marched.samples - u64::from(!matches!(settings.mode, Mode::Mean | Mode::XRay));
                if leapt.samples > most || leapt.map_reads == 0 {
                    let [leapt, marched] = [&leapt, &marched].map(|cast| cast.samples);
                    failures.push(format!("{name}, {what}: {leapt} of {marched} samples"));
                }
            };
            if matches!(settings.mode, Mode::Mip | Mode::MinIp) {
                compare("idle blocks", cast(Leap::IdleBlocks(builder.values())));
                continue;
            }
            for structure in [Structure::Distance, Structure::Anisotropic] {
                let map = builder.map(gpu, &parameters, structure).unwrap();
                compare(&format!("{structure:?}"), cast(Leap::EmptyBlocks(&map)));
            }
        }
        assert!(failures.is_empty(), "{}", failures.join("\n"));
    });
}
