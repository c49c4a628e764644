//! What dragging the picture means.

use crate::viewer::state::{Edit, State};
use egui::{Modifiers, PointerButton, Vec2};

/// A turn by the shorter side of an eye's picture, degrees.
const ORBIT_DEG: f64 = 180.0;

/// Metres that a notch of the wheel flies, as a part of the distance.
const FLY_PER_NOTCH: f64 = 0.1;

/// Points of scrolling in a notch of the wheel.
const NOTCH_POINTS: f64 = 50.0;

/// What the first button does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Tool {
    Orbit,
    Fly,
    Window,
}

impl Tool {
    pub(super) const ALL: [Self; 3] = [Self::Orbit, Self::Fly, Self::Window];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Orbit => "Orbit",
            Self::Fly => "Fly",
            Self::Window => "Window/level",
        }
    }

    pub(super) fn help(self) -> &'static str {
        match self {
            Self::Orbit => "drag: circle the volume · wheel: come nearer",
            Self::Fly => "drag: look around · W A S D Q E and wheel: fly",
            Self::Window => "drag: shift and widen the window of values",
        }
    }
}

/// What a drag by parts of the shorter side of an eye's picture asks for (`by`: right and down).
pub(super) fn drag(tool: Tool, button: PointerButton, modifiers: Modifiers, by: Vec2) -> Edit {
    let [right, down] = [f64::from(by.x), f64::from(by.y)];
    match button {
        PointerButton::Primary if modifiers.command => window(by),
        PointerButton::Primary if !modifiers.shift => match tool {
            Tool::Orbit => Edit::Orbit { right_deg: -ORBIT_DEG * right, up_deg: ORBIT_DEG * down },
            Tool::Fly => Edit::Turn { right_deg: 0.5 * ORBIT_DEG * right, up_deg: -0.5 * ORBIT_DEG * down },
            Tool::Window => window(by),
        },
        PointerButton::Middle => zoom(-2.0 * down),
        _ => Edit::Pan { right: -right, up: down },
    }
}

/// The window of values, shifted and widened by a drag by parts of the shorter side of an eye's picture (right and down).
pub(super) fn window(by: Vec2) -> Edit {
    let [right, down] = [f64::from(by.x), f64::from(by.y)];
    Edit::WindowLevel { shift: -0.5 * down, stretch: (2.0 * right).exp() }
}

/// What scrolling by some points asks for.
pub(super) fn scroll(tool: Tool, state: &State, up_points: f64) -> Edit {
    let notches = up_points / NOTCH_POINTS;
    match tool {
        Tool::Fly => {
            let forward_m = FLY_PER_NOTCH * state.camera.distance_m * notches;
            Edit::Fly { right_m: 0.0, up_m: 0.0, forward_m }
        }
        Tool::Orbit | Tool::Window => zoom(0.12 * notches),
    }
}

/// By a power of e, from the furthest to the nearest at most.
fn zoom(exponent: f64) -> Edit {
    Edit::Zoom(exponent.clamp(-20.0, 20.0).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn buttons_and_modifiers_choose() {
        let by = egui::vec2(0.1, 0.2);
        let asked = |button, modifiers| drag(Tool::Orbit, button, modifiers, by);
        assert!(matches!(asked(PointerButton::Primary, Modifiers::NONE), Edit::Orbit { .. }));
        assert!(matches!(asked(PointerButton::Primary, Modifiers::SHIFT), Edit::Pan { .. }));
        assert!(matches!(asked(PointerButton::Primary, Modifiers::COMMAND), Edit::WindowLevel { .. }));
        assert!(matches!(asked(PointerButton::Secondary, Modifiers::NONE), Edit::Pan { .. }));
        assert!(matches!(asked(PointerButton::Middle, Modifiers::NONE), Edit::Zoom(factor) if factor < 1.0));
    }

    #[test]
    fn what_is_dragged_to_the_right_turns_to_the_right() {
        let edit = drag(Tool::Orbit, PointerButton::Primary, Modifiers::NONE, egui::vec2(0.5, 0.0));
        assert_eq!(edit, Edit::Orbit { right_deg: -90.0, up_deg: 0.0 });
    }
}
