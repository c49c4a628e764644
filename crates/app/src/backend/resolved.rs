//! The images of projectors at the resolution of their display.

use super::{Engine, Shot};
use crate::failure::Failure;
use crate::skipping::Skipping;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::lightfield::{Coarseness, Resolution, coarsest_alike};
use wheatstone_core::metrics::compare;
use wheatstone_core::view::View;

/// Rays of each beam of the truth.
const BEAM_RAYS: u32 = 8;

/// A shot at the resolution of a display.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ResolvedShot {
    pub(crate) shot: Shot,
    pub(crate) coarseness: Coarseness,
}

impl Engine<'_> {
    /// As [`Engine::prepare_detail`] for the views of a display's projectors, as coarsely as the picture of the one in the middle bears
    /// ([`coarsest_alike`]).
    pub(crate) fn prepare_resolved(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        resolution: Resolution,
        views: &[View],
    ) -> Result<ResolvedShot, Failure> {
        let full = ResolvedShot { shot: self.prepare(parameters, skipping)?, coarseness: Coarseness::NONE };
        let Some(view) = views.get(views.len() / 2) else { return Ok(full) };
        let moved = |by| View { view_from_world: by * view.view_from_world, ..*view };
        let truth = self.mean(full.shot, resolution.beam(BEAM_RAYS).map(moved))?;
        let all = LevelOfDetail::Resolved { resolution, coarseness: Coarseness::ALL };
        let slabs = all.slabs(view, parameters, all.level_count(self.level_count()));
        let longest_step = slabs.iter().map(|slab| slab.level).max().unwrap_or(0);
        let mut shots = vec![full];
        let chosen = coarsest_alike(longest_step, |coarseness| {
            if coarseness != Coarseness::NONE {
                let resolved = LevelOfDetail::Resolved { resolution, coarseness };
                let shot = self.prepare_detail(parameters, skipping, resolved)?;
                shots.push(ResolvedShot { shot, coarseness });
            }
            let picture = self.over_black(shots[shots.len() - 1].shot, view)?;
            Ok::<_, Failure>(compare(&picture, &truth).map_err(Failure::input)?.dssim())
        })?;
        Ok(shots.into_iter().find(|tried| tried.coarseness == chosen).unwrap_or(full))
    }
}
