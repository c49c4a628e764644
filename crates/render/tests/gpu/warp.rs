//! Warps on the GPU against their twins.

use crate::device::on_device;
use crate::scene::*;
use glam::{DAffine3, DMat3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::metrics::compare;
use wheatstone_core::scene::Settings;
use wheatstone_core::view::{Frustum, PixelRect, Projection, View};
use wheatstone_core::volume::VoxelType;
use wheatstone_core::warp::{self, GridSettings, Reach, WarpError};
use wheatstone_render::warp::{Canvas, GridDepths, Picture, Shown, Warps};
use wheatstone_render::{Gpu, GpuVolume, Prepared, Renderer, Sources, Target};

/// Divisible by nothing that passes are made of.
const SIZE: [u32; 2] = [149, 131];

/// Half floats hold eleven bits.
const ROUNDING: f32 = 1.0 / 2048.0;

/// A cast picture on the device and on the host.
struct Scene {
    prepared: Prepared,
    target: Target,
    view: View,
    image: Image,
}

impl Scene {
    /// Soft balls, opaque where they are dense.
    fn cast(gpu: &Gpu, renderer: &mut Renderer, view: View) -> Self {
        let volume = blob_volume([24, 20, 22], spacing([1.0; 3]), VoxelType::U8);
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let settings = Settings::new(volume.full_window(), transfer(0.9));
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters).unwrap();
        let mut targets = [Target::new(gpu, view.size).unwrap()];
        renderer.render(gpu, &prepared, &[view], &mut targets).unwrap();
        let [target] = targets;
        let image = target.read(gpu).unwrap().image;
        Self { prepared, target, view, image }
    }

    fn shown(&self) -> Shown<'_> {
        Shown::new(&self.target, self.view, &self.prepared)
    }
}

pub(crate) fn front() -> View {
    look(DVec3::new(0.6, 0.4, 1.2), DVec3::ZERO, perspective(0.9, SIZE), SIZE)
}

/// Views of an eye moved and turned in its own axes, some of another size and window.
pub(crate) fn wanted(random: &mut fastrand::Rng, view: &View) -> View {
    let mut within = |most: f64| most * (2.0 * random.f64() - 1.0);
    let by_m = DVec3::new(within(0.06), within(0.06), within(0.1));
    let turn = DMat3::from_rotation_y(within(0.2)) * DMat3::from_rotation_z(within(0.2));
    let world_from_view = view.view_from_world.inverse() * DAffine3::from_mat3_translation(turn, by_m);
    let moved = View { view_from_world: world_from_view.inverse(), ..*view };
    if random.bool() {
        return moved;
    }
    let size = [random.u32(90..170), random.u32(70..150)];
    let frustum = Frustum::from_fov(0.7 + 0.4 * random.f64(), size).unwrap().sheared(0.05);
    View { projection: Projection::Perspective(frustum), size, ..moved }
}

/// A warp on the device, read back.
pub(crate) fn warped(
    gpu: &Gpu,
    wanted: &View,
    encode: impl FnOnce(&mut wgpu::CommandEncoder, &mut Canvas) -> Result<(), WarpError>,
) -> Result<Image, WarpError> {
    let mut picture = Picture::new(gpu, wanted.size).unwrap();
    let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encode(&mut encoder, picture.canvas())?;
    gpu.queue().submit([encoder.finish()]);
    Ok(picture.read(gpu).unwrap())
}

fn warps(gpu: &Gpu) -> Warps {
    Warps::new(gpu, Picture::FORMAT).unwrap()
}

fn quad(gpu: &Gpu, scene: &Scene, wanted: &View) -> Result<Image, WarpError> {
    quad_by(&warps(gpu), gpu, scene, wanted)
}

fn quad_by(warps: &Warps, gpu: &Gpu, scene: &Scene, wanted: &View) -> Result<Image, WarpError> {
    warped(gpu, wanted, |encoder, into| warps.quad(gpu, encoder, &scene.shown(), wanted, into))
}

fn grid(gpu: &Gpu, scene: &Scene, wanted: &View) -> Result<Image, WarpError> {
    let settings = GridSettings::default();
    warped(gpu, wanted, |encoder, into| warps(gpu).grid(gpu, encoder, &scene.shown(), wanted, settings, into))
}

/// Largest difference of a channel, and share of the pixels that are further apart than rounding allows.
pub(crate) fn differences(a: &Image, b: &Image) -> (f32, f64) {
    let of_pixels: Vec<f32> = a
        .color
        .iter()
        .zip(&b.color)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max))
        .collect();
    let others = of_pixels.iter().filter(|&&difference| difference > 2.0 * ROUNDING).count();
    (of_pixels.iter().copied().fold(0.0, f32::max), others as f64 / of_pixels.len() as f64)
}

pub(crate) fn dssim(a: &Image, b: &Image) -> f64 {
    compare(&a.over_background([0.0; 3]), &b.over_background([0.0; 3])).unwrap().dssim()
}

#[test]
fn quads_are_those_of_the_twin() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let mut random = fastrand::Rng::with_seed(3);
        for case in 0..12 {
            let wanted = wanted(&mut random, &scene.view);
            let reach = Reach::of(&scene.view, &scene.prepared.parameters().occupied_corners_world());
            let twin = warp::quad(&scene.view, &scene.image, &wanted, reach.middle()).unwrap();
            let loaded = Warps::without_filtering(gpu, Picture::FORMAT).unwrap();
            for warps in [warps(gpu), loaded] {
                let (largest, _) = differences(&quad_by(&warps, gpu, &scene, &wanted).unwrap(), &twin);
                assert!(largest < 2.0 * ROUNDING, "{case}: {largest}");
            }
        }
    });
}

#[test]
fn grids_are_those_of_the_twin() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let mut random = fastrand::Rng::with_seed(4);
        for case in 0..12 {
            let wanted = wanted(&mut random, &scene.view);
            let twin = warp::grid(&scene.view, &scene.image, &wanted, GridSettings::default()).unwrap();
            let found = grid(gpu, &scene, &wanted).unwrap();
            // Rounding moves a few rays across the edge of a pixel.
            let (largest, others) = differences(&found, &twin);
            eprintln!("grid {case}: {others:.5} of the pixels, {largest}");
            assert!(others < 0.002 && dssim(&found, &twin) < 1e-4, "{case}: {others} {largest}");
        }
    });
}

#[test]
fn depths_of_grids_are_those_of_the_twin() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let depths = GridDepths::new(gpu).unwrap();
        let mut random = fastrand::Rng::with_seed(4);
        let settings = GridSettings::default();
        for case in 0..6 {
            let near_m = 0.25;
            let mut wanted = if case == 0 { scene.view } else { wanted(&mut random, &scene.view) };
            if let Projection::Perspective(frustum) = &mut wanted.projection {
                frustum.near_m = near_m;
            }
            let twin = warp::grid(&scene.view, &scene.image, &wanted, settings).unwrap();
            let [width, height] = wanted.size;
            let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("depths"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: GridDepths::FORMAT,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            });
            let mut into = Canvas::new(texture.create_view(&wgpu::TextureViewDescriptor::default()));
            let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            depths.encode(gpu, &mut encoder, &scene.shown(), &wanted, settings, &mut into).unwrap();
            gpu.queue().submit([encoder.finish()]);
            let found: Vec<f32> = gpu.read_texture(&texture).unwrap();
            let expected: Vec<f32> =
                twin.depth_m.iter().map(|&depth_m| (near_m as f32 / depth_m).clamp(0.0, 1.0)).collect();
            let others = found.iter().zip(&expected).filter(|(a, b)| (*a - *b).abs() > 1e-4).count();
            let hits = expected.iter().filter(|&&depth| depth > 0.0).count();
            assert!(hits > 1000, "{case}: {hits}");
            // Rounding moves a few rays across the edge of a pixel.
            assert!(others < hits / 250, "{case}: {others} of {hits}");
        }
    });
}

#[test]
fn nothing_of_the_last_warp_is_left() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let warps = warps(gpu);
        let mut random = fastrand::Rng::with_seed(6);
        let mut picture = Picture::new(gpu, SIZE).unwrap();
        for case in 0..8 {
            let wanted =
                View { size: SIZE, projection: front().projection, ..wanted(&mut random, &scene.view) };
            let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let (shown, canvas) = (scene.shown(), picture.canvas());
            let alone = if case % 3 == 0 {
                warps.quad(gpu, &mut encoder, &shown, &wanted, canvas).unwrap();
                quad(gpu, &scene, &wanted).unwrap()
            } else {
                warps.grid(gpu, &mut encoder, &shown, &wanted, GridSettings::default(), canvas).unwrap();
                grid(gpu, &scene, &wanted).unwrap()
            };
            gpu.queue().submit([encoder.finish()]);
            assert!(alone.color.iter().any(|color| color[3] == 0.0), "{case}: nothing would be left");
            assert!(picture.read(gpu).unwrap().color == alone.color, "{case}");
        }
    });
}

#[test]
fn the_same_pose_returns_the_picture() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        for warp in [quad, grid] {
            let found = warp(gpu, &scene, &scene.view).unwrap();
            assert!(dssim(&found, &scene.image) < 1e-5);
        }
    });
}

#[test]
fn nothing_is_seen_behind_the_eye_or_of_an_empty_picture() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let turned = DAffine3::from_rotation_y(std::f64::consts::PI) * front().view_from_world;
        let back = View { view_from_world: turned, ..front() };
        let empty = Scene::cast(gpu, renderer, back);
        for warp in [quad, grid] {
            for found in [warp(gpu, &scene, &back), warp(gpu, &empty, &back)] {
                assert!(found.unwrap().color.iter().all(|&color| color == [0.0; 4]));
            }
        }
    });
}

#[test]
fn what_does_not_go_together_is_refused() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let parallel = View { projection: orthographic(1.0, SIZE), ..front() };
        let spoiled = View { view_from_world: DAffine3::from_translation(DVec3::NAN), ..front() };
        let other = Scene { view: View { size: [9, 7], ..front() }, ..Scene::cast(gpu, renderer, front()) };
        for warp in [quad, grid] {
            assert!(matches!(warp(gpu, &scene, &parallel), Err(WarpError::Projection(_))));
            assert!(matches!(warp(gpu, &scene, &spoiled), Err(WarpError::View(_))));
            assert!(matches!(warp(gpu, &other, &front()), Err(WarpError::Mismatch { .. })));
        }
        let into_another = warped(gpu, &View { size: [9, 7], ..front() }, |encoder, into| {
            warps(gpu).quad(gpu, encoder, &scene.shown(), &front(), into)
        });
        assert!(matches!(into_another, Err(WarpError::Mismatch { .. })));
    });
}

#[test]
fn what_cannot_be_seen_is_not_drawn_and_the_rest_is_as_ever() {
    on_device(|gpu, renderer| {
        let scene = Scene::cast(gpu, renderer, front());
        let wanted = wanted(&mut fastrand::Rng::with_seed(5), &scene.view);
        let [width, height] = wanted.size;
        let middle = width / 2..width / 2 + 9;
        let visible = [
            PixelRect { columns: 0..width / 2, rows: 0..height / 2 },
            PixelRect { columns: middle, rows: height / 2..height },
        ];
        let (warps, settings) = (warps(gpu), GridSettings::default());
        let warp = |visible: Option<&[PixelRect]>| {
            warped(gpu, &wanted, |encoder, into| {
                if let Some(visible) = visible {
                    into.show_only(visible);
                }
                warps.grid(gpu, encoder, &scene.shown(), &wanted, settings, into)
            })
            .unwrap()
        };
        let (all, seen) = (warp(None), warp(Some(&visible)));
        let mut drawn = [0; 2];
        for (index, (pixel, expected)) in seen.color.iter().zip(&all.color).enumerate() {
            let [x, y] = [index as u32 % width, index as u32 / width];
            let is_visible = visible.iter().any(|rect| rect.columns.contains(&x) && rect.rows.contains(&y));
            assert_eq!(*pixel, if is_visible { *expected } else { [0.0; 4] }, "{x} {y}");
            drawn[usize::from(is_visible)] += usize::from(*expected != [0.0; 4]);
        }
        assert!(drawn.iter().all(|&count| count > 100), "{drawn:?}");
        assert_eq!(warp(Some(&[])).color, vec![[0.0; 4]; all.color.len()]);
    });
}
