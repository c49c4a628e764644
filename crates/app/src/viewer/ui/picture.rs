//! The picture's area: mouse, keys that are held, dropped files.

use super::beholder::shorter_side;
use super::drag::Drag;
use super::pointer::scroll;
use super::{Asked, Beholder, Desk, Shown, handles, pointer};
use crate::viewer::command::Command;
use crate::viewer::state::Edit;
use egui::{Key, PointerButton, Rect, Response, Sense, Ui};

/// A second of a held key, as a part of the eye's distance.
const FLY_PER_S: f64 = 0.6;

/// A second of a held arrow, degrees.
const ORBIT_DEG_PER_S: f64 = 60.0;

/// Longest time between two passes that held keys count, seconds.
const LONGEST_PASS_S: f32 = 0.1;

pub(super) fn show(desk: &mut Desk, ui: &mut Ui, area: Rect, shown: &Shown<'_>, asked: &mut Asked) {
    let response = ui.interact(area, ui.scope_id().with("picture"), Sense::click_and_drag());
    let drag = desk.drag.follow(ui, &response);
    let moves = drag.as_ref().map_or(&[][..], |drag| &drag.moves);
    let is_held = handles::show(&mut desk.handles, ui, area, shown, &response, moves, asked);
    if let Some(Drag { button, modifiers, moves }) = drag.filter(|_| !is_held) {
        let side = shorter_side(area, shown.state.stereo.arrangement);
        let by = moves.into_iter().map(|by| by / side);
        match shown.beholder {
            Beholder::Camera => {
                by.for_each(|by| asked.edit(pointer::drag(desk.tool, button, modifiers, by)));
            }
            Beholder::Headset { .. } if button == PointerButton::Primary => {
                by.for_each(|by| asked.edit(pointer::window(by)));
            }
            Beholder::Headset { .. } => {}
        }
    }
    if let Beholder::Camera = shown.beholder {
        approach(desk, ui, &response, shown, asked);
        held_keys(ui, shown, asked);
    }
    let dropped: Vec<_> =
        ui.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
    if !dropped.is_empty() {
        asked.command(Command::Drop(dropped));
    }
}

/// The wheel and a pinch over the picture.
fn approach(desk: &Desk, ui: &Ui, response: &Response, shown: &Shown<'_>, asked: &mut Asked) {
    if response.hovered() {
        let (points, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if points != 0.0 {
            asked.edit(scroll(desk.tool, shown.state, f64::from(points)));
        }
        if pinch != 1.0 {
            asked.edit(Edit::Zoom(f64::from(pinch)));
        }
    }
}

/// Keys that move the eye for as long as they are down.
fn held_keys(ui: &Ui, shown: &Shown<'_>, asked: &mut Asked) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    let (dt, modifiers, axes, arrows) = ui.input(|input| {
        let axis = |plus: Key, minus: Key| {
            f64::from(u8::from(input.key_down(plus))) - f64::from(u8::from(input.key_down(minus)))
        };
        let axes = [axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S)];
        let arrows = [axis(Key::ArrowRight, Key::ArrowLeft), axis(Key::ArrowUp, Key::ArrowDown)];
        (input.stable_dt.min(LONGEST_PASS_S), input.modifiers, axes, arrows)
    });
    if modifiers.command {
        return;
    }
    let dt = f64::from(dt);
    if axes != [0.0; 3] {
        let [right_m, up_m, forward_m] =
            axes.map(|axis| axis * FLY_PER_S * dt * shown.state.camera.distance_m);
        asked.edit(Edit::Fly { right_m, up_m, forward_m });
        ui.ctx().request_repaint();
    }
    if arrows != [0.0; 2] {
        let [right, up] = arrows;
        asked.edit(if modifiers.shift {
            Edit::Pan { right: right * 0.5 * dt, up: up * 0.5 * dt }
        } else {
            Edit::Orbit { right_deg: right * ORBIT_DEG_PER_S * dt, up_deg: up * ORBIT_DEG_PER_S * dt }
        });
        ui.ctx().request_repaint();
    }
}
