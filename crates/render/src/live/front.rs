//! The picture that is shown.

use super::wanted::Wanted;
use crate::renderer::Prepared;
use crate::target::Target;
use std::sync::Arc;
use wheatstone_core::budget::Quality;
use wheatstone_core::view::View;

/// A picture that is whole.
#[derive(Debug)]
pub struct Front {
    pub(super) wanted: Wanted,
    pub(super) prepared: Arc<Prepared>,
    pub(super) targets: Vec<Target>,
}

impl Front {
    /// A target and the view that it was cast from, of the target's size, for each view of the rig.
    pub fn pictures(&self) -> impl Iterator<Item = (&Target, View)> {
        self.targets.iter().zip(self.wanted.cast_views())
    }

    /// What its views were cast with: the settings with the steps of the quality.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// The settings that were given.
    pub fn settings(&self) -> &Arc<Prepared> {
        &self.wanted.settings
    }

    /// How coarse it is.
    pub fn quality(&self) -> Quality {
        self.wanted.quality
    }
}
