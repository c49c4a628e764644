//! Keys: what each does, and the list of them.

use super::look::SHADINGS;
use super::pointer::Tool;
use super::{Asked, Beholder, Desk, Shown};
use crate::look::ModeName;
use crate::viewer::command::Command;
use crate::viewer::state::{Edit, Plane, State, WarpName};
use egui::{Context, Event, Grid, Key, Modifiers, RichText, ScrollArea, Ui, Window};
use std::path::PathBuf;

/// Height of the window that the list takes no part of: its title and what is about it, points.
const ABOUT_LIST: f32 = 80.0;

/// A key, in words and in effect.
struct Shortcut {
    modifiers: Modifiers,
    /// Whether it acts again and again while it is held.
    repeats: bool,
    key: Key,
    name: &'static str,
    what: &'static str,
    act: fn(&mut Desk, &State, &mut Asked),
}

const fn plain(
    key: Key,
    name: &'static str,
    what: &'static str,
    act: fn(&mut Desk, &State, &mut Asked),
) -> Shortcut {
    Shortcut { modifiers: Modifiers::NONE, repeats: false, key, name, what, act }
}

const fn repeating(
    key: Key,
    name: &'static str,
    what: &'static str,
    act: fn(&mut Desk, &State, &mut Asked),
) -> Shortcut {
    Shortcut { repeats: true, ..plain(key, name, what, act) }
}

const fn with_command(
    key: Key,
    name: &'static str,
    what: &'static str,
    act: fn(&mut Desk, &State, &mut Asked),
) -> Shortcut {
    Shortcut { modifiers: Modifiers::COMMAND, ..plain(key, name, what, act) }
}

/// Keys that act when they are pressed.
const SHORTCUTS: [Shortcut; 16] = [
    plain(Key::Questionmark, "?", "these keys", |desk, _, _| desk.shows_keys = !desk.shows_keys),
    plain(Key::Escape, "Esc", "put this list away", |desk, _, _| desk.shows_keys = false),
    plain(Key::H, "H", "hide or show the panels", |desk, _, _| desk.hides_panels = !desk.hides_panels),
    plain(Key::M, "M", "next mode", |_, state, asked| {
        asked.edit(Edit::Mode(following(&ModeName::ALL, state.look.mode)));
    }),
    plain(Key::L, "L", "next shading", |_, state, asked| {
        asked.edit(Edit::Shading(following(&SHADINGS.map(|(shading, _)| shading), state.look.shading)));
    }),
    repeating(Key::I, "I", "raise the isovalue", |_, state, asked| {
        asked.edit(Edit::Isovalue(state.look.isovalue + 0.02));
    }),
    repeating(Key::U, "U", "lower the isovalue", |_, state, asked| {
        asked.edit(Edit::Isovalue(state.look.isovalue - 0.02));
    }),
    plain(Key::C, "C", "handles of the clip box", |_, state, asked| {
        asked.edit(Edit::ClipHandles(!state.clip.has_handles));
    }),
    plain(Key::P, "P", "clip plane", |_, state, asked| {
        asked.edit(Edit::ClipPlane(state.clip.plane.is_none().then(Plane::default)));
    }),
    plain(
        Key::X,
        "X",
        "one eye, side by side, anaglyph, quilt, light field, panel if calibrated",
        |_, state, asked| {
            asked.edit(Edit::Arrangement(following(&state.arrangements(), state.stereo.arrangement)));
        },
    ),
    plain(Key::V, "V", "next warp", |_, state, asked| {
        asked.edit(Edit::Warp(following(&WarpName::ALL, state.pace.warp)));
    }),
    plain(Key::F11, "F11", "fill the whole screen, or no longer", |_, _, asked| {
        asked.command(Command::FullScreen);
    }),
    plain(Key::F12, "F12", "write screenshot.png, or screenshot-2.png and so on", |_, _, asked| {
        asked.command(Command::ScreenshotNew(PathBuf::from("screenshot.png")));
    }),
    with_command(Key::S, "Ctrl S", "save view.json, or view-2.json and so on", |_, _, asked| {
        asked.command(Command::SaveNew(PathBuf::from("view.json")));
    }),
    with_command(Key::R, "Ctrl R", "read the file again", |_, _, asked| asked.command(Command::Reload)),
    with_command(Key::Q, "Ctrl Q", "end", |_, _, asked| asked.command(Command::Quit)),
];

/// Those that concern the camera.
const OF_CAMERA: [Shortcut; 4] = [
    plain(Key::O, "O", "drag to orbit", |desk, _, _| desk.tool = Tool::Orbit),
    plain(Key::F, "F", "drag to look around, wheel to fly", |desk, _, _| desk.tool = Tool::Fly),
    plain(Key::T, "T", "drag to shift and widen the window of values", |desk, _, _| desk.tool = Tool::Window),
    plain(Key::Home, "Home", "first view", |_, _, asked| asked.edit(Edit::ResetCamera)),
];

/// The mouse in the panels.
const IN_PANELS: [(&str, &str); 3] = [
    ("function: drag", "move a point"),
    ("function: double click", "add a point"),
    ("function: right click", "remove a point"),
];

/// Keys that act as long as they are down, and the mouse in the camera's picture.
const IN_CAMERAS_PICTURE: [(&str, &str); 8] = [
    ("← → ↑ ↓", "orbit; with Shift: pan"),
    ("W A S D Q E", "fly forward, left, back, right, down, up"),
    ("drag", "orbit, look around or window, as chosen"),
    ("Shift drag", "pan; also with the right button"),
    ("Ctrl drag", "window: right widens, up raises"),
    ("wheel", "come nearer; middle drag, too"),
    HANDLES[0],
    HANDLES[1],
];

/// What `C` shows.
const HANDLES: [(&str, &str); 2] = [
    ("dot on the box: drag", "move that face in or out"),
    ("dots on the plane: drag", "move it by the one, turn it by the other"),
];

/// The mouse in a headset's picture.
const IN_HEADSETS_PICTURE: [(&str, &str); 3] =
    [("drag", "window: right widens, up raises"), HANDLES[0], HANDLES[1]];

/// Keys that act on what is shown to somebody.
fn shortcuts(beholder: &Beholder) -> impl Iterator<Item = &'static Shortcut> {
    let of_camera: &[Shortcut] = match beholder {
        Beholder::Camera => &OF_CAMERA,
        Beholder::Headset { .. } => &[],
    };
    SHORTCUTS.iter().chain(of_camera)
}

/// What else does something, in words.
fn others(beholder: &Beholder) -> impl Iterator<Item = (&'static str, &'static str)> {
    let in_picture: &[(&str, &str)] = match beholder {
        Beholder::Camera => &IN_CAMERAS_PICTURE,
        Beholder::Headset { .. } => &IN_HEADSETS_PICTURE,
    };
    in_picture.iter().chain(&IN_PANELS).copied()
}

/// Acts on what has been pressed, unless a text is being typed.
pub(super) fn listen(desk: &mut Desk, ui: &Ui, shown: &Shown<'_>, asked: &mut Asked) {
    if ui.ctx().text_edit_focused() {
        return;
    }
    for shortcut in shortcuts(shown.beholder) {
        let is_pressed = ui.input(|input| {
            let is_command = shortcut.modifiers.command;
            let is_of_key = |event: &Event| {
                matches!(*event, Event::Key { key, pressed: true, repeat, .. }
                    if key == shortcut.key && (shortcut.repeats || !repeat))
            };
            input.events.iter().any(is_of_key) && input.modifiers.command == is_command
        });
        if is_pressed {
            (shortcut.act)(desk, shown.state, asked);
        }
    }
}

/// Shows the list; whether it stays.
pub(super) fn show(context: &Context, beholder: &Beholder) -> bool {
    let mut stays = true;
    let names = shortcuts(beholder).map(|shortcut| (shortcut.name, shortcut.what));
    Window::new("Keys and mouse").open(&mut stays).collapsible(false).resizable(false).show(context, |ui| {
        let height = context.content_rect().height() - ABOUT_LIST;
        ScrollArea::vertical().max_height(height.max(ABOUT_LIST)).show(ui, |ui| {
            Grid::new("keys").num_columns(2).spacing([18.0, 4.0]).show(ui, |ui| {
                for (name, what) in names.chain(others(beholder)) {
                    ui.label(RichText::new(name).monospace().strong());
                    ui.label(what);
                    ui.end_row();
                }
            });
        });
    });
    stays
}

/// The one after another, the first after the last.
fn following<T: Copy + PartialEq>(all: &[T], value: T) -> T {
    let next = all.iter().position(|&other| other == value).map_or(0, |index| index + 1);
    all.get(next).or(all.first()).copied().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_goes_through_all() {
        let seen: Vec<_> = (0..WarpName::ALL.len())
            .scan(WarpName::None, |warp, _| {
                *warp = following(&WarpName::ALL, *warp);
                Some(*warp)
            })
            .collect();
        assert_eq!(seen, [WarpName::Quad, WarpName::Grid, WarpName::Volumetric, WarpName::None]);
    }

    #[test]
    fn no_key_does_two_things() {
        for (index, shortcut) in shortcuts(&Beholder::Camera).enumerate() {
            let clash = shortcuts(&Beholder::Camera)
                .take(index)
                .find(|other| other.key == shortcut.key && other.modifiers == shortcut.modifiers);
            assert!(clash.is_none(), "{}", shortcut.name);
        }
    }
}
