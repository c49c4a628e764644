//! What eyes in front of displays see, against what there would be to see.

use crate::scene::{Scene, byte_window, display};
use glam::{DAffine3, DVec3};
use wheatstone_core::detail::{LevelOfDetail, Slab};
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::quilt::{Model, Sampling};
use wheatstone_core::lightfield::simulator::Eye;
use wheatstone_core::lightfield::{
    Coarseness, Lenticular, ProjectorArray, QuiltDisplay, RESOLVED_PIXELS, Tried, coarsest_alike,
};
use wheatstone_core::lit_sphere::Style;
use wheatstone_core::metrics::{SizeMismatch, compare};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::reference::{Aids, Cast, Caster};
use wheatstone_core::scene::{Settings, Shading};
use wheatstone_core::transfer::{ColorPoint, OpacityPoint, TransferFunction};
use wheatstone_core::view::{PixelRect, View};
use wheatstone_core::volume::{Volume, Voxels};

const SIZE: [u32; 2] = [80, 60];

/// Translucent, blue to yellow: nothing is so sharp that its samples along rays show.
fn soft() -> TransferFunction {
    let color =
        vec![ColorPoint { at: 0.0, rgb: [0.2, 0.3, 0.9] }, ColorPoint { at: 1.0, rgb: [1.0, 0.9, 0.6] }];
    let opacity = vec![OpacityPoint { at: 0.05, alpha: 0.0 }, OpacityPoint { at: 1.0, alpha: 0.2 }];
    TransferFunction::new(color, opacity).unwrap()
}

fn scene() -> Scene {
    head(0.14)
}

fn head(side_m: f64) -> Scene {
    Scene::new(&Phantom::SheppLogan.cube(64).unwrap(), side_m, &Settings::new(byte_window(), soft()))
}

fn over_black(casts: &[Cast]) -> Vec<RgbImage> {
    casts.iter().map(|cast| cast.image.over_background([0.0; 3])).collect()
}

fn cast(scene: &Scene, views: &[View]) -> Vec<RgbImage> {
    over_black(&scene.caster.cast(&scene.parameters, &Aids::default(), views))
}

/// DSSIM of what an eye sees of a display and of what it would see of the world.
fn dssim_at(scene: &Scene, array: &ProjectorArray, images: &[RgbImage], eye_m: DVec3) -> f64 {
    let eye = Eye::new(eye_m, SIZE).unwrap();
    let seen = array.seen_from(&eye, images).unwrap();
    let screen_size_m = array.description().screen_size_m;
    let view = View { shaded_from: None, ..eye.view(screen_size_m, DAffine3::IDENTITY) };
    let truth = cast(scene, &[view]).remove(0);
    compare(&seen, &truth).unwrap().dssim()
}

#[test]
fn at_the_virtual_viewers_place_the_world_is_seen_and_elsewhere_ever_less_so() {
    let (scene, array) = (scene(), display(48, 1.2, SIZE));
    let images = cast(&scene, &array.views(DAffine3::IDENTITY));
    let viewer = array.description().viewer;
    let at = |right_m: f64, up_m: f64, back_m: f64| {
        dssim_at(
            &scene,
            &array,
            &images,
            DVec3::new(right_m, viewer.height_m + up_m, viewer.distance_m + back_m),
        )
    };
    for right_m in [-0.12, -0.035, 0.0, 0.035, 0.12] {
        let dssim = at(right_m, 0.0, 0.0);
        assert!(dssim <= 0.02, "{right_m} m to the right: {dssim}");
    }
    for (towards, step_m) in [(DVec3::Y, 0.01), (DVec3::NEG_Y, 0.01), (DVec3::Z, 0.04), (DVec3::NEG_Z, 0.03)]
    {
        let errors: Vec<f64> = (0..8)
            .map(|i| {
                let [x, y, z] = (towards * step_m * f64::from(i)).to_array();
                at(x, y, z)
            })
            .collect();
        let steps: Vec<f64> = errors.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(errors[7] > 3.0 * errors[0], "{errors:?}");
        // It grows, and without jumps.
        assert!(steps.iter().all(|&step| step > -0.0003 && step < 0.003), "{errors:?}");
    }
}

#[test]
fn an_eye_sees_the_same_of_the_columns_that_it_sees_alone() {
    let (scene, array) = (scene(), display(24, 2.4, [40, 30]));
    let images = cast(&scene, &array.views(DAffine3::IDENTITY));
    for eye_m in [DVec3::new(0.05, 0.0, 0.6), DVec3::new(-0.3, 0.1, 0.4), DVec3::new(3.0, 0.0, 0.2)] {
        let eye = Eye::new(eye_m, SIZE).unwrap();
        let seen = array.parts_seen_from(&eye);
        let parts: Vec<RgbImage> = images
            .iter()
            .zip(seen.columns())
            .map(|(image, columns)| image.cut([columns.start, 0], [columns.len() as u32, 30]))
            .collect();
        let of_all: usize = seen.columns().iter().map(ExactSizeIterator::len).sum();
        assert!(of_all < 24 * 40 / 3, "{of_all} columns");
        assert_eq!(seen.picture(&parts), array.seen_from(&eye, &images).unwrap());
        assert!(seen.lit_columns().end <= SIZE[0]);
    }
}

#[test]
fn from_any_height_a_display_of_projectors_looks_the_same() {
    let (scene, array) = (scene(), display(24, 2.4, [40, 30]));
    let images = cast(&scene, &array.views(DAffine3::IDENTITY));
    let seen = |y: f64| array.seen_from(&Eye::new(DVec3::new(0.05, y, 0.6), SIZE).unwrap(), &images).unwrap();
    assert_eq!(seen(0.0), seen(0.3));
    let moved = array.seen_from(&Eye::new(DVec3::new(-0.05, 0.0, 0.6), SIZE).unwrap(), &images).unwrap();
    assert!(compare(&moved, &seen(0.0)).unwrap().dssim() > 0.01);
}

#[test]
fn all_of_a_white_screen_is_white_and_beyond_the_last_beam_it_is_dark() {
    let array = display(48, 1.2, [16, 12]);
    let white = vec![RgbImage { width: 16, height: 12, rgb: vec![[1.0; 3]; 16 * 12] }; 48];
    let seen =
        |x: f64| array.seen_from(&Eye::new(DVec3::new(x, 0.0, 0.6), [20, 15]).unwrap(), &white).unwrap();
    assert!(seen(0.05).rgb.iter().flatten().all(|&level| (level - 1.0).abs() < 1e-6));
    assert!(seen(2.0).rgb.iter().flatten().all(|&level| level == 0.0));
}

/// A display that is deep for its volume, and what it is cast of.
struct Deep {
    scene: Scene,
    array: ProjectorArray,
    /// The volume and its coarser levels.
    casters: Vec<Caster>,
}

impl Deep {
    /// 20 cm long: where its ends are 10 cm from the screen, s(z) is several times the pixel.
    fn new(volume: &Volume) -> Self {
        let scene = Scene::new(volume, 0.2, &Settings::new(volume.full_window(), soft()));
        let mut casters = vec![Caster::new(volume)];
        casters.extend(volume.coarser_levels().iter().map(Caster::new));
        Self { scene, array: display(24, 2.4, SIZE), casters }
    }

    /// What there is to see in a view; rays go through pixels of four times the number.
    fn truth(&self, view: View) -> RgbImage {
        cast(&self.scene, &[View { size: view.size.map(|side| 4 * side), ..view }]).remove(0).averaged(4)
    }

    /// The most that the display's beams can show of a view, which is made of how the world is moved.
    fn of_beams(&self, view: impl Fn(DAffine3) -> View) -> RgbImage {
        let views: Vec<View> = self.array.resolution().beam(32).map(view).collect();
        RgbImage::mean(&cast(&self.scene, &views))
    }

    fn detail(&self, coarseness: Coarseness) -> LevelOfDetail {
        LevelOfDetail::Resolved { resolution: self.array.resolution(), coarseness }
    }

    fn slabs(&self, view: &View, coarseness: Coarseness) -> Vec<Slab> {
        let detail = self.detail(coarseness);
        detail.slabs(view, &self.scene.parameters, detail.level_count(self.casters.len()))
    }

    fn cast(&self, view: &View, coarseness: Coarseness) -> Cast {
        let detail = self.detail(coarseness);
        self.slabs(view, coarseness).iter().fold(Cast::nothing(view.size), |front, slab| {
            let parameters = self.scene.parameters.of_level(slab.level);
            let caster = &self.casters[detail.sampled(slab.level)];
            caster.cast_behind(&parameters, &Aids::default(), &slab.part_of(view), front)
        })
    }

    /// Of the views that an eye sees anything of; nothing of the others.
    fn casts(&self, views: &[View], eye: &Eye, coarseness: Coarseness) -> Vec<Cast> {
        let is_seen =
            |index: usize| self.array.views_seen_from(eye).iter().flatten().any(|seen| seen.index == index);
        let cast = |(index, view): (usize, &View)| match is_seen(index) {
            true => self.cast(view, coarseness),
            false => Cast::nothing(view.size),
        };
        views.iter().enumerate().map(cast).collect()
    }

    /// What the virtual viewer's picture bears, where the volume is in it.
    fn coarseness(&self, display_from_world: DAffine3) -> Coarseness {
        let eye = Eye::new(self.array.virtual_viewer_m(), SIZE).unwrap();
        let world = |moved| eye.view(self.array.description().screen_size_m, moved * display_from_world);
        let rect =
            PixelRect::around(&world(DAffine3::IDENTITY), self.scene.parameters.visible_corners_world());
        let cut = |picture: &RgbImage| picture.cut([rect.columns.start, rect.rows.start], rect.size());
        let truth = cut(&self.of_beams(world));
        let views = self.array.views(display_from_world);
        let slabs = self.slabs(&views[12], Coarseness::ALL);
        let longest_step = slabs.iter().map(|slab| slab.level).max().unwrap();
        coarsest_alike(longest_step, |coarseness| {
            let casts = self.casts(&views, &eye, coarseness);
            let seen = cut(&self.array.seen_from(&eye, &over_black(&casts)).unwrap());
            let samples = casts.iter().map(|cast| cast.samples).sum();
            Ok::<_, SizeMismatch>(Tried { dssims: vec![compare(&seen, &truth)?.dssim()], samples })
        })
        .unwrap()
    }
}

#[test]
fn what_the_display_cannot_resolve_need_not_be_sampled() {
    // Shells that are thinner than two steps, of colours that depend on it: in full.
    for (phantom, most) in [
        (Phantom::Beetle, 0.65),
        (Phantom::MarschnerLobb, 0.65),
        (Phantom::Snake, 0.65),
        (Phantom::WireBox, 0.65),
        (Phantom::Orientation, 0.65),
        (Phantom::Present, 1.0),
        (Phantom::SheppLogan, 1.0),
    ] {
        matched_resolution(phantom, most);
    }
}

/// Casts a volume at the display's resolution: fewer samples, and to an eye hardly another picture.
fn matched_resolution(phantom: Phantom, most: f64) {
    let deep = Deep::new(&phantom.cube(128).unwrap());
    let Deep { array, scene, casters, .. } = &deep;
    let (resolution, views) = (array.resolution(), array.views(DAffine3::IDENTITY));
    let voxel_length_m = scene.parameters.voxel_length_m();
    let (near_m, far_m) = views[0].depths_m(&scene.parameters.visible_corners_world());
    let slabs = deep.slabs(&views[0], Coarseness::ALL);
    for slab in &slabs {
        let ends = [slab.depths_m.start.max(near_m), slab.depths_m.end.min(far_m)];
        let length_m = voxel_length_m * (slab.level as f64).exp2();
        let middle_m = 0.5 * (ends[0] + ends[1]);
        assert_eq!(resolution.level(middle_m, voxel_length_m, casters.len()), slab.level);
        let smallest_m = if ends[0] * ends[1] < 0.0 {
            resolution.size_m(0.0)
        } else {
            resolution.size_m(ends[0]).min(resolution.size_m(ends[1]))
        };
        assert!(
            slab.level == 0 || length_m <= smallest_m * (1.0 + 1e-9),
            "steps of {length_m} m where {smallest_m} m is resolved"
        );
    }
    assert!(slabs.windows(2).all(|pair| pair[0].depths_m.end == pair[1].depths_m.start));
    assert!(slabs.len() >= 3, "{slabs:?}");
    assert_eq!(RESOLVED_PIXELS, 0.5_f64.sqrt());
    let eye = Eye::new(array.virtual_viewer_m(), SIZE).unwrap();
    let coarseness = deep.coarseness(DAffine3::IDENTITY);
    let (full, matched) = (deep.casts(&views, &eye, Coarseness::NONE), deep.casts(&views, &eye, coarseness));
    let samples = |casts: &[Cast]| casts.iter().map(|cast| cast.samples).sum::<u64>() as f64;
    let of_samples = samples(&matched) / samples(&full);
    let screen_size_m = array.description().screen_size_m;
    for truth in [
        deep.truth(eye.view(screen_size_m, DAffine3::IDENTITY)),
        deep.of_beams(|moved| eye.view(screen_size_m, moved)),
    ] {
        let dssim = |casts: &[Cast]| {
            compare(&array.seen_from(&eye, &over_black(casts)).unwrap(), &truth).unwrap().dssim()
        };
        let (of_full, of_matched) = (dssim(&full), dssim(&matched));
        assert!(of_matched - of_full <= 0.005, "{phantom}: {of_matched} instead of {of_full}");
    }
    assert!(of_samples <= most, "{phantom}: {of_samples} of the samples");
}

/// A volume of 128³ bytes, each by its place.
fn textured(value: impl FnMut([usize; 3]) -> u8) -> Volume {
    let grid = Phantom::SheppLogan.cube(128).unwrap().grid().clone();
    let places = (0..128 * 128 * 128).map(|index| [index % 128, index / 128 % 128, index / (128 * 128)]);
    Volume::new(grid, Voxels::U8(places.map(value).collect())).unwrap()
}

#[test]
fn textures_beyond_the_field_of_depth_do_not_alias() {
    let mut state = 1_u32;
    let noise = |_| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let black_or_white = |is_white: bool| if is_white { 255 } else { 0 };
    for (name, volume) in [
        ("stripes", textured(|[x, ..]| black_or_white(x / 2 % 2 == 0))),
        ("checks", textured(|[x, y, z]| black_or_white((x / 2 + y / 2 + z / 2) % 2 == 0))),
        ("noise", textured(noise)),
    ] {
        let deep = Deep::new(&volume);
        let array = &deep.array;
        let behind = DAffine3::from_translation(DVec3::new(0.0, 0.0, -0.3));
        assert!(array.resolution().field_of_depth_m(deep.scene.parameters.voxel_length_m()) < 0.2);
        let views = array.views(behind);
        let coarseness = deep.coarseness(behind);
        for right_m in [-0.045, 0.0, 0.031] {
            let eye = Eye::new(array.virtual_viewer_m() + DVec3::X * right_m, SIZE).unwrap();
            let beams = deep.of_beams(|moved| eye.view(array.description().screen_size_m, moved * behind));
            let seen = |coarseness| {
                array.seen_from(&eye, &over_black(&deep.casts(&views, &eye, coarseness))).unwrap()
            };
            let (full, matched) = (seen(Coarseness::NONE), seen(coarseness));
            // The display cannot show the texture, so that what differs from place to place is not there.
            let [of_full, of_matched, of_beams] = [&full, &matched, &beams].map(contrast);
            let off = |picture| compare(picture, &beams).unwrap().dssim();
            assert!(of_full > 1.7 * of_beams, "{name}: {of_full} is that of no aliasing, {of_beams}");
            assert!(of_matched < 1.2 * of_beams, "{name}: {of_matched} instead of {of_beams}");
            assert!(off(&matched) < 0.6 * off(&full), "{name}: {} and {}", off(&matched), off(&full));
        }
    }
}

/// Standard deviation of green over its mean, in the middle of a picture.
fn contrast(picture: &RgbImage) -> f64 {
    let middle = picture.cut([30, 20], [20, 20]);
    let levels: Vec<f64> = middle.rgb.iter().map(|rgb| f64::from(rgb[1])).collect();
    let mean = levels.iter().sum::<f64>() / levels.len() as f64;
    let variance = levels.iter().map(|level| (level - mean).powi(2)).sum::<f64>() / levels.len() as f64;
    variance.sqrt() / mean
}

#[test]
fn a_volume_that_is_scaled_to_its_display_is_resolved_as_one_of_that_size() {
    let volume = Phantom::Beetle.cube(64).unwrap();
    let settings = Settings::new(volume.full_window(), soft());
    let array = display(24, 2.4, SIZE);
    let resolved = LevelOfDetail::Resolved { resolution: array.resolution(), coarseness: Coarseness::ALL };
    let slabs = |side_m: f64, scale: f64| {
        let scene = Scene::new(&volume, side_m, &settings);
        let view = array.views(DAffine3::from_scale(DVec3::splat(scale)))[3];
        resolved.slabs(&view, &scene.parameters, 4)
    };
    let (as_large, scaled) = (slabs(0.2, 1.0), slabs(1.0, 0.2));
    assert!(as_large.len() >= 3 && as_large.len() == scaled.len(), "{as_large:?} {scaled:?}");
    for (a, b) in as_large.iter().zip(&scaled) {
        let ends = [(a.depths_m.start, b.depths_m.start), (a.depths_m.end, b.depths_m.end)];
        assert!(
            a.level == b.level && ends.iter().all(|(a, b)| a == b || (a - b).abs() < 1e-9),
            "{a:?} {b:?}"
        );
    }
}

fn quilt_display() -> QuiltDisplay {
    QuiltDisplay { columns: 8, rows: 6, quilt_size_px: [8 * 60, 6 * 80], ..Model::Portrait.display() }
}

#[test]
fn an_eye_before_the_lenses_sees_the_view_of_its_place() {
    let display = quilt_display();
    let scene = head(0.1);
    let views = display.views(Sampling::Middles, DAffine3::IDENTITY);
    let pictures = cast(&scene, &views);
    for index in [0_usize, 13, 24, 47] {
        let eye =
            Eye::new(views[index].view_from_world.inverse().translation, display.tile_size_px()).unwrap();
        let seen = display.seen_from(&eye, &pictures).unwrap();
        let most = seen
            .rgb
            .iter()
            .flatten()
            .zip(pictures[index].rgb.iter().flatten())
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f32::max);
        assert!(most < 1e-5, "view {index}: {most}");
    }
    let eye =
        Eye::new(DVec3::new(0.02, 0.0, 1.2 * display.focal_distance_m), display.tile_size_px()).unwrap();
    let truth = cast(&scene, &[eye.view(display.screen_size_m(), DAffine3::IDENTITY)]).remove(0);
    let dssim = compare(&display.seen_from(&eye, &pictures).unwrap(), &truth).unwrap().dssim();
    assert!(dssim < 0.02, "from further away: {dssim}");
}

#[test]
fn through_real_lenses_much_the_same_is_seen() {
    let display = quilt_display();
    let calibration = r#"{"pitch":52.6,"slope":-7.08,"center":0.43,"DPI":324,"screenW":384,"screenH":512}"#;
    let straight = Lenticular::from_visual_json(calibration).unwrap();
    // Not at its middle: neither its left and right nor its top and bottom are alike.
    let scene = head(0.1);
    let views = display.views(Sampling::Middles, DAffine3::from_translation(DVec3::new(0.01, 0.015, 0.0)));
    let pictures = cast(&scene, &views);
    let quilt = display.quilt(&pictures).unwrap();
    let flips =
        [[false; 3], [true, false, false], [false, true, false], [true, true, false], [true, false, true]];
    for [flips_x, flips_y, flips_subpixels] in flips {
        let lenses = Lenticular { flips_x, flips_y, flips_subpixels, ..straight.clone() };
        let picture = lenses.interlace(&display, &quilt).unwrap();
        let seen_at = |x_m: f64| {
            let eye =
                Eye::new(DVec3::new(x_m, 0.0, display.focal_distance_m), display.tile_size_px()).unwrap();
            (lenses.seen_from(&eye, &display, &picture).unwrap(), display.seen_from(&eye, &pictures).unwrap())
        };
        let (other, _) = seen_at(-0.1);
        for x_m in [-0.05, 0.0, 0.07] {
            let (through_lenses, ideally) = seen_at(x_m);
            let dssim = compare(&through_lenses, &ideally).unwrap().dssim();
            assert!(dssim < 0.02, "{x_m} m to the right of {lenses:?}: {dssim}");
            let from_elsewhere = compare(&other, &ideally).unwrap().dssim();
            assert!(
                dssim < 0.8 * from_elsewhere,
                "{x_m} m to the right of {lenses:?}: {dssim}, from elsewhere {from_elsewhere}"
            );
        }
    }
}

#[test]
fn highlights_and_what_is_clear_go_with_the_eye() {
    let display = QuiltDisplay {
        columns: 5,
        rows: 1,
        quilt_size_px: [5 * SIZE[0], SIZE[1]],
        aspect: 4.0 / 3.0,
        view_cone_deg: 40.0,
        focal_distance_m: 0.6,
        screen_height_m: 0.15,
    };
    let views = display.views(Sampling::Middles, DAffine3::IDENTITY);
    let volume = Phantom::SheppLogan.cube(48).unwrap();
    let styles = [Style::Metal, Style::Glass].map(|style| Shading::LitSphere { low: style, high: style });
    for shading in [Shading::Phong].into_iter().chain(styles) {
        let scene = Scene::new(&volume, 0.12, &Settings { shading, ..Settings::new(byte_window(), soft()) });
        let pictures = cast(&scene, &views);
        let eye_m = views[0].view_from_world.inverse().translation;
        let eye = Eye::new(eye_m, SIZE).unwrap();
        let seen = display.seen_from(&eye, &pictures).unwrap();
        let truth = eye.view(display.screen_size_m(), DAffine3::IDENTITY);
        let shaded_from = Some(views[2].viewpoint());
        let [truth, from_middle] =
            [truth, View { shaded_from, ..truth }].map(|view| cast(&scene, &[view]).remove(0));
        let dssim = |other: &RgbImage| compare(&seen, other).unwrap().dssim();
        assert!(
            dssim(&truth) < 1e-5 && dssim(&from_middle) > 1e-3,
            "{shading:?}: {} {}",
            dssim(&truth),
            dssim(&from_middle)
        );
    }
}
