//! What warps start from.

use crate::backend::{Engine, Shot};
use crate::failure::Failure;
use wheatstone_core::cast::CastParameters;
use wheatstone_core::image::Image;
use wheatstone_core::reference::{Aids, Caster};
use wheatstone_core::view::View;
use wheatstone_core::warp::{EmissionAbsorption, LayerThresholds};

/// A picture with the view that it was cast for.
pub(super) struct Source {
    /// Its number.
    pub(super) picture: u64,
    pub(super) view: View,
    pub(super) image: Image,
    /// What its rays passed through, if a warp asks for that.
    pub(super) layers: Option<EmissionAbsorption>,
}

/// Casts pictures of one scene.
pub(super) struct Camera<'e, 'v> {
    pub(super) engine: &'e mut Engine<'v>,
    pub(super) shot: Shot,
    /// Casts layers, if any warp asks for them.
    pub(super) layered: Option<Layered<'e>>,
}

/// A caster of layers, and what it casts.
pub(super) struct Layered<'e> {
    pub(super) caster: Caster,
    pub(super) parameters: &'e CastParameters,
}

impl Camera<'_, '_> {
    pub(super) fn source(&mut self, picture: u64, view: View) -> Result<Source, Failure> {
        let thresholds = LayerThresholds::default();
        let layers_of = |layered: &Layered<'_>| {
            let Layered { caster, parameters } = layered;
            caster.cast_emission_absorption(parameters, &Aids::default(), &view, &thresholds)
        };
        let layers = self.layered.as_ref().map(layers_of).transpose().map_err(Failure::input)?;
        Ok(Source { picture, view, image: self.cast(view)?, layers: layers.map(|(_, layers)| layers) })
    }

    pub(super) fn cast(&mut self, view: View) -> Result<Image, Failure> {
        self.engine.cast(self.shot, &[view])?;
        let cast = self.engine.read()?.pop();
        cast.map(|cast| cast.image).ok_or_else(|| Failure::Internal(anyhow::anyhow!("no picture of a view")))
    }
}
