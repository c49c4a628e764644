//! Leaping to the first hits of the last frame: what is noted and where rays start are the reference's, and the picture is the full one.

use crate::device::on_device;
use crate::scene::*;
use glam::{DAffine3, DQuat, DVec3};
use std::ops::Range;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::first_hits::{FirstHits, TILE, tiles_of};
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::view::{PixelRect, View};
use wheatstone_core::volume::{Volume, VoxelType};
use wheatstone_render::skip::{SkipBuilder, SkipKernels};
use wheatstone_render::{Gpu, GpuVolume, Leap, Prepared, Renderer, Sources, Target, TexelFormat};

const SIZE: [u32; 2] = [93, 70];

/// How far rounding may move a start, metres.
const ROUNDING_M: f64 = 1e-4;

/// Share of the tiles, and of their neighbours, that rounding may give another tile to look up.
const ROUNDED_TILES: f64 = 0.02;

fn moved(view: &View, by_m: DVec3, turn_rad: f64) -> View {
    let own = DAffine3::from_rotation_translation(DQuat::from_rotation_y(turn_rad), by_m);
    View { view_from_world: own.inverse() * view.view_from_world, ..*view }
}

/// Pairs of views of which the second follows the first.
fn moves() -> Vec<[View; 2]> {
    let eye = DVec3::new(0.6, 0.5, 1.0);
    let near = look(eye, DVec3::ZERO, perspective(0.5, SIZE), SIZE);
    let parallel = look(eye, DVec3::ZERO, orthographic(0.8, SIZE), SIZE);
    let small = View { size: [70, 52], ..near };
    vec![
        [near, near],
        [near, moved(&near, DVec3::new(0.02, -0.01, 0.01), 0.03)],
        [near, moved(&near, DVec3::new(0.0, 0.0, -0.5), -0.2)],
        [near, moved(&near, DVec3::ZERO, 1.0)],
        [parallel, moved(&parallel, DVec3::new(0.02, 0.0, 0.0), 0.02)],
        [parallel, near],
        [small, near],
    ]
}

fn target(gpu: &Gpu, view: &View) -> Target {
    Target::with_first_hits(gpu, view.size).unwrap()
}

fn render_after(
    gpu: &Gpu,
    renderer: &mut Renderer,
    prepared: &Prepared,
    view: &View,
    last: &[Target],
) -> Target {
    let mut target = target(gpu, view);
    renderer.render_after(gpu, prepared, &[*view], std::slice::from_mut(&mut target), last).unwrap();
    target
}

fn assert_seen_alike(found: &FirstHits, expected: &FirstHits, what: &str) {
    let tiles = found.nearest_m().iter().zip(expected.nearest_m());
    let apart = tiles.filter(|(a, b)| a.is_finite() != b.is_finite() || (*a - *b).abs() > 0.03).count();
    assert!(apart <= 2, "{what}: {apart} of {} tiles saw something else", found.nearest_m().len());
    assert_eq!((found.view(), found.margin_m()), (expected.view(), expected.margin_m()), "{what}");
}

/// Whether the rays of each tile may meet the volume.
fn covered_tiles(view: &View, parameters: &CastParameters) -> Vec<bool> {
    let PixelRect { columns, rows } = PixelRect::around(view, parameters.visible_corners_world());
    let [across, down] = tiles_of(view.size);
    let meets = |tile: u32, pixels: &Range<u32>| pixels.start < (tile + 1) * TILE && tile * TILE < pixels.end;
    (0..across * down).map(|tile| meets(tile % across, &columns) && meets(tile / across, &rows)).collect()
}

/// Whether nothing was leapt over.
fn start_at_once(starts_m: &[f32], view: &View, parameters: &CastParameters) -> bool {
    let covered = covered_tiles(view, parameters);
    covered.iter().zip(starts_m).all(|(covered, &start_m)| !covered || start_m < -1e20)
}

fn assert_starts(found_m: &[f32], seen: &FirstHits, view: &View, parameters: &CastParameters, what: &str) {
    let with_margin = |margin_m: f64| {
        FirstHits::of_tiles(seen.view(), margin_m, seen.nearest_m().to_vec()).starts(view, parameters)
    };
    let (low, high) = (with_margin(seen.margin_m() + ROUNDING_M), with_margin(seen.margin_m() - ROUNDING_M));
    let bounds = low.depths_m().iter().zip(high.depths_m());
    let is_between = |found: f32, low: f32, high: f32| {
        let found = if found >= 1e30 { f32::INFINITY } else { found };
        low - ROUNDING_M as f32 <= found && found <= high + ROUNDING_M as f32
    };
    let covered = covered_tiles(view, parameters);
    let tiles = covered.iter().zip(found_m).zip(bounds).filter(|((covered, _), _)| **covered);
    let apart = tiles.filter(|((_, found), (low, high))| !is_between(**found, **low, **high)).count() as f64;
    assert!(apart <= ROUNDED_TILES * found_m.len() as f64, "{what}: {apart} tiles start elsewhere");
}

fn assert_same(found: &Cast, full: &Cast, what: &str) {
    assert!(largest_difference(found, full) < 1e-6, "{what}: {}", largest_difference(found, full));
    assert_eq!(found.image.depth_m, full.image.depth_m, "{what}");
}

fn settings(volume: &Volume) -> Vec<(&'static str, TexelFormat, Settings)> {
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::new(volume.full_window(), transfer(0.5));
        change(&mut settings);
        settings
    };
    let (quads, half) = (TexelFormat::Rgba8UnormQuads, TexelFormat::R16FloatOf8Bit);
    vec![
        ("composite", quads, with(&|_| {})),
        ("faint", half, with(&|s| (s.transfer, s.early_termination) = (transfer(0.01), None))),
        ("lit", half, with(&|s| s.shading = Shading::Phong)),
        ("pre-integrated", half, with(&|s| s.preintegrated = true)),
        ("surface", quads, with(&|s| s.mode = Mode::Isosurface { isovalue: 0.4 })),
    ]
}

#[test]
fn starts_are_those_of_the_reference_and_pictures_full() {
    let volume = blob_volume([60, 50, 70], oblique([1.0, 1.2, 1.0]), VoxelType::U8);
    on_device(|gpu, renderer| {
        let kernels = SkipKernels::new(gpu).unwrap();
        let mut saved = 0;
        for (name, format, settings) in settings(&volume) {
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let caster = Caster::with_storage(&volume, storage_kind(format));
            let uploaded = GpuVolume::upload_as(gpu, &volume, format, &mut |_, _| {}).unwrap();
            let map = SkipBuilder::new(gpu, &kernels, &uploaded, BlockSize::cube(4).unwrap())
                .and_then(|mut builder| builder.map(gpu, &parameters, Structure::Anisotropic))
                .unwrap();
            for (skip, leap) in [("none", Leap::Nothing), ("map", Leap::EmptyBlocks(&map))] {
                let sources = Sources { leap, ..Sources::volume(&uploaded) };
                let full = renderer.prepare(gpu, &sources, parameters.clone()).unwrap();
                let leaping = renderer.leaping(gpu, &full).unwrap();
                for (i, [first, next]) in moves().into_iter().enumerate() {
                    let what = format!("{name}, skipping {skip}, move {i}");
                    let last = render_after(gpu, renderer, &leaping, &first, &[]);
                    let (seen, starts_m) = last.read_first_hits(gpu).unwrap().unwrap();
                    assert!(
                        start_at_once(&starts_m, &first, &parameters),
                        "{what}: there was no last picture"
                    );
                    let expected = caster.cast_leaping(&parameters, &Aids::default(), &first, None).1;
                    assert_seen_alike(&seen, &expected, &what);

                    let target = render_after(gpu, renderer, &leaping, &next, &[last]);
                    let (_, starts_m) = target.read_first_hits(gpu).unwrap().unwrap();
                    assert_starts(&starts_m, &seen, &next, &parameters, &what);
                    let leapt = target.read(gpu).unwrap();
                    let full = renderer.render_to_host(gpu, &full, &[next]).unwrap().remove(0);
                    assert_same(&leapt, &full, &what);
                    assert!(leapt.samples <= full.samples, "{what}");
                    saved += full.samples - leapt.samples;
                }
            }
        }
        assert!(saved > 1_000_000, "only {saved} samples were left out");
    });
}

#[test]
fn only_the_same_scene_is_leapt_in() {
    let volume = blob_volume([30, 30, 30], spacing([1.0; 3]), VoxelType::U8);
    let parameters = |settings: &Settings| CastParameters::new(settings, &placement(&volume));
    let settings = Settings::new(volume.full_window(), transfer(0.9));
    let view = outside();
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload(gpu, &volume, &mut |_, _| {}).unwrap();
        let sources = Sources::volume(&uploaded);
        let prepare = |renderer: &mut Renderer, settings: &Settings| {
            let plain = renderer.prepare(gpu, &sources, parameters(settings)).unwrap();
            (renderer.leaping(gpu, &plain).unwrap(), plain)
        };
        let (leaping, plain) = prepare(renderer, &settings);
        let other_settings = Settings { transfer: transfer(0.2), ..settings.clone() };
        let (other, _) = prepare(renderer, &other_settings);
        let starts_at_once = |target: &Target| {
            let (_, starts_m) = target.read_first_hits(gpu).unwrap().unwrap();
            start_at_once(&starts_m, &view, &parameters(&settings))
        };
        let last = [render_after(gpu, renderer, &leaping, &view, &[])];
        assert!(!starts_at_once(&render_after(gpu, renderer, &leaping, &view, &last)));
        assert!(starts_at_once(&render_after(gpu, renderer, &other, &view, &last)));
        // A cast that notes nothing leaves nothing to leap by.
        let unnoted = [render_after(gpu, renderer, &plain, &view, &[])];
        assert!(unnoted[0].read_first_hits(gpu).unwrap().is_none());
        assert!(starts_at_once(&render_after(gpu, renderer, &leaping, &view, &unnoted)));
        let (projection, plain) = prepare(renderer, &Settings { mode: Mode::Mip, ..settings.clone() });
        let last = [render_after(gpu, renderer, &projection, &view, &[])];
        let mip = render_after(gpu, renderer, &projection, &view, &last).read(gpu).unwrap();
        assert_same(&mip, &renderer.render_to_host(gpu, &plain, &[view]).unwrap()[0], "MIP");
    });
}
