//! The images of projectors at the resolution of their display.

use super::{Engine, Shot};
use crate::failure::Failure;
use crate::skipping::Skipping;
use glam::DAffine3;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::image::RgbImage;
use wheatstone_core::lightfield::simulator::{Eye, SeenParts};
use wheatstone_core::lightfield::{Coarseness, ProjectorArray, Tried, coarsest_alike};
use wheatstone_core::metrics::compare;
use wheatstone_core::view::{PixelRect, View};

/// Rays of each beam of the truth.
const BEAM_RAYS: u32 = 8;

/// Pictures of a turntable that are tried.
const TRIED_TURNS: usize = 3;

/// A shot at the resolution of a display.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ResolvedShot {
    pub(crate) shot: Shot,
    pub(crate) coarseness: Coarseness,
}

impl ResolvedShot {
    pub(crate) fn in_full(shot: Shot) -> Self {
        Self { shot, coarseness: Coarseness::NONE }
    }
}

/// What the virtual viewer sees of a volume on a display.
struct Sight {
    /// Of each projector, the columns that it sees; none of those that it does not.
    views: Vec<Option<View>>,
    parts: SeenParts,
    /// The part of its picture that the volume can be in.
    rect: PixelRect,
    /// That part, as far as beams can show it.
    truth: RgbImage,
}

impl Engine<'_> {
    /// As [`Engine::prepare_detail`] for the views of a display's projectors, as coarsely as what the virtual viewer sees bears
    /// ([`coarsest_alike`]), with the world in some places before the display, of which a few are tried.
    pub(crate) fn prepare_resolved(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        array: &ProjectorArray,
        displays_from_world: &[DAffine3],
    ) -> Result<ResolvedShot, Failure> {
        let full = ResolvedShot::in_full(self.prepare(parameters, skipping)?);
        let turns = displays_from_world.len();
        let tried_turns = turns.min(TRIED_TURNS);
        let tried = (0..tried_turns).map(|turn| displays_from_world[turn * turns / tried_turns]);
        let mut sights = Vec::new();
        for display_from_world in tried {
            sights.extend(self.sight(full.shot, parameters, array, display_from_world)?);
        }
        let resolution = array.resolution();
        let all = LevelOfDetail::Resolved { resolution, coarseness: Coarseness::ALL };
        let level_count = all.level_count(self.level_count());
        let slabs = sights
            .iter()
            .flat_map(|sight| sight.views.iter().flatten())
            .flat_map(|view| all.slabs(view, parameters, level_count));
        let longest_step = slabs.map(|slab| slab.level).max().unwrap_or(0);
        let mut shots = vec![full];
        let chosen = coarsest_alike(longest_step, |coarseness| {
            if coarseness != Coarseness::NONE {
                let resolved = LevelOfDetail::Resolved { resolution, coarseness };
                let shot = self.prepare_detail(parameters, skipping, resolved)?;
                shots.push(ResolvedShot { shot, coarseness });
            }
            let shot = shots[shots.len() - 1].shot;
            let mut tried = Tried { dssims: Vec::new(), samples: 0 };
            for sight in &sights {
                let (picture, samples) = self.seen(shot, sight)?;
                tried.dssims.push(compare(&picture, &sight.truth).map_err(Failure::input)?.dssim());
                tried.samples += samples;
            }
            Ok::<_, Failure>(tried)
        })?;
        Ok(shots.into_iter().find(|tried| tried.coarseness == chosen).unwrap_or(full))
    }

    /// What the virtual viewer sees of the volume, if anything.
    fn sight(
        &mut self,
        full: Shot,
        parameters: &CastParameters,
        array: &ProjectorArray,
        display_from_world: DAffine3,
    ) -> Result<Option<Sight>, Failure> {
        let description = array.description();
        let [_, height] = description.image_size_px;
        let eye = Eye::new(array.virtual_viewer_m(), description.image_size_px).map_err(Failure::input)?;
        let world = |moved: DAffine3| eye.view(description.screen_size_m, moved * display_from_world);
        let parts = array.parts_seen_from(&eye);
        let around = PixelRect::around(&world(DAffine3::IDENTITY), parameters.visible_corners_world());
        let rect = around.within(&PixelRect { columns: parts.lit_columns(), rows: 0..height });
        if rect.is_empty() {
            return Ok(None);
        }
        let beams = array.resolution().beam(BEAM_RAYS);
        let truth = self.mean(full, beams.map(|moved| world(moved).part(&rect)))?;
        let columns_of = |(view, columns): (View, &std::ops::Range<u32>)| {
            (!columns.is_empty()).then(|| view.part(&PixelRect { columns: columns.clone(), rows: 0..height }))
        };
        let views =
            array.views(display_from_world).into_iter().zip(parts.columns()).map(columns_of).collect();
        Ok(Some(Sight { views, parts, rect, truth }))
    }

    /// The part of the virtual viewer's picture that the volume can be in, and the samples that it took.
    fn seen(&mut self, shot: Shot, sight: &Sight) -> Result<(RgbImage, u64), Failure> {
        let mut samples = 0;
        let mut images = Vec::with_capacity(sight.views.len());
        for view in &sight.views {
            images.push(match view {
                Some(view) => {
                    let (image, of_image) = self.pictured(shot, view)?;
                    samples += of_image;
                    image
                }
                None => RgbImage { width: 0, height: 0, rgb: Vec::new() },
            });
        }
        let PixelRect { columns, rows } = &sight.rect;
        let picture = sight.parts.picture(&images).cut([columns.start, rows.start], sight.rect.size());
        Ok((picture, samples))
    }
}
