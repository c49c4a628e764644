//! The images of projectors at the resolution of their display.

use super::{Engine, Shot};
use crate::failure::Failure;
use crate::skipping::Skipping;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::detail::LevelOfDetail;
use wheatstone_core::lightfield::{Resolution, coarsest_alike};
use wheatstone_core::metrics::compare;
use wheatstone_core::view::View;

/// A shot at the resolution of a display.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ResolvedShot {
    pub(crate) shot: Shot,
    /// The longest steps over those at full detail.
    pub(crate) longest_step: usize,
}

impl Engine<'_> {
    /// As [`Engine::prepare_detail`] for the views of a display's projectors, by steps no longer than the picture of the one in the
    /// middle bears ([`coarsest_alike`]).
    pub(crate) fn prepare_resolved(
        &mut self,
        parameters: &CastParameters,
        skipping: &Skipping,
        resolution: Resolution,
        views: &[View],
    ) -> Result<ResolvedShot, Failure> {
        let full = self.prepare(parameters, skipping)?;
        let mut shots = vec![full];
        if let Some(view) = views.get(views.len() / 2) {
            let truth = self.truth(full, view)?;
            let all = LevelOfDetail::Resolved { resolution, coarsest: usize::MAX };
            let slabs = all.slabs(view, parameters, all.level_count(self.level_count()));
            let last = slabs.iter().map(|slab| slab.level).max().unwrap_or(0);
            let coarsest = coarsest_alike(last, |coarsest| {
                if coarsest > 0 {
                    let resolved = LevelOfDetail::Resolved { resolution, coarsest };
                    shots.push(self.prepare_detail(parameters, skipping, resolved)?);
                }
                let picture = self.over_black(shots[coarsest], view)?;
                Ok::<_, Failure>(compare(&picture, &truth).map_err(Failure::input)?.dssim())
            })?;
            shots.truncate(coarsest + 1);
        }
        let coarsest = shots.len() - 1;
        Ok(ResolvedShot { shot: shots[coarsest], longest_step: 1 << coarsest })
    }
}
