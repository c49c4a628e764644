//! Bare hands.

use super::button::Button;
use super::crop::Crop;
use super::hand::tracked;
use super::{Hand, Stand};
use crate::head::Pose;
use glam::DAffine3;

/// What each hand takes hold of by its pinch, until it lets go.
///
/// Fingers that close near a face of the visible box, or near the plane, drag it, as a trigger would; anywhere else they take the volume,
/// as a squeeze would. What they are near later changes nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Pinches {
    fingers: [Button; 2],
    taken: [Option<Taken>; 2],
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Taken {
    Volume,
    Cut,
}

impl Pinches {
    /// Hands as if all of them held controllers. Those that are bare point at what their fingers are near.
    pub(super) fn update(
        &mut self,
        hands: &[Hand; 2],
        crop: &Crop,
        stand: &Stand,
        upright_from_texture: DAffine3,
    ) -> [Hand; 2] {
        [0, 1].map(|side: usize| {
            let hand = hands[side];
            let at = hand.pinch.and_then(|pinch| {
                tracked(Some(Pose { position_m: pinch.position_m, ..hand.aim? })).map(|at| (at, pinch.closed))
            });
            let Some((at, closed)) = at else {
                self.fingers[side].press(0.0);
                self.taken[side] = None;
                return Hand { pinch: None, ..hand };
            };
            if self.fingers[side].press(closed) {
                let is_near = crop.near(at.position_m, stand, upright_from_texture).is_some();
                self.taken[side] = Some(if is_near { Taken::Cut } else { Taken::Volume });
            }
            if !self.fingers[side].is_down() {
                self.taken[side] = None;
            }
            let if_taken = |what| if self.taken[side] == Some(what) { closed } else { 0.0 };
            let (squeeze, trigger) = (if_taken(Taken::Volume), if_taken(Taken::Cut));
            Hand { aim: Some(at), squeeze, trigger, ..hand }
        })
    }
}
