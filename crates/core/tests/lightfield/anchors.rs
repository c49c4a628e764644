//! Views that are derived from a few others, against casts of their own.

use crate::scene::{Scene, byte_window};
use glam::{DAffine3, DVec3};
use wheatstone_core::image::Image;
use wheatstone_core::lightfield::QuiltDisplay;
use wheatstone_core::lightfield::anchors::{AnchorError, AnchorPlan, MOST_SLABS, SlabPicture, derive, fill};
use wheatstone_core::lightfield::quilt::Sampling;
use wheatstone_core::metrics::compare;
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast};
use wheatstone_core::scene::{Mode, Settings, Shading};
use wheatstone_core::stereo::StereoError;
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{Orbit, View};
use wheatstone_core::volume::{Grid, Volume, Voxels};

/// Pixels of a view.
const TILE: [u32; 2] = [83, 71];

/// A display of columns × rows views: 0.2 m wide, seen from 0.5 m away.
fn display(columns: u32, rows: u32) -> QuiltDisplay {
    QuiltDisplay {
        columns,
        rows,
        quilt_size_px: [TILE[0] * columns, TILE[1] * rows],
        aspect: 83.0 / 71.0,
        view_cone_deg: 30.0,
        focal_distance_m: 0.5,
        screen_height_m: 0.2 * 71.0 / 83.0,
    }
}

fn views(columns: u32, rows: u32) -> Vec<View> {
    display(columns, rows).views(Sampling::Middles, DAffine3::IDENTITY)
}

fn settings() -> Settings {
    Settings::new(byte_window(), TransferFunction::ramp(0.2, 0.9).unwrap())
}

fn cast(scene: &Scene, views: &[View]) -> Vec<Cast> {
    scene.caster.cast_exactly(&scene.parameters, &Aids::default(), views)
}

fn plan(scene: &Scene, views: &[View], count: u32) -> AnchorPlan {
    let corners = scene.parameters.visible_corners_world();
    AnchorPlan::with_count(views, Mode::Composite, &corners, count).unwrap()
}

/// Pictures and slabs of the anchors of a plan.
fn anchors(scene: &Scene, plan: &AnchorPlan) -> Vec<(Cast, SlabPicture)> {
    let cast =
        |view| scene.caster.cast_slabs(&scene.parameters, &Aids::default(), view, &plan.slabs).unwrap();
    plan.anchors.iter().map(|anchor| cast(&anchor.view)).collect()
}

/// Every view out of the anchors of a plan.
fn derived(scene: &Scene, plan: &AnchorPlan) -> Vec<Image> {
    let slabs: Vec<SlabPicture> = anchors(scene, plan).into_iter().map(|(_, slabs)| slabs).collect();
    let filled = fill(plan, &slabs);
    plan.derived.iter().map(|view| derive(view, &filled)).collect()
}

fn dssim(found: &Image, cast: &Cast) -> f64 {
    compare(&found.over_background([0.0; 3]), &cast.image.over_background([0.0; 3])).unwrap().dssim()
}

fn largest_difference(a: &Image, b: &Image) -> f32 {
    let channels = a.color.iter().flatten().zip(b.color.iter().flatten());
    channels.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// A volume of random smooth blobs.
fn random(seed: u32) -> Volume {
    let mut state = seed;
    let mut share = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let balls: Vec<(DVec3, f64, f64)> = (0..12)
        .map(|_| (DVec3::new(share(), share(), share()), 0.05 + 0.12 * share(), 0.4 + 0.6 * share()))
        .collect();
    let side = 28;
    let values = (0..side * side * side).map(|i| {
        let p =
            DVec3::new((i % side) as f64, (i / side % side) as f64, (i / side / side) as f64) / side as f64;
        let of = |&(at, width, most): &(DVec3, f64, f64)| {
            most * (-(p - at).length_squared() / (width * width)).exp()
        };
        (255.0 * balls.iter().map(of).fold(0.0, f64::max)) as u8
    });
    Volume::new(Grid::new([side; 3], DAffine3::IDENTITY).unwrap(), Voxels::U8(values.collect())).unwrap()
}

#[test]
fn views_of_random_volumes_are_near_their_casts() {
    let views = views(4, 3);
    for (seed, shading, early_termination) in [
        (1, Shading::None, Some(0.99)),
        (2, Shading::Phong, Some(0.99)),
        (3, Shading::None, None),
        (4, Shading::Ambient, Some(0.99)),
    ] {
        let settings = Settings { shading, early_termination, ..settings() };
        let scene = Scene::new(&random(seed), 0.12, &settings);
        let own = cast(&scene, &views);
        let plan = plan(&scene, &views, 3);
        let off: Vec<f64> =
            derived(&scene, &plan).iter().zip(&own).map(|(found, cast)| dssim(found, cast)).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let worst = off.iter().copied().fold(0.0, f64::max);
        assert!(mean < 0.01 && worst < 0.03, "{seed}: {mean} {worst} {off:?}");
        let still = dssim(&own[0].image, &own[11]);
        assert!(still > 5.0 * worst, "nothing moves: {still}");
    }
}

#[test]
fn an_anchor_sees_its_own_cast() {
    let views = views(3, 1);
    let scene = Scene::new(&Phantom::MarschnerLobb.cube(30).unwrap(), 0.1, &settings());
    let plan = plan(&scene, &views, 1);
    let found = derived(&scene, &plan);
    let anchor = plan.anchors[0];
    assert_eq!(anchor.index, 1);
    let off = largest_difference(&found[1], &cast(&scene, &views)[1].image);
    assert!(off < 3.0 / 255.0, "{off}");
    // Its picture is its cast but for the columns beyond its edges.
    let (wide, _) = &anchors(&scene, &plan)[0];
    let own = &cast(&scene, &views)[1].image;
    for (row, line) in own.color.chunks(TILE[0] as usize).enumerate() {
        let at = row * anchor.view.size[0] as usize + anchor.left_px as usize;
        for (found, own) in wide.image.color[at..].iter().zip(line) {
            assert!(found.iter().zip(own).all(|(a, b)| (a - b).abs() < 1e-5), "row {row}: {found:?} {own:?}");
        }
    }
}

#[test]
fn what_is_at_the_focal_plane_stays_where_it_is() {
    // A sheet one voxel thick in the middle of the volume.
    let side = 31;
    let voxels = (0..side * side * side).map(|i| {
        let (x, y, z) = (i % side, i / side % side, i / side / side);
        let is_lit = z == side / 2 && (x / 4 + y / 5) % 2 == 0;
        if is_lit { 250 } else { 0 }
    });
    let grid = Grid::new([side; 3], DAffine3::IDENTITY).unwrap();
    let scene = Scene::new(&Volume::new(grid, Voxels::U8(voxels.collect())).unwrap(), 0.16, &settings());
    let views = views(4, 2);
    let plan = plan(&scene, &views, 1);
    let found = derived(&scene, &plan);
    let anchor = column_of_light(&cast(&scene, &views)[plan.anchors[0].index].image);
    for (index, view) in found.iter().enumerate() {
        let moved = column_of_light(view) - anchor;
        assert!(moved.abs() < 0.75, "{index}: {moved}");
    }
    // Before it, it does.
    let before = display(4, 2).views(Sampling::Middles, DAffine3::from_translation(DVec3::Z * 0.06));
    let own = cast(&scene, &before);
    let moved = column_of_light(&own[0].image) - column_of_light(&own[7].image);
    assert!(moved.abs() > 5.0, "{moved}");
}

/// The mean column of what is lit.
fn column_of_light(image: &Image) -> f64 {
    let lit = image.color.iter().zip((0..image.width).cycle());
    let [sum, moment] = lit.fold([0.0; 2], |[sum, moment], (color, column)| {
        let light = f64::from(color[0]);
        [sum + light, moment + light * f64::from(column)]
    });
    moment / sum
}

#[test]
fn no_gap_is_black() {
    // An opaque rod before an opaque wall: each view sees parts of the wall that others do not.
    let side = 40;
    let voxels = (0..side * side * side).map(|i| {
        let (x, z) = (i % side, i / side / side);
        let is_rod = (17..23).contains(&x) && z > 33;
        let is_wall = z < 4;
        if is_rod {
            120
        } else if is_wall {
            250
        } else {
            0
        }
    });
    let grid = Grid::new([side; 3], DAffine3::IDENTITY).unwrap();
    // The wall is bright, the rod is dark.
    let grey = |at, level| ColorPoint { at, rgb: [level; 3] };
    let alpha = |at, alpha| OpacityPoint { at, alpha };
    let colors = vec![grey(0.5, 0.2), grey(0.9, 1.0)];
    let transfer = TransferFunction::new(colors, vec![alpha(0.1, 0.0), alpha(0.4, 1.0)]).unwrap();
    let settings = Settings::new(byte_window(), transfer);
    // Larger than the screen: nothing else is black.
    let scene = Scene::new(&Volume::new(grid, Voxels::U8(voxels.collect())).unwrap(), 0.3, &settings);
    let views = views(4, 2);
    let own = cast(&scene, &views);
    for count in [1, 2, 3] {
        for (index, (found, own)) in
            derived(&scene, &plan(&scene, &views, count)).iter().zip(&own).enumerate()
        {
            // But for outlines, which may be a pixel off.
            let lines = found.color.windows(5).zip(own.image.color.windows(5));
            for (i, (found, own)) in lines.enumerate() {
                let is_within = own.iter().all(|own| own[3] > 0.95);
                assert!(!is_within || found[2][3] > 0.8, "{count} anchors, view {index}, pixel {}", i + 2);
            }
        }
    }
    // The other anchor fills what one does not see.
    let both = plan(&scene, &views, 2);
    let slabs: Vec<SlabPicture> = anchors(&scene, &both).into_iter().map(|(_, slabs)| slabs).collect();
    let off = |slabs: &[SlabPicture]| {
        let views = both.derived.iter().map(|view| derive(view, slabs));
        views.zip(&own).map(|(found, own)| dssim(&found, own)).sum::<f64>()
    };
    let [filled, left] = [off(&fill(&both, &slabs)), off(&slabs)];
    assert!(filled < 0.6 * left, "{filled} {left}");
}

#[test]
fn one_view_and_two_have_an_anchor() {
    let scene = Scene::new(&random(5), 0.12, &settings());
    let corners = scene.parameters.visible_corners_world();
    for count in [1, 2] {
        let views = views(count, 1);
        let plan = plan(&scene, &views, 1);
        assert_eq!(plan.anchors[0].index, 0);
        let (own, found) = (cast(&scene, &views), derived(&scene, &plan));
        assert!(dssim(&found[0], &own[0]) < 1e-4, "{}", dssim(&found[0], &own[0]));
        if let [left, right] = &own[..] {
            let (off, apart) = (dssim(&found[1], right), dssim(&left.image, right));
            assert!(off < apart, "{off} {apart}");
        }
        let error = AnchorPlan::new(&views, Mode::Composite, &corners).unwrap_err();
        assert!(matches!(error, AnchorError::DoesNotPay { .. }), "{error}");
    }
    let views = views(2, 1);
    for count in [0, 3] {
        let error = AnchorPlan::with_count(&views, Mode::Composite, &corners, count).unwrap_err();
        assert!(matches!(error, AnchorError::Count { .. }), "{error}");
    }
    let nothing = AnchorPlan::with_count(&[], Mode::Composite, &corners, 0).unwrap_err();
    assert_eq!(nothing, AnchorError::Count { count: 0, views: 0 });
}

#[test]
fn anchors_stand_from_the_first_view_to_the_last() {
    let scene = Scene::new(&Phantom::Sphere.cube(8).unwrap(), 0.1, &settings());
    let views = views(4, 3);
    for (count, indices) in [(1, vec![5]), (2, vec![0, 11]), (3, vec![0, 6, 11]), (12, (0..12).collect())] {
        let plan = plan(&scene, &views, count);
        let found: Vec<usize> = plan.anchors.iter().map(|anchor| anchor.index).collect();
        assert_eq!(found, indices);
        for (index, derived) in plan.derived.iter().enumerate() {
            let nearest = indices.iter().map(|anchor| anchor.abs_diff(index)).min();
            assert_eq!(Some(indices[derived.source.anchor].abs_diff(index)), nearest, "{count} {index}");
        }
        for anchor in 0..indices.len() {
            let sources = plan.neighbours(anchor);
            let next: Vec<usize> = sources.iter().map(|source| source.anchor).collect();
            let both = [anchor.wrapping_sub(1), anchor + 1];
            assert_eq!(next, both.into_iter().filter(|&next| next < indices.len()).collect::<Vec<_>>());
        }
    }
}

#[test]
fn their_number_follows_from_how_far_things_move() {
    let count_of = |longest_side_m: f64, pixels: u32| {
        let scene = Scene::new(&Phantom::Sphere.cube(8).unwrap(), longest_side_m, &settings());
        let corners = scene.parameters.visible_corners_world();
        let display = QuiltDisplay { quilt_size_px: [12 * 83 * pixels, 8 * 71 * pixels], ..display(12, 8) };
        let views = display.views(Sampling::Middles, DAffine3::IDENTITY);
        let plan = AnchorPlan::new(&views, Mode::Composite, &corners).unwrap();
        assert!(plan.slabs.count <= MOST_SLABS);
        plan.anchors.len()
    };
    assert_eq!(count_of(0.01, 1), 2);
    let [small, large, fine] = [count_of(0.05, 8), count_of(0.3, 8), count_of(0.05, 64)];
    assert!(large > small && fine > small, "{small} {large} {fine}");
}

#[test]
fn what_cannot_be_derived_says_why() {
    let scene = Scene::new(&Phantom::Sphere.cube(8).unwrap(), 0.1, &settings());
    let corners = scene.parameters.visible_corners_world();
    let quilt = views(8, 6);
    let mode = AnchorPlan::new(&quilt, Mode::Mip, &corners).unwrap_err();
    assert_eq!(mode, AnchorError::Mode(Mode::Mip));
    // Through the cameras' plane.
    let near = corners.map(|corner| corner * 12.0);
    let error = AnchorPlan::new(&quilt, Mode::Composite, &near).unwrap_err();
    assert!(matches!(error, AnchorError::TooNear { nearest_m, .. } if nearest_m < 0.01), "{error}");
    let turned = Orbit { azimuth_rad: 0.1, elevation_rad: 0.0, distance_m: 0.5 }.view_from_world();
    let mut toed_in = quilt.clone();
    toed_in[1].view_from_world = turned;
    let error = AnchorPlan::new(&toed_in, Mode::Composite, &corners).unwrap_err();
    assert!(matches!(error, AnchorError::Views(StereoError::Orientation { .. })), "{error}");
    let array = crate::scene::display(8, 1.0, [40, 30]);
    let projectors = array.views(DAffine3::IDENTITY);
    let error = AnchorPlan::new(&projectors, Mode::Composite, &corners).unwrap_err();
    assert_eq!(error, AnchorError::Views(StereoError::Projection));
}
