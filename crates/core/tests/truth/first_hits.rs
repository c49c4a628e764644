//! Space leaping from the last frame: fewer samples, and the same picture wherever what is visible is wider than the distance between
//! rays.

use crate::scene::*;
use crate::skipping::{bits, map};
use crate::tolerance;
use glam::{DAffine3, DQuat, DVec3};
use proptest::prelude::*;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::first_hits::FirstHits;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Caster, Leap};
use wheatstone_core::scene::{ClipPlane, Mode, Placement, Settings};
use wheatstone_core::skip::{BlockSize, Structure};
use wheatstone_core::transfer::TransferFunction;
use wheatstone_core::view::View;
use wheatstone_core::volume::{StorageKind, Volume};

const SIZE: [u32; 2] = [93, 70];

/// Rays that are closer together than voxels.
fn view() -> View {
    look(DVec3::new(0.35, 0.3, 0.8), DVec3::ZERO, DVec3::Y, perspective(0.8, SIZE), SIZE)
}

/// The same after the eye has moved in its own space and turned about +Y.
fn moved(view: &View, by_m: DVec3, turn_rad: f64) -> View {
    let own = DAffine3::from_rotation_translation(DQuat::from_rotation_y(turn_rad), by_m);
    View { view_from_world: own.inverse() * view.view_from_world, ..*view }
}

struct Scene {
    volume: Volume,
    caster: Caster,
    parameters: CastParameters,
}

impl Scene {
    fn new(volume: Volume, settings: &Settings) -> Self {
        let parameters = CastParameters::new(settings, &Placement::new(&volume, world_from_patient()));
        Self { caster: Caster::new(&volume), volume, parameters }
    }

    fn phantom(phantom: Phantom, change: impl FnOnce(&mut Settings)) -> Self {
        let mut settings = Settings::new(byte_window(), TransferFunction::ramp(0.3, 1.0).unwrap());
        change(&mut settings);
        Self::new(phantom.cube(48).unwrap(), &settings)
    }

    fn see(&self, view: &View) -> FirstHits {
        self.caster.cast_leaping(&self.parameters, &Aids::default(), view, None).1
    }

    /// Casts a view after the last picture, alone and with a skip map, checks that it is the full one, and returns the samples of
    /// both, and what was seen.
    fn assert_full(&self, view: &View, last: &FirstHits, what: &str) -> ([u64; 2], FirstHits) {
        let none = Aids::default();
        let full = self.caster.cast(&self.parameters, &none, &[*view]).remove(0);
        let (leapt, seen) = self.caster.cast_leaping(&self.parameters, &none, view, Some(last));
        assert!(bits(&leapt) == bits(&full), "{what}");
        let block = BlockSize::cube(4).unwrap();
        let map = map(&self.volume, StorageKind::U8, &self.parameters, None, block, Structure::Anisotropic);
        let aids = Leap::EmptyBlocks(&map).into();
        let (both, seen_by_both) = self.caster.cast_leaping(&self.parameters, &aids, view, Some(last));
        assert!(bits(&both) == bits(&full), "{what}, with a map");
        assert_eq!(seen_by_both, seen, "{what}");
        ([leapt.samples, full.samples], seen)
    }
}

/// A name, and a scene to make.
type Look = (&'static str, fn() -> Scene);

/// Looks of every kind that has first hits, of things that are nowhere thinner than a voxel.
const LOOKS: [Look; 7] = [
    ("opaque", || Scene::phantom(Phantom::Sphere, |_| {})),
    ("soft", || {
        let haze = white_transfer(&[(0.05, 0.0), (1.0, 0.03)]);
        Scene::phantom(Phantom::SheppLogan, |s| (s.transfer, s.early_termination) = (haze, None))
    }),
    ("pre-integrated", || Scene::phantom(Phantom::Sphere, |s| s.preintegrated = true)),
    ("surface", || Scene::phantom(Phantom::Orientation, |s| s.mode = Mode::Isosurface { isovalue: 0.5 })),
    ("cut surface", || {
        Scene::phantom(Phantom::SheppLogan, |s| {
            s.mode = Mode::Isosurface { isovalue: 0.15 };
            s.clip.plane = Some(ClipPlane { normal: DVec3::new(0.6, 0.0, 0.8), offset_m: -0.05 });
        })
    }),
    ("fine steps", || Scene::phantom(Phantom::SolidBox, |s| s.sampling_factor = 3.0)),
    ("long steps", || Scene::phantom(Phantom::Sphere, |s| s.sampling_factor = 0.5)),
];

#[test]
fn from_the_same_eye_rays_start_at_most_where_they_saw_something() {
    for (what, make) in LOOKS {
        let scene = make();
        let seen = scene.see(&view());
        let starts = seen.starts(&view(), &scene.parameters);
        let mut ends = 0;
        for (&start_m, &nearest_m) in starts.depths_m().iter().zip(seen.nearest_m()) {
            assert!(start_m <= nearest_m, "{what}: {start_m} {nearest_m}");
            ends += usize::from(start_m == f32::INFINITY);
        }
        assert!(ends > 0, "{what}: every tile may hold something");
        let ([leapt, full], again) = scene.assert_full(&view(), &seen, what);
        assert!(10 * leapt < 9 * full, "{what}: {leapt} of {full} samples");
        assert_eq!(again, seen, "{what}");
    }
}

#[test]
fn after_a_small_move_the_picture_is_the_full_one_of_fewer_samples() {
    let moves = [(DVec3::new(0.015, 0.0, 0.0), 0.02), (DVec3::new(0.0, -0.01, 0.02), -0.03)];
    for (what, make) in LOOKS {
        let scene = make();
        for (by_m, turn_rad) in moves {
            let next = moved(&view(), by_m, turn_rad);
            let ([leapt, full], _) = scene.assert_full(&next, &scene.see(&view()), what);
            assert!(10 * leapt < 9 * full, "{what}: {leapt} of {full} samples");
        }
    }
}

/// What is lost in a frame is lost in all that follow: nothing may be.
#[test]
fn nothing_is_lost_over_many_frames() {
    for (what, make) in LOOKS {
        let scene = make();
        let mut seen = scene.see(&view());
        for frame in 1..25 {
            let next =
                moved(&view(), DVec3::new(0.01 * f64::from(frame), 0.0, 0.0), 0.012 * f64::from(frame));
            seen = scene.assert_full(&next, &seen, &format!("{what}, frame {frame}")).1;
        }
    }
}

/// A small ball right behind a large one.
#[test]
fn what_was_hidden_is_seen() {
    let ball = |p: DVec3, at: DVec3, radius: f64| (radius - p.distance(at)).clamp(0.0, 1.0);
    let volume = volume_of([40, 40, 60], [1.0; 3], |p| {
        ball(p, DVec3::new(20.0, 20.0, 42.0), 12.0).max(ball(p, DVec3::new(20.0, 20.0, 8.0), 4.0))
    });
    let settings = Settings::new(unit_window(), white_transfer(&[(0.2, 0.0), (0.5, 1.0)]));
    let scene = Scene::new(volume, &settings);
    let front = look(DVec3::new(0.0, 0.0, 0.9), DVec3::ZERO, DVec3::Y, perspective(0.8, SIZE), SIZE);
    let seen = scene.see(&front);
    for step in 1..8 {
        let next =
            look(DVec3::new(0.1 * f64::from(step), 0.0, 0.9), DVec3::ZERO, DVec3::Y, front.projection, SIZE);
        scene.assert_full(&next, &seen, &format!("step {step}"));
    }
}

#[test]
fn what_was_not_in_the_picture_is_seen() {
    let scene = Scene::phantom(Phantom::Present, |_| {});
    for turn_rad in [0.3, -0.6, 1.5, 3.1] {
        let last = moved(&view(), DVec3::ZERO, turn_rad);
        let seen = scene.see(&last);
        scene.assert_full(&view(), &seen, &format!("turned by {turn_rad}"));
        // From within the volume, and of another size.
        let within = moved(&view(), DVec3::new(0.05, 0.0, -0.75), 0.3);
        scene.assert_full(&within, &seen, "into the volume");
        let small = View { size: [SIZE[0] / 2, SIZE[1] / 2], ..view() };
        scene.assert_full(&small, &seen, "a smaller picture");
    }
    let parallel = View { projection: orthographic(0.6, SIZE), ..view() };
    for (last, next) in
        [(parallel, view()), (view(), parallel), (parallel, moved(&parallel, DVec3::X * 0.02, 0.1))]
    {
        scene.assert_full(&next, &scene.see(&last), "parallel");
    }
}

#[test]
fn modes_without_first_hits_leap_over_nothing() {
    for mode in [Mode::Mip, Mode::MinIp, Mode::Mean, Mode::XRay] {
        let scene = Scene::phantom(Phantom::Snake, |s| s.mode = mode);
        let seen = scene.see(&view());
        let cast = |last| scene.caster.cast_leaping(&scene.parameters, &Aids::default(), &view(), last).0;
        assert_eq!(cast(Some(&seen)).samples, cast(None).samples, "{mode:?}");
    }
}

#[test]
fn views_that_are_none_leap_over_nothing() {
    let scene = Scene::phantom(Phantom::Sphere, |_| {});
    let nowhere = View { view_from_world: DAffine3::from_scale(DVec3::splat(f64::NAN)), ..view() };
    let seen = scene.see(&view());
    let seen = FirstHits::of_tiles(&nowhere, seen.margin_m(), seen.nearest_m().to_vec());
    let starts = seen.starts(&view(), &scene.parameters);
    assert!(starts.depths_m().iter().all(|&depth_m| depth_m == f32::NEG_INFINITY));
}

fn eyes() -> impl Strategy<Value = View> {
    let eye = prop::array::uniform3(-0.6..0.6_f64);
    (eye, prop::bool::ANY, prop::array::uniform2(60_u32..90)).prop_map(|(eye, is_parallel, size)| {
        let eye = DVec3::from(eye) + DVec3::new(0.0, 0.01, 0.3);
        let projection = if is_parallel { orthographic(0.5, size) } else { perspective(0.8, size) };
        look(eye, DVec3::ZERO, DVec3::Y, projection, size)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn nothing_that_is_wider_than_a_voxel_is_lost(
        view in eyes(),
        by_m in prop::array::uniform3(-0.05..0.05_f64),
        turn_rad in -0.2..0.2_f64,
        which in 0..LOOKS.len(),
    ) {
        let (what, make) = LOOKS[which];
        let scene = make();
        let next = moved(&view, DVec3::from(by_m), turn_rad);
        scene.assert_full(&next, &scene.see(&view), what);
    }
}

/// Thin sheets between rays are what leaping may lose: little, here.
#[test]
fn thin_things_are_lost_rarely() {
    for phantom in [Phantom::Present, Phantom::Beetle, Phantom::Snake] {
        let scene = Scene::phantom(phantom, |s| s.mode = Mode::Isosurface { isovalue: 0.4 });
        let none = Aids::default();
        let mut seen = scene.see(&view());
        for frame in 1..10 {
            let next = moved(&view(), DVec3::X * 0.012 * f64::from(frame), 0.015 * f64::from(frame));
            let (leapt, now) = scene.caster.cast_leaping(&scene.parameters, &none, &next, Some(&seen));
            let full = scene.caster.cast(&scene.parameters, &none, &[next]).remove(0);
            let apart = difference(&leapt, &full).dssim();
            assert!(apart < tolerance::LEAPING_DSSIM, "{phantom:?}, frame {frame}: {apart}");
            seen = now;
        }
    }
}
