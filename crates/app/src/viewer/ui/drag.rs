//! The pointer, from where it is pressed.

use egui::{Event, Modifiers, PointerButton, Pos2, Response, Ui, Vec2};

/// Follows the pointer move by move, so that nothing depends on how many moves come in a pass.
#[derive(Debug, Default)]
pub(super) struct Follower(Option<Held>);

/// A button that is down.
#[derive(Debug)]
struct Held {
    button: PointerButton,
    modifiers: Modifiers,
    at: Pos2,
    /// That nobody has been told of.
    moves: Vec<Vec2>,
}

/// What has been dragged since the pass before, at first since the press.
#[derive(Debug)]
pub(super) struct Drag {
    pub(super) button: PointerButton,
    /// Keys that were down at the press.
    pub(super) modifiers: Modifiers,
    /// One after the other, points.
    pub(super) moves: Vec<Vec2>,
}

impl Follower {
    /// What is dragged from an area, once a press there is known to be no click.
    pub(super) fn follow(&mut self, ui: &Ui, area: &Response) -> Option<Drag> {
        ui.input(|input| input.events.iter().for_each(|event| self.take_in(event, area)));
        let drag = self.0.as_mut().filter(|_| area.dragged() || area.drag_stopped()).map(|held| Drag {
            button: held.button,
            modifiers: held.modifiers,
            moves: std::mem::take(&mut held.moves),
        });
        if !area.is_pointer_button_down_on() && !area.dragged() {
            self.0 = None;
        }
        drag
    }

    fn take_in(&mut self, event: &Event, area: &Response) {
        match *event {
            Event::PointerButton { pos, button, pressed: true, modifiers }
                if self.0.is_none() && area.is_pointer_button_down_on() =>
            {
                self.0 = Some(Held { button, modifiers, at: pos, moves: Vec::new() });
            }
            Event::PointerMoved(pos) => {
                if let Some(held) = &mut self.0 {
                    held.moves.push(pos - held.at);
                    held.at = pos;
                }
            }
            _ => {}
        }
    }
}
