//! How a picture is shown from elsewhere, and how finely.

use super::super::state::WarpName;
use super::BeyondReach;
use glam::DVec3;
use wheatstone_core::budget::Quality;
use wheatstone_core::view::{Frustum, PixelRect, Projection, View};
use wheatstone_core::warp::{MOST_GRID_STEPS, Overlap, VolumetricSettings};
use wheatstone_render::Gpu;
use wheatstone_render::live::Front;

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

/// How a picture is shown, and how finely.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Way {
    AsItIs,
    Quad(Quality),
    Grid(Quality),
    Volumetric(Quality),
}

impl Way {
    /// In words.
    pub(super) fn described(self) -> String {
        let warped = |warp: WarpName, quality: Quality| {
            format!("{} warp at {:.0} %", warp.name(), 100.0 * quality.resolution())
        };
        match self {
            Self::AsItIs => "as it is".to_owned(),
            Self::Quad(quality) => warped(WarpName::Quad, quality),
            Self::Grid(quality) => warped(WarpName::Grid, quality),
            Self::Volumetric(quality) => warped(WarpName::Volumetric, quality),
        }
    }
}

/// What there is to warp, and what a refresh has time for.
#[derive(Debug, Clone)]
pub(super) struct Means {
    pub(super) quality: Quality,
    /// Of what may be in the picture.
    pub(super) corners: [DVec3; 8],
    pub(super) keeps_layers: bool,
    /// How rays step through layers.
    pub(super) stepping: VolumetricSettings,
    pub(super) most_steps: f64,
    pub(super) beyond_reach: BeyondReach,
}

impl Means {
    /// Those of a refresh.
    pub(super) fn of(
        gpu: &Gpu,
        front: &Front,
        stepping: VolumetricSettings,
        beyond_reach: BeyondReach,
    ) -> Self {
        Self {
            quality: front.quality(),
            corners: front.prepared().occupied_corners_world(),
            keeps_layers: front.prepared().keeps_layers(),
            stepping,
            most_steps: most_steps(gpu),
            beyond_reach,
        }
    }

    /// Those of each of some eyes.
    pub(super) fn shared(self, eyes: usize) -> Self {
        Self { most_steps: self.most_steps / eyes.max(1) as f64, ..self }
    }

    /// Those of as many refreshes as it takes, of a picture than which none from nearer will come.
    pub(super) fn at_rest(&self) -> Self {
        Self { most_steps: f64::INFINITY, beyond_reach: BeyondReach::Warped, ..self.clone() }
    }

    /// The way that is asked for, or what of it there is time for: the grid is searched, and layers are passed, pixel by pixel
    /// along as many pixels as surfaces may have moved. Layers that take too long however coarsely give way to the grid.
    pub(super) fn way(&self, shown: &View, wanted: &View, warp: WarpName) -> Way {
        let overlap = Overlap::of(shown, wanted, &self.corners);
        match warp {
            WarpName::None => Way::AsItIs,
            _ if self.beyond_reach == BeyondReach::AsItIs && !is_within_reach(overlap, warp) => Way::AsItIs,
            // From where it was cast a picture is the same by any warp.
            _ if warp == WarpName::Quad || moved_m(shown, wanted) == 0.0 => Way::Quad(self.quality),
            _ => {
                let layers: Option<fn(Quality) -> Way> =
                    (warp == WarpName::Volumetric && self.keeps_layers).then_some(Way::Volumetric);
                let coarser = || (self.quality.level()..=Quality::COARSEST.level()).map(Quality::at);
                let ways = layers.into_iter().chain([Way::Grid as fn(Quality) -> Way]);
                let mut ways = ways.flat_map(|way| coarser().map(way));
                let too_slow = match self.beyond_reach {
                    BeyondReach::AsItIs => Way::AsItIs,
                    BeyondReach::Warped => Way::Quad(self.quality),
                };
                ways.find(|&way| self.steps(shown, wanted, way) <= self.most_steps).unwrap_or(too_slow)
            }
        }
    }

    /// What a way takes, steps of the search for surfaces.
    fn steps(&self, shown: &View, wanted: &View, way: Way) -> f64 {
        let (Way::Grid(quality) | Way::Volumetric(quality)) = way else { return 0.0 };
        let covered = self.covered(&View { size: quality.size(wanted.size), ..*wanted });
        covered.rows.len() as f64 * self.steps_of_row(shown, wanted, way, &covered)
    }

    /// The same of a row of pixels.
    pub(super) fn steps_of_row(&self, shown: &View, wanted: &View, way: Way, covered: &PixelRect) -> f64 {
        let columns = columns_moved(shown, moved_m(shown, wanted), &self.corners).max(1.0);
        let of_pixel = match way {
            Way::AsItIs | Way::Quad(_) => 1.0,
            Way::Grid(_) => columns.min(f64::from(MOST_GRID_STEPS)),
            Way::Volumetric(_) => columns.min(f64::from(self.stepping.most_steps)) * STEPS_OF_LAYERS,
        };
        covered.columns.len() as f64 * of_pixel
    }

    /// The pixels of a view that may show something.
    pub(super) fn covered(&self, view: &View) -> PixelRect {
        PixelRect::around(view, self.corners)
    }
}

/// What a device has time for in a refresh.
pub(super) fn most_steps(gpu: &Gpu) -> f64 {
    if gpu.description().is_software { MOST_STEPS_ON_CPU } else { f64::INFINITY }
}

/// Whether a warp shows much of what is wanted.
fn is_within_reach(overlap: Overlap, warp: WarpName) -> bool {
    let furthest_deg =
        if warp == WarpName::Volumetric { FURTHEST_TURN_OF_LAYERS_DEG } else { FURTHEST_TURN_DEG };
    overlap.turn_rad.to_degrees() <= furthest_deg && overlap.share >= LEAST_SHARE
}

/// What a picture of the shape of the wanted one shows of the shown view, in its middle and neither squeezed nor stretched.
pub(super) fn as_it_is(shown: &View, wanted: &View, quality: Quality) -> View {
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

fn moved_m(shown: &View, wanted: &View) -> f64 {
    (eye_m(shown) - eye_m(wanted)).length()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::state::{Arrangement, Camera, Edit, Face, State};

    /// On hardware.
    fn means(beyond_reach: BeyondReach) -> Means {
        let corners = std::array::from_fn(|corner| {
            DVec3::from([1, 2, 4].map(|axis| if corner & axis == 0 { -0.5 } else { 0.5 }))
        });
        Means {
            quality: Quality::FULL,
            corners,
            keeps_layers: true,
            stepping: VolumetricSettings::default(),
            most_steps: f64::INFINITY,
            beyond_reach,
        }
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
    fn layers_that_take_too_long_give_way_to_the_grid_and_at_rest_nothing_takes_too_long() {
        let mut state = State::default();
        state.stereo.arrangement = Arrangement::SideBySide;
        let shown = state.camera.view([485, 720]).unwrap();
        for wanted in state.stereo.views(&shown, state.camera.distance_m) {
            let steps = |way| means(BeyondReach::AsItIs).steps(&shown, &wanted, way);
            let [layers, grid] = [Way::Volumetric, Way::Grid as fn(Quality) -> Way]
                .map(|way| [Quality::FULL, Quality::COARSEST].map(|quality| steps(way(quality))));
            assert!(layers[1] > grid[1] && layers[1] < layers[0] && grid[1] < grid[0]);
            let cases = [
                (layers[0], WarpName::Volumetric, Way::Volumetric(Quality::FULL)),
                (layers[1], WarpName::Volumetric, Way::Volumetric(Quality::COARSEST)),
                (grid[1], WarpName::Volumetric, Way::Grid(Quality::COARSEST)),
                (grid[0], WarpName::Grid, Way::Grid(Quality::FULL)),
                (grid[1], WarpName::Grid, Way::Grid(Quality::COARSEST)),
                (0.9 * grid[1], WarpName::Grid, Way::AsItIs),
            ];
            for (most_steps, warp, way) in cases {
                let means = Means { most_steps, ..means(BeyondReach::AsItIs) };
                assert_eq!(means.way(&shown, &wanted, warp), way, "{most_steps}");
                let at_rest = means.at_rest().way(&shown, &wanted, warp);
                let full = WARPS.iter().find(|(other, _)| *other == warp).unwrap().1;
                assert_eq!(at_rest, full, "{most_steps}");
            }
        }
    }

    #[test]
    fn at_rest_eyes_far_apart_are_shown_what_there_is_of_both() {
        let view = after(&[]);
        let far = after(&[Edit::Orbit { right_deg: 60.0, up_deg: 0.0 }]);
        assert_eq!(means(BeyondReach::AsItIs).way(&view, &far, WarpName::Grid), Way::AsItIs);
        let at_rest = means(BeyondReach::AsItIs).at_rest();
        assert_eq!(at_rest.way(&view, &far, WarpName::Grid), Way::Grid(Quality::FULL));
    }

    #[test]
    fn it_is_told_how_finely_a_picture_is_warped() {
        assert_eq!(Way::Grid(Quality::FULL).described(), "grid warp at 100 %");
        assert_eq!(Way::Volumetric(Quality::at(3)).described(), "volumetric warp at 50 %");
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
