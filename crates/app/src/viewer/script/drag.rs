//! The mouse, dragged from one place of the window to another.

use super::step::duration_ms;
use egui::{Event, Modifiers, PointerButton, Pos2};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Time from one move of the mouse to the next.
const MOVE_MS: u64 = 8;

/// A drag, places in points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Drag {
    pub(crate) from: [f32; 2],
    pub(crate) to: [f32; 2],
    /// How long it takes.
    #[serde(deserialize_with = "duration_ms")]
    pub(crate) ms: u64,
    #[serde(default)]
    pub(crate) button: Button,
    #[serde(default)]
    pub(crate) shift: bool,
    #[serde(default)]
    pub(crate) ctrl: bool,
}

/// A mouse button.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Button {
    #[default]
    Left,
    Right,
    Middle,
}

impl Drag {
    /// The events, and when each happens after the first.
    pub(crate) fn events(&self) -> impl Iterator<Item = (Duration, Event)> + use<> {
        let [from, to] = [self.from, self.to].map(Pos2::from);
        let modifiers = self.modifiers();
        let button = match self.button {
            Button::Left => PointerButton::Primary,
            Button::Right => PointerButton::Secondary,
            Button::Middle => PointerButton::Middle,
        };
        let press = move |pos, pressed| Event::PointerButton { pos, button, pressed, modifiers };
        let moves = self.moves();
        let pressed = [(Duration::ZERO, Event::PointerMoved(from)), (Duration::ZERO, press(from, true))];
        let moved = (1..=moves).map(move |index| {
            let at = from + (to - from) * (index as f32 / moves as f32);
            (Duration::from_millis(index * MOVE_MS), Event::PointerMoved(at))
        });
        let released = [(self.duration(), press(to, false))];
        pressed.into_iter().chain(moved).chain(released)
    }

    /// From the first event to the last.
    pub(super) fn duration(&self) -> Duration {
        Duration::from_millis(self.moves() * MOVE_MS)
    }

    fn moves(&self) -> u64 {
        (self.ms / MOVE_MS).max(1)
    }

    /// Keys that are held.
    pub(super) fn modifiers(&self) -> Modifiers {
        Modifiers { shift: self.shift, ctrl: self.ctrl, command: self.ctrl, ..Modifiers::NONE }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drag_ends_where_it_is_to_end() {
        let drag = Drag {
            from: [0.0, 0.0],
            to: [10.0, 20.0],
            ms: 100,
            button: Button::Left,
            shift: false,
            ctrl: true,
        };
        let events: Vec<_> = drag.events().collect();
        let places: Vec<Pos2> = events
            .iter()
            .filter_map(|(_, event)| if let Event::PointerMoved(place) = event { Some(*place) } else { None })
            .collect();
        assert_eq!(places.last(), Some(&Pos2::new(10.0, 20.0)));
        assert!(events.is_sorted_by_key(|(after, _)| *after));
        assert!(matches!(events.last().unwrap().1, Event::PointerButton { pressed: false, .. }));
    }
}
