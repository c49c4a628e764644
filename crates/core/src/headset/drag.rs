//! Hands that drag what cuts the volume.

use super::button::Button;
use super::crop::{Crop, Handle, Picked, Ray};
use super::hand::tracked;
use super::{Hand, Stand};
use glam::{DAffine3, DVec3};

/// What each hand drags by its trigger, and what it points at.
///
/// What a hand picks when it pulls the trigger is fixed to it as if by a rod, however far away it is: the picked point moves
/// rigidly with the hand, all in a space that goes with the volume. A plane moves and turns with the rod, a face goes with its end
/// along the axis of its own. A hand that reaches into the visible part picks what it points at from within. A bare hand picks what its
/// fingers are near.
#[derive(Debug, Clone, Default)]
pub(super) struct Drags {
    triggers: [Button; 2],
    drags: [Option<Drag>; 2],
    picked: [Option<(Handle, DVec3)>; 2],
}

/// Something that is dragged.
#[derive(Debug, Clone, Copy)]
struct Drag {
    handle: Handle,
    /// The rod's end, upright space.
    point: DVec3,
    /// What it is dragged from; `None` while the hand is not tracked.
    from: Option<Start>,
}

/// Where hand, rod and crop have been together.
#[derive(Debug, Clone, Copy)]
struct Start {
    upright_from_hand: DAffine3,
    point: DVec3,
    crop: Crop,
}

/// How a hand picks.
enum Reach {
    Along(Ray),
    /// World space, metres.
    At(DVec3),
}

impl Drags {
    /// What the hands that do not hold the volume do next, and which of them have taken hold of something by that.
    pub(super) fn update(
        &mut self,
        crop: &mut Crop,
        hands: &[Hand; 2],
        is_holding: [bool; 2],
        stand: &Stand,
        upright_from_texture: DAffine3,
    ) -> [bool; 2] {
        let aims = [0, 1].map(|side: usize| tracked(hands[side].aim));
        let has_pulled =
            [0, 1].map(|side: usize| aims[side].is_some() && self.triggers[side].press(hands[side].trigger));
        let free = [0, 1].map(|side: usize| aims[side].filter(|_| !is_holding[side]));
        let upright_from_world = stand.world_from_upright().inverse();
        for side in 0..2 {
            if is_holding[side] || !self.triggers[side].is_down() {
                self.drags[side] = None;
            }
            if let Some(drag) = &mut self.drags[side] {
                let hand = free[side].map(|aim| upright_from_world * aim.world_from_own());
                drag.follow(crop, hand, upright_from_texture);
            }
        }
        let reaches = [0, 1].map(|side: usize| {
            let aim = free[side]?;
            Some(match hands[side].pinch {
                Some(_) => Reach::At(aim.position_m),
                None => Reach::Along(Ray::new(&aim, stand, upright_from_texture)),
            })
        });
        let spaces = (stand, upright_from_texture);
        let has_taken = [0, 1].map(|side: usize| {
            if has_pulled[side] {
                self.drags[side] = reaches[side].as_ref().zip(free[side]).and_then(|(reach, aim)| {
                    let (handle, point) = self.pick(side, crop, reach, spaces)?;
                    let upright_from_hand = upright_from_world * aim.world_from_own();
                    let start = Start { upright_from_hand, point, crop: *crop };
                    Some(Drag { handle, point, from: Some(start) })
                });
            }
            has_pulled[side] && self.drags[side].is_some()
        });
        self.picked = [0, 1].map(|side: usize| match (&reaches[side], self.drags[side]) {
            (Some(_), Some(drag)) => Some((drag.handle, drag.point)),
            (Some(reach), None) => self.pick(side, crop, reach, spaces),
            (None, _) => None,
        });
        has_taken
    }

    /// What a hand reaches, unless the other one drags it, and where, upright space.
    fn pick(
        &self,
        side: usize,
        crop: &Crop,
        reach: &Reach,
        (stand, upright_from_texture): (&Stand, DAffine3),
    ) -> Option<(Handle, DVec3)> {
        let (handle, point) = match reach {
            Reach::Along(ray) => {
                let (handle, distance_m) = crop.pick(ray)?;
                (handle, ray.at(distance_m))
            }
            Reach::At(point_m) => {
                let handle = crop.near(*point_m, stand, upright_from_texture)?;
                (handle, stand.world_from_upright().inverse().transform_point3(*point_m))
            }
        };
        let is_taken = self.drags[1 - side].is_some_and(|drag| drag.handle == handle);
        (!is_taken).then_some((handle, point))
    }

    /// What the hands point at, or drag.
    pub(super) fn picked(&self, stand: &Stand) -> [Option<Picked>; 2] {
        let world_from_upright = stand.world_from_upright();
        self.picked.map(|picked| {
            let (handle, point) = picked?;
            Some(Picked { handle, point_m: world_from_upright.transform_point3(point) })
        })
    }

    /// Which triggers are pulled.
    pub(super) fn is_pulled(&self) -> [bool; 2] {
        self.triggers.map(Button::is_down)
    }

    /// Ends what is being dragged: it takes another pull to drag on.
    pub(super) fn let_go(&mut self) {
        self.drags = [None; 2];
    }
}

impl Drag {
    /// Moves what is dragged with a hand, or holds it still while the hand is not tracked.
    fn follow(
        &mut self,
        crop: &mut Crop,
        upright_from_hand: Option<DAffine3>,
        upright_from_texture: DAffine3,
    ) {
        let Some(upright_from_hand) = upright_from_hand else {
            self.from = None;
            return;
        };
        let here = Start { upright_from_hand, point: self.point, crop: *crop };
        let start = self.from.get_or_insert(here);
        let has_moved = start.upright_from_hand != upright_from_hand;
        let motion = if has_moved {
            upright_from_hand * start.upright_from_hand.inverse()
        } else {
            DAffine3::IDENTITY
        };
        self.point = motion.transform_point3(start.point);
        let ends = [start.point, self.point];
        *crop = crop.with_moved(self.handle, &start.crop, ends, motion, upright_from_texture);
    }
}
