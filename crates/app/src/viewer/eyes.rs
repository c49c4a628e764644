//! What each eye is shown: the newest whole picture, as it looks from where the eye is now.

use super::canvas;
use super::lens::Lens;
use super::novel_views::NovelViews;
use super::state::WarpName;
use crate::failure::Failure;
use glam::DVec3;
use wheatstone_core::budget::Quality;
use wheatstone_core::headset::HiddenArea;
use wheatstone_core::view::{Frustum, PixelRect, Projection, View};
use wheatstone_core::warp::{GridSettings, Overlap, VolumetricSettings, WarpError};
use wheatstone_render::live::Front;
use wheatstone_render::warp::{Canvas, Shown, Warps};
use wheatstone_render::{Gpu, GpuError};

/// Of warped pictures: what a display shows, and what is interpolated fastest.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Most steps of the search for surfaces that software Vulkan has time for in a refresh: 3 to 5 ns each on two cores.
const MOST_STEPS_ON_CPU: f64 = 4e6;

/// How many such steps a step through layers takes the time of.
const STEPS_OF_LAYERS: f64 = 8.0;

/// Turn of what is looked at from which on the grid shows less than half of it, degrees; so measured on phantoms.
const FURTHEST_TURN_DEG: f64 = 35.0;

/// Turn from which on layers of opaque surfaces show less than two thirds of them, degrees; so measured on phantoms.
const FURTHEST_TURN_OF_LAYERS_DEG: f64 = 50.0;

/// Part of what is wanted that must be in the shown picture.
const LEAST_SHARE: f64 = 0.25;

/// Nearest depth that counts for how far surfaces move, metres.
const NEAREST_M: f64 = 0.05;

/// Warps to the eyes of a rig.
pub(crate) struct Eyes {
    warps: Warps,
    /// Made when first asked for.
    novel_views: Option<NovelViews>,
    pictures: Vec<Canvas>,
    lenses: [Lens; 2],
    shown: Option<Wanted>,
    beyond_reach: BeyondReach,
    /// How rays step through layers.
    stepping: VolumetricSettings,
}

/// What tells one pair of pictures from another.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Wanted {
    /// Counts the pictures that have been cast.
    pub(crate) picture: u64,
    /// What the eyes see, the left one first.
    pub(crate) views: Vec<View>,
    pub(crate) warp: WarpName,
}

/// What is shown for as long as no picture is from near enough for a warp to show much of what is wanted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BeyondReach {
    /// The picture as it is: of a window.
    AsItIs,
    /// What there is of it where it belongs: of a headset, where anything else would go with the head.
    Warped,
}

/// How a picture is shown, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    AsItIs,
    Quad(Quality),
    Grid(Quality),
    Volumetric(Quality),
}

/// What there is to warp, and what a refresh has time for.
struct Means {
    quality: Quality,
    /// Of what may be in the picture.
    corners: [DVec3; 8],
    keeps_layers: bool,
    most_steps: f64,
    beyond_reach: BeyondReach,
}

impl Means {
    fn of(gpu: &Gpu, front: &Front, beyond_reach: BeyondReach) -> Self {
        Self {
            quality: front.quality(),
            corners: front.prepared().parameters().occupied_corners_world(),
            keeps_layers: front.prepared().keeps_layers(),
            most_steps: if gpu.description().is_software { MOST_STEPS_ON_CPU } else { f64::INFINITY },
            beyond_reach,
        }
    }

    /// The way that is asked for, or what of it there is time for: the grid is searched, and layers are passed, pixel by pixel
    /// along as many pixels as surfaces may have moved.
    fn way(&self, shown: &View, wanted: &View, warp: WarpName) -> Way {
        let moved_m = (eye_m(shown) - eye_m(wanted)).length();
        let overlap = Overlap::of(shown, wanted, &self.corners);
        match warp {
            WarpName::None => Way::AsItIs,
            _ if self.beyond_reach == BeyondReach::AsItIs && !is_within_reach(overlap, warp) => Way::AsItIs,
            // From where it was cast a picture is the same by any warp.
            _ if warp == WarpName::Quad || moved_m == 0.0 => Way::Quad(self.quality),
            _ => {
                let (way, cost): (fn(Quality) -> Way, f64) =
                    if warp == WarpName::Volumetric && self.keeps_layers {
                        (Way::Volumetric, STEPS_OF_LAYERS)
                    } else {
                        (Way::Grid, 1.0)
                    };
                let columns = columns_moved(shown, moved_m, &self.corners);
                let steps = |quality: &Quality| {
                    quality.size(wanted.size).map(f64::from).iter().product::<f64>() * columns.max(1.0) * cost
                };
                let coarser = (self.quality.level()..=Quality::COARSEST.level()).map(Quality::at);
                let too_slow = match self.beyond_reach {
                    BeyondReach::AsItIs => Way::AsItIs,
                    BeyondReach::Warped => Way::Quad(self.quality),
                };
                coarser.into_iter().find(|quality| steps(quality) <= self.most_steps).map_or(too_slow, way)
            }
        }
    }
}

/// Whether a warp shows much of what is wanted.
fn is_within_reach(overlap: Overlap, warp: WarpName) -> bool {
    let furthest_deg =
        if warp == WarpName::Volumetric { FURTHEST_TURN_OF_LAYERS_DEG } else { FURTHEST_TURN_DEG };
    overlap.turn_rad.to_degrees() <= furthest_deg && overlap.share >= LEAST_SHARE
}

/// What a picture of the shape of the wanted one shows of the shown view, in its middle and neither squeezed nor stretched.
fn as_it_is(shown: &View, wanted: &View, quality: Quality) -> View {
    let projection = match (shown.projection, wanted.projection) {
        (Projection::Perspective(from), Projection::Perspective(to)) => {
            let half_width = 0.5 * (from.up - from.down) * (to.right - to.left) / (to.up - to.down);
            let middle = 0.5 * (from.left + from.right);
            Projection::Perspective(Frustum { left: middle - half_width, right: middle + half_width, ..from })
        }
        (projection, _) => projection,
    };
    View { projection, size: quality.size(wanted.size), ..*shown }
}

fn eye_m(view: &View) -> DVec3 {
    view.view_from_world.inverse().translation
}

/// How far what is nearest moves at most when the eye does, pixels.
fn columns_moved(shown: &View, moved_m: f64, corners: &[DVec3]) -> f64 {
    let nearest_m = shown.depths_m(corners).0.max(NEAREST_M);
    match shown.projection {
        Projection::Perspective(lens) => {
            f64::from(shown.size[0]) / (lens.right - lens.left) * moved_m / nearest_m
        }
        Projection::Orthographic(_) | Projection::Mcop(_) => 0.0,
    }
}

impl Eyes {
    /// Eyes that never see a picture as it is, unless that is asked for.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Failure> {
        let warps = Warps::new(gpu, FORMAT)?;
        let beyond_reach = BeyondReach::Warped;
        Ok(Self {
            warps,
            novel_views: None,
            pictures: Vec::new(),
            lenses: Default::default(),
            shown: None,
            beyond_reach,
            stepping: VolumetricSettings::default(),
        })
    }

    /// From now on rays step so through layers.
    pub(crate) fn step_by(&mut self, stepping: VolumetricSettings) {
        if self.stepping != stepping {
            (self.stepping, self.shown) = (stepping, None);
        }
    }

    /// From now on lenses hide something of what the left and the right eye are shown: it is left out.
    pub(crate) fn hide(&mut self, hidden: &[HiddenArea; 2]) {
        for (lens, hidden) in self.lenses.iter_mut().zip(hidden) {
            if lens.hide(hidden) {
                self.shown = None;
            }
        }
    }

    /// The same with something else beyond the reach of warps.
    pub(crate) fn beyond_reach(self, beyond_reach: BeyondReach) -> Self {
        Self { beyond_reach, ..self }
    }

    /// The pictures of the left and the right eye (the same twice where there is one), as finely as the front picture is
    /// cast. Submits what draws them, unless they are what was wanted last.
    pub(crate) fn show(
        &mut self,
        gpu: &Gpu,
        front: &Front,
        wanted: Wanted,
    ) -> Result<Option<[wgpu::TextureView; 2]>, Failure> {
        if self.shown.as_ref() != Some(&wanted) {
            self.shown = None;
            if let Err(error) = self.draw(gpu, front, &wanted) {
                self.pictures.clear();
                return Err(error);
            }
            self.shown = Some(wanted);
        }
        let mut eyes = self.pictures.iter().map(Canvas::view);
        Ok(eyes.next().map(|left| [left.clone(), eyes.next().unwrap_or(left).clone()]))
    }

    /// The pixels of an eye's picture outside of which it is empty, if it were of a size.
    pub(crate) fn drawn(&self, eye: usize, size: [u32; 2]) -> PixelRect {
        let canvas = self.pictures.get(eye).or(self.pictures.last());
        let drawn = canvas.and_then(|canvas| Some(canvas.drawn()?.stretched(canvas.size(), size)));
        drawn.unwrap_or(PixelRect { columns: 0..size[0], rows: 0..size[1] })
    }

    fn draw(&mut self, gpu: &Gpu, front: &Front, wanted: &Wanted) -> Result<(), Failure> {
        let sources: Vec<_> = front.pictures().collect();
        let Some(last) = sources.len().checked_sub(1) else { return Ok(()) };
        let means = Means::of(gpu, front, self.beyond_reach);
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pictures.truncate(wanted.views.len());
        for (eye, &view) in wanted.views.iter().enumerate() {
            let source = eye.min(last);
            let (target, cast_from) = sources[source];
            let shown = Shown::new(target, cast_from, front.prepared());
            let way = means.way(&cast_from, &view, wanted.warp);
            let view = match way {
                Way::AsItIs => as_it_is(&cast_from, &view, means.quality),
                Way::Quad(quality) | Way::Grid(quality) | Way::Volumetric(quality) => {
                    View { size: quality.size(view.size), ..view }
                }
            };
            let mut into = self.take_picture(gpu, eye, view.size)?;
            if let (Some(lens), Projection::Perspective(frustum)) =
                (self.lenses.get_mut(eye), view.projection)
            {
                into.show_only(lens.visible(&frustum, view.size));
            }
            match way {
                Way::AsItIs | Way::Quad(_) => self.warps.quad(gpu, &mut encoder, &shown, &view, &mut into),
                Way::Grid(_) => {
                    self.warps.grid(gpu, &mut encoder, &shown, &view, GridSettings::default(), &mut into)
                }
                Way::Volumetric(_) => {
                    let stepping = self.stepping;
                    let novel_views = self.novel_views(gpu)?;
                    novel_views.follow(gpu, &mut encoder, front, wanted.picture)?;
                    novel_views.encode(gpu, &mut encoder, (source, &shown), &view, &stepping, &mut into)
                }
            }
            .map_err(|error: WarpError| Failure::Internal(error.into()))?;
            self.pictures.insert(eye, into);
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(gpu.check()?)
    }

    fn novel_views(&mut self, gpu: &Gpu) -> Result<&mut NovelViews, Failure> {
        match self.novel_views.take() {
            Some(novel_views) => Ok(self.novel_views.insert(novel_views)),
            None => Ok(self.novel_views.insert(NovelViews::new(gpu, FORMAT)?)),
        }
    }

    /// Room for an eye's picture: that of the last one if it has the size.
    fn take_picture(&mut self, gpu: &Gpu, eye: usize, size: [u32; 2]) -> Result<Canvas, Failure> {
        let kept = (eye < self.pictures.len()).then(|| self.pictures.remove(eye));
        if let Some(kept) = kept.filter(|kept| kept.size() == size) {
            return Ok(kept);
        }
        Ok(room(gpu, size, FORMAT)?)
    }
}

/// Something that warps are drawn to and passes sample.
pub(crate) fn room(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat) -> Result<Canvas, GpuError> {
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
    let texture = canvas::texture_for(gpu, "warped", size, format, usage)?;
    Ok(Canvas::new(texture.create_view(&wgpu::TextureViewDescriptor::default())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::{Camera, Edit, Face, State};

    /// On hardware.
    fn means(beyond_reach: BeyondReach) -> Means {
        let corners = std::array::from_fn(|corner| {
            DVec3::from([1, 2, 4].map(|axis| if corner & axis == 0 { -0.5 } else { 0.5 }))
        });
        Means { quality: Quality::FULL, corners, keeps_layers: true, most_steps: f64::INFINITY, beyond_reach }
    }

    fn after(edits: &[Edit]) -> View {
        let mut state = State::default();
        edits.iter().for_each(|edit| state.apply(edit).unwrap());
        state.camera.view([480, 260]).unwrap()
    }

    const WARPS: [(WarpName, Way); 3] = [
        (WarpName::Quad, Way::Quad(Quality::FULL)),
        (WarpName::Grid, Way::Grid(Quality::FULL)),
        (WarpName::Volumetric, Way::Volumetric(Quality::FULL)),
    ];

    #[test]
    fn what_is_seen_from_another_side_or_was_out_of_the_picture_is_not_warped_in_a_window() {
        let orbit = |right_deg| Edit::Orbit { right_deg, up_deg: 0.0 };
        let cases = [
            (vec![Edit::Face(Face::Back)], vec![Edit::Face(Face::Right)]),
            (vec![Edit::Face(Face::Right)], vec![Edit::Face(Face::Left)]),
            (vec![], vec![orbit(60.0)]),
            (vec![Edit::Turn { right_deg: 60.0, up_deg: 0.0 }], vec![]),
            (vec![Edit::Zoom(9.0)], vec![]),
        ];
        for (before, now) in &cases {
            let (shown, wanted) = (after(before), after(now));
            for (warp, way) in WARPS {
                let in_window = means(BeyondReach::AsItIs).way(&shown, &wanted, warp);
                assert_eq!(in_window, Way::AsItIs, "{before:?} {now:?} {warp:?}");
                let in_headset = means(BeyondReach::Warped).way(&shown, &wanted, warp);
                assert!(in_headset == way || in_headset == Way::Quad(Quality::FULL), "{in_headset:?}");
            }
        }
    }

    #[test]
    fn what_moves_partly_out_of_the_picture_is_warped() {
        let cases = [
            Edit::Orbit { right_deg: 25.0, up_deg: 10.0 },
            Edit::Fly { right_m: 0.1, up_m: 0.1, forward_m: 0.8 },
            Edit::Zoom(1.5),
            Edit::Pan { right: 0.3, up: 0.2 },
        ];
        for edit in cases {
            let (shown, wanted) = (after(&[]), after(std::slice::from_ref(&edit)));
            for (warp, way) in WARPS {
                for (shown, wanted) in [(shown, wanted), (wanted, shown)] {
                    assert_eq!(means(BeyondReach::AsItIs).way(&shown, &wanted, warp), way, "{edit:?}");
                }
            }
        }
        let turned = after(&[Edit::Turn { right_deg: 15.0, up_deg: 5.0 }]);
        let way = means(BeyondReach::AsItIs).way(&after(&[]), &turned, WarpName::Quad);
        assert_eq!(way, Way::Quad(Quality::FULL));
    }

    #[test]
    fn a_picture_of_another_shape_is_neither_squeezed_nor_moved() {
        let mut state = State::default();
        let view = |state: &State, size| state.camera.view(size).unwrap();
        let mono = view(&state, [480, 260]);
        state.apply(&Edit::Orbit { right_deg: 90.0, up_deg: 0.0 }).unwrap();
        let shown_in_half = as_it_is(&mono, &view(&state, [240, 260]), Quality::FULL);
        assert_eq!(shown_in_half.size, [240, 260]);
        for point in [DVec3::ZERO, DVec3::new(0.2, 0.1, 0.0), DVec3::new(-0.1, 0.3, 0.2)] {
            let [before, now] = [mono, shown_in_half].map(|view| view.pixel_position(point).unwrap());
            assert!((before - now).distance(glam::DVec2::new(120.0, 0.0)) < 1e-9, "{before} {now}");
        }
        let coarse = as_it_is(&mono, &view(&state, [480, 260]), Quality::at(3));
        assert_eq!((coarse.size, coarse.projection), ([240, 130], mono.projection));
    }

    #[test]
    fn what_takes_too_long_is_a_quad_in_a_headset() {
        for (beyond_reach, way) in
            [(BeyondReach::AsItIs, Way::AsItIs), (BeyondReach::Warped, Way::Quad(Quality::FULL))]
        {
            let slow = Means { most_steps: 10.0, ..means(beyond_reach) };
            assert_eq!(slow.way(&after(&[]), &after(&[Edit::Zoom(1.1)]), WarpName::Grid), way);
        }
    }

    #[test]
    fn surfaces_move_by_as_much_as_the_nearest_does() {
        let view = Camera::default().view([400, 300]).unwrap();
        let world_from_view = view.view_from_world.inverse();
        let corners = [-2.0, -1.0].map(|z| world_from_view.transform_point3(DVec3::new(0.0, 0.0, z)));
        let Projection::Perspective(lens) = view.projection else { unreachable!() };
        let expected = 0.1 / (lens.right - lens.left) * 400.0;
        assert!((columns_moved(&view, 0.1, &corners) - expected).abs() < 1e-9);
        assert_eq!(columns_moved(&view, 0.0, &corners), 0.0);
    }
}
