//! What the hands point at.

use super::eyes::upright_pose;
use crate::failure::Failure;
use crate::viewer::state::{Clip, Look, State, Transfer};
use wheatstone_core::cast::CastParameters;
use wheatstone_core::headset::{Hand, Stand, pointing_settings, value_under};
use wheatstone_core::reference::Caster;
use wheatstone_core::scene::Placement;
use wheatstone_core::view::world_from_patient;
use wheatstone_core::volume::Grid;

/// A volume whose values can be pointed at.
pub(crate) struct Pointing {
    caster: Caster,
    grid: Grid,
    shown: Option<Shown>,
}

/// What has been worked out of a state, which counts as long as these parts of it stay.
struct Shown {
    look: Look,
    transfer: Transfer,
    clip: Clip,
    parameters: CastParameters,
}

impl Pointing {
    /// At voxels of a grid.
    pub(crate) fn new(caster: Caster, grid: Grid) -> Self {
        Self { caster, grid, shown: None }
    }

    /// The values of what is shown of the volume under the hands' pointers, in the file's unit, while it stands somewhere.
    pub(crate) fn values_under(
        &mut self,
        hands: &[Hand; 2],
        stand: &Stand,
        state: &State,
    ) -> Result<[Option<f64>; 2], Failure> {
        if hands.iter().all(|hand| hand.aim.is_none()) {
            return Ok([None; 2]);
        }
        let Self { caster, grid, shown } = self;
        let is_same = |shown: &Shown| {
            (&shown.look, &shown.transfer, &shown.clip) == (&state.look, &state.transfer, &state.clip)
        };
        let shown = match shown.take().filter(is_same) {
            Some(same) => shown.insert(same),
            None => shown.insert(Shown::of(state, grid)?),
        };
        Ok(hands.each_ref().map(|hand| {
            let aim = upright_pose(&hand.aim?, stand);
            value_under(&aim, caster, &shown.parameters).map(|pointed| pointed.value)
        }))
    }
}

impl Shown {
    fn of(state: &State, grid: &Grid) -> Result<Self, Failure> {
        let placement = Placement::of_grid(grid, world_from_patient(grid, state.look.up.direction()));
        let settings = pointing_settings(state.settings().map_err(Failure::input)?);
        Ok(Self {
            look: state.look,
            transfer: state.transfer.clone(),
            clip: state.clip,
            parameters: CastParameters::new(&settings, &placement),
        })
    }
}
