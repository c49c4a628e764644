//! Hands that hold the volume.

use super::button::Button;
use super::hand::tracked;
use super::{Hand, Stand};
use crate::head::Pose;
use glam::{DQuat, DVec3};

/// Shortest and longest that two hands make the volume's longest side, metres: a coin, that still can be aimed at, and a hall
/// to walk in. A volume that is beyond these for another reason is scaled towards them only.
pub const LONGEST_SIDES_M: [f64; 2] = [0.02, 20.0];

/// Hands nearer to each other than this have no line between them, metres.
const NEAREST_HANDS_M: f64 = 0.01;

/// Which hands hold the volume, and since when.
///
/// One hand carries the volume as if it were fixed to its grip. Two hands carry it with the line between their grips: its
/// middle moves as the middle between them, it turns by the shortest turn of the line and by the mean of what the grips turn
/// about the line, and it grows with the line's length.
///
/// A hand need not touch the volume to take hold of it. Whenever the hands that hold it change, what has been reached is where
/// those that hold it from then on begin, so that nothing jumps; a hand that is not tracked holds nothing until it is again.
#[derive(Debug, Clone, Default)]
pub(super) struct Grasp {
    squeezes: [Button; 2],
    hold: Option<Hold>,
}

/// Where hands and volume have been together.
#[derive(Debug, Clone, Copy)]
struct Hold {
    /// Of the hands that hold the volume; of one at least.
    grips: [Option<Pose>; 2],
    stand: Stand,
}

impl Grasp {
    /// What the hands do next: where the volume is then, and which of them have taken hold of it by that.
    pub(super) fn update(&mut self, stand: Stand, hands: &[Hand; 2]) -> (Stand, [bool; 2]) {
        let grips = [0, 1].map(|side: usize| tracked(hands[side].grip));
        let grabbed =
            [0, 1].map(|side: usize| grips[side].is_some() && self.squeezes[side].press(hands[side].squeeze));
        let stand = self.hold.and_then(|hold| hold.carried(&grips)).unwrap_or(stand);
        let holding = [0, 1].map(|side: usize| grips[side].filter(|_| self.squeezes[side].is_down()));
        self.hold = match self.hold {
            // What one hand holds is fixed to it: no rounding adds up.
            Some(hold) if hold.is_of_one_of(&holding) => Some(hold),
            _ if holding == [None, None] => None,
            _ => Some(Hold { grips: holding, stand }),
        };
        (stand, grabbed)
    }

    /// Which hands are closed, as far as is known.
    pub(super) fn is_closed(&self) -> [bool; 2] {
        self.squeezes.map(Button::is_down)
    }

    /// Begins anew where hands and volume are next.
    pub(super) fn let_be(&mut self) {
        self.hold = None;
    }
}

impl Hold {
    /// Whether one hand holds the volume, and the same hand is the only one to hold it now.
    fn is_of_one_of(&self, grips: &[Option<Pose>; 2]) -> bool {
        let [left, right] = [0, 1].map(|side: usize| (self.grips[side].is_some(), grips[side].is_some()));
        left.0 == left.1 && right.0 == right.1 && left.0 != right.0
    }

    /// Where the volume is carried by the same hands; `None` if one of them is not tracked.
    fn carried(&self, now: &[Option<Pose>; 2]) -> Option<Stand> {
        match self.grips {
            [Some(left), Some(right)] => Some(by_two([left, right], [now[0]?, now[1]?], &self.stand)),
            [Some(left), None] => Some(by_one(left, now[0]?, &self.stand)),
            [None, Some(right)] => Some(by_one(right, now[1]?, &self.stand)),
            [None, None] => None,
        }
    }
}

fn by_one(from: Pose, to: Pose, stand: &Stand) -> Stand {
    if to == from {
        return *stand;
    }
    let turn = to.orientation * from.orientation.inverse();
    let position_m = to.position_m + turn * (stand.pose.position_m - from.position_m);
    let orientation = (turn * stand.pose.orientation).normalize();
    Stand { pose: Pose { position_m, orientation }, ..*stand }
}

fn by_two(from: [Pose; 2], to: [Pose; 2], stand: &Stand) -> Stand {
    if to == from {
        return *stand;
    }
    let [middle_from, middle_to] = [from, to].map(|[left, right]| left.position_m.midpoint(right.position_m));
    let [line_from, line_to] = [from, to].map(|[left, right]| right.position_m - left.position_m);
    let (turn, growth) = turn_and_growth(line_from, line_to, [from, to]);
    let [least, most] = LONGEST_SIDES_M;
    let longest_side_m = (stand.longest_side_m * growth)
        .clamp(least.min(stand.longest_side_m), most.max(stand.longest_side_m));
    let from_middle_m = turn * (stand.pose.position_m - middle_from);
    Stand {
        pose: Pose {
            position_m: middle_to + from_middle_m * (longest_side_m / stand.longest_side_m),
            orientation: (turn * stand.pose.orientation).normalize(),
        },
        longest_side_m,
    }
}

/// How the line between two hands turns and grows, metres; not at all where there is none.
fn turn_and_growth(from: DVec3, to: DVec3, [grips_from, grips_to]: [[Pose; 2]; 2]) -> (DQuat, f64) {
    let lengths_m = [from.length(), to.length()];
    if !lengths_m.iter().all(|&length_m| length_m >= NEAREST_HANDS_M && length_m.is_finite()) {
        return (DQuat::IDENTITY, 1.0);
    }
    let along = from / lengths_m[0];
    let shortest = DQuat::from_rotation_arc(along, to / lengths_m[1]);
    let twist_rad = |side: usize| {
        let turn = grips_to[side].orientation * grips_from[side].orientation.inverse();
        twist_about(shortest.inverse() * turn, along)
    };
    let twist = DQuat::from_axis_angle(along, 0.5 * (twist_rad(0) + twist_rad(1)));
    (shortest * twist, lengths_m[1] / lengths_m[0])
}

/// Angle of the part of a turn that is about an axis, radians, −π to π.
fn twist_about(turn: DQuat, axis: DVec3) -> f64 {
    let [along, w] = [turn.xyz().dot(axis), turn.w].map(|part| if turn.w < 0.0 { -part } else { part });
    2.0 * along.atan2(w)
}
