//! Views of anchors against their twin, and against casts of their own.

use crate::device::on_device;
use crate::scene::*;
use glam::{DAffine3, DVec3};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::lightfield::QuiltDisplay;
use wheatstone_core::lightfield::anchors::{AnchorPlan, Hider, SlabPicture, color_of, derive, fill};
use wheatstone_core::lightfield::quilt::Sampling;
use wheatstone_core::metrics::compare;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Settings, Shading};
use wheatstone_core::view::View;
use wheatstone_core::volume::VoxelType;
use wheatstone_render::{GpuVolume, Sources, Target, TexelFormat};

/// What both casters hold exactly.
const FORMAT: TexelFormat = TexelFormat::R16FloatOf8Bit;

/// Views of 77 × 53 pixels of the world, where volumes are 1 m long.
fn views(count: u32) -> Vec<View> {
    let display = QuiltDisplay {
        columns: count,
        rows: 1,
        quilt_size_px: [77 * count, 53],
        aspect: 77.0 / 53.0,
        view_cone_deg: 24.0,
        focal_distance_m: 3.0,
        screen_height_m: 1.2,
    };
    display.views(Sampling::Middles, DAffine3::from_translation(DVec3::Z * 0.1))
}

fn dssim(a: &Cast, b: &Cast) -> f64 {
    compare(&a.image.over_background([0.0; 3]), &b.image.over_background([0.0; 3])).unwrap().dssim()
}

#[test]
fn they_are_those_of_the_twin_and_near_their_casts() {
    let volume = blob_volume([40, 33, 37], spacing([1.0, 1.2, 1.1]), VoxelType::U8);
    let views = views(9);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload_as(gpu, &volume, FORMAT, &mut |_, _| {}).unwrap();
        let caster = Caster::with_storage(&volume, storage_kind(FORMAT));
        let mut last = None;
        for (alpha, shading, count) in [
            (0.1, Shading::None, 2),
            (0.9, Shading::Phong, 2),
            (0.9, Shading::None, 1),
            (0.4, Shading::Ambient, 3),
        ] {
            let settings = Settings { shading, ..Settings::new(volume.full_window(), transfer(alpha)) };
            let parameters = CastParameters::new(&settings, &placement(&volume));
            let corners = parameters.visible_corners_world();
            let plan = AnchorPlan::with_count(&views, parameters.mode, &corners, count).unwrap();
            let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters.clone()).unwrap();
            let own = renderer.render_to_host(gpu, &prepared, &views).unwrap();
            let anchors = renderer.cast_anchors(gpu, &prepared, &plan, last.take()).unwrap();
            assert!(anchors.byte_size() >= u64::from(count) * plan.slabs.byte_size([77, 53]));

            let mut twins = Vec::new();
            for (index, anchor) in plan.anchors.iter().enumerate() {
                let (cast, _) = anchors.read(gpu, index).unwrap();
                let (exact, twin) =
                    caster.cast_slabs(&parameters, &Aids::default(), &anchor.view, &plan.slabs).unwrap();
                assert!(largest_difference(&cast, &exact) < 3e-3, "{alpha} {index}");
                twins.push(twin);
            }
            let mut slabs = Vec::new();
            for (index, twin) in fill(&plan, &twins).iter().enumerate() {
                let (_, found) = anchors.read(gpu, index).unwrap();
                check_slabs(&found, twin);
                slabs.push(found);
            }
            let mut target = Target::new(gpu, [77, 53]).unwrap();
            let mut errors = Vec::new();
            for (index, (derived, own)) in plan.derived.iter().zip(&own).enumerate() {
                renderer.derive(gpu, &anchors, index, &mut target).unwrap();
                let found = target.read(gpu).unwrap();
                errors.push(dssim(&found, own));
                if let Some(anchor) = plan.anchors.iter().find(|anchor| anchor.index == index) {
                    let like_it = View { shaded_from: anchor.view.shaded_from, ..views[index] };
                    let own = &renderer.render_to_host(gpu, &prepared, &[like_it]).unwrap()[0];
                    assert!(largest_difference(&found, own) < 1.0 / 255.0, "{alpha} {count}, anchor {index}");
                } else {
                    // Of the same cells.
                    let twin = Cast::new(derive(derived, &slabs), own.reads.clone());
                    let off = dssim(&found, &twin);
                    assert!(off < 1e-5, "{alpha} {count}, view {index}: {off} from the twin");
                }
            }
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let worst = errors.iter().copied().fold(0.0, f64::max);
            assert!(mean < 0.01 && worst < 0.03, "{alpha} {shading:?} {count}: {errors:?}");
            last = Some(anchors);
        }
    });
}

/// Compares cells: samples near the bounds of slabs may be in either.
fn check_slabs(found: &SlabPicture, twin: &SlabPicture) {
    assert_eq!((found.size, found.count), (twin.size, twin.count));
    let is_off = |&(&a, &b): &(&u32, &u32)| (color_of(a) - color_of(b)).abs().max_element() > 3.0 / 255.0;
    let filled = twin.cells.iter().filter(|&&cell| cell != 0).count();
    let off = found.cells.iter().zip(&twin.cells).filter(is_off).count();
    // The first anchor has 3951, of few slabs with little in them.
    assert!(filled > 2_000 && off < filled / 50, "{off} of {filled}");
    let ends = found.ends.iter().zip(&twin.ends);
    let is_elsewhere = |&(&a, &b): &(&u32, &u32)| {
        let [hider, of_twin] = [a, b].map(Hider::of_end);
        hider.map(Hider::slab) != of_twin.map(Hider::slab)
    };
    let elsewhere = ends.clone().filter(is_elsewhere).count();
    assert!(elsewhere < 20, "{elsewhere} of {}", ends.filter(|&(_, &end)| end != 0).count());
}

#[test]
fn rays_in_parts_leave_the_same_slabs() {
    let volume = blob_volume([40, 33, 37], spacing([1.0, 1.2, 1.1]), VoxelType::U8);
    let views = views(5);
    on_device(|gpu, renderer| {
        let uploaded = GpuVolume::upload_as(gpu, &volume, FORMAT, &mut |_, _| {}).unwrap();
        let caster = Caster::with_storage(&volume, storage_kind(FORMAT));
        // So many samples that no dispatch takes all of a ray.
        let settings =
            Settings { sampling_factor: 150.0, ..Settings::new(volume.full_window(), transfer(0.5)) };
        let parameters = CastParameters::new(&settings, &placement(&volume));
        let corners = parameters.visible_corners_world();
        let plan = AnchorPlan::with_count(&views, parameters.mode, &corners, 1).unwrap();
        let prepared = renderer.prepare(gpu, &Sources::volume(&uploaded), parameters.clone()).unwrap();
        let anchors = renderer.cast_anchors(gpu, &prepared, &plan, None).unwrap();
        let (_, found) = anchors.read(gpu, 0).unwrap();
        let coarse = CastParameters { sampling_factor: 4.0, ..parameters };
        let (_, twin) =
            caster.cast_slabs(&coarse, &Aids::default(), &plan.anchors[0].view, &plan.slabs).unwrap();
        let alpha = |picture: &SlabPicture| -> f64 {
            picture.cells.iter().map(|&cell| f64::from(color_of(cell).w)).sum::<f64>()
        };
        let twin = fill(&plan, &[twin]);
        let (found, twin) = (alpha(&found), alpha(&twin[0]));
        assert!((found / twin - 1.0).abs() < 0.03, "{found} {twin}");
    });
}
