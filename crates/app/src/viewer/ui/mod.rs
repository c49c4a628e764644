//! Panels, picture and keys: they read what is shown and ask for commands; nothing else.

mod beholder;
mod camera;
mod clip;
mod drag;
mod field;
mod files;
mod handles;
mod keys;
mod look;
mod pace;
mod passes;
mod picture;
mod pointer;
mod projection;
mod stereo;
mod theme;
mod toasts;
mod transfer;

pub(crate) use beholder::Beholder;
pub(crate) use passes::run_passes;
pub(crate) use theme::{PANEL, dress};

use super::command::Command;
use super::facts::Facts;
use super::job::Progress;
use super::notes::Note;
use super::state::{Edit, State};
use super::timings::Timings;
use egui::{CentralPanel, Color32, Frame, Panel, Rect, ScrollArea, Ui};
use pointer::Tool;
use wheatstone_core::scene::Placement;

/// Width of the panels, points.
const PANEL_WIDTH: f32 = 310.0;

/// Room for the scroll bar, points.
const SCROLL_BAR: f32 = 10.0;

/// What the panels show.
pub(crate) struct Shown<'a> {
    pub(crate) state: &'a State,
    pub(crate) beholder: &'a Beholder,
    pub(crate) facts: Option<&'a Facts>,
    /// Name of the transfer function, if it has one.
    pub(crate) preset: Option<&'a str>,
    pub(crate) placement: Option<Placement>,
    pub(crate) progress: Option<Progress>,
    pub(crate) notes: &'a [Note],
    pub(crate) timings: &'a Timings,
    /// What casts, and how fine the picture is.
    pub(crate) device: &'a str,
    pub(crate) quality: &'a str,
    /// From one refresh to the next, ms.
    pub(crate) refresh_ms: f32,
}

/// What panels remember of themselves.
pub(crate) struct Desk {
    hides_panels: bool,
    shows_keys: bool,
    tool: Tool,
    files: files::Fields,
    transfer: transfer::Grip,
    handles: handles::Grip,
    drag: drag::Follower,
}

/// What has come of a pass.
pub(crate) struct Pass {
    pub(crate) commands: Vec<Command>,
    /// Where the picture is, points.
    pub(crate) picture: Rect,
}

impl Desk {
    pub(crate) fn new() -> Self {
        Self {
            hides_panels: false,
            shows_keys: false,
            tool: Tool::Orbit,
            files: files::Fields::default(),
            transfer: transfer::Grip::default(),
            handles: handles::Grip::default(),
            drag: drag::Follower::default(),
        }
    }

    /// Lays everything out.
    pub(crate) fn show(&mut self, ui: &mut Ui, shown: &Shown<'_>) -> Pass {
        let mut asked = Asked::default();
        keys::listen(self, ui, shown, &mut asked);
        if !self.hides_panels {
            // The window is cleared to the panels' colour.
            let bare = Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT);
            Panel::right("panels").resizable(false).frame(bare).exact_size(PANEL_WIDTH).show(ui, |ui| {
                Panel::bottom("pace").resizable(false).frame(bare).show(ui, |ui| {
                    pace::show(ui, shown, &mut asked);
                    ui.horizontal(|ui| {
                        if ui.button("Keys  ?").clicked() {
                            self.shows_keys = true;
                        }
                        ui.add(egui::Label::new(egui::RichText::new(shown.device).weak()).truncate());
                    });
                });
                ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.panels(ui, shown, &mut asked));
            });
        }
        let picture = CentralPanel::no_frame()
            .show(ui, |ui| {
                let area = shown.beholder.area(ui.max_rect(), shown.state.stereo.arrangement);
                picture::show(self, ui, area, shown, &mut asked);
                area
            })
            .inner;
        if self.shows_keys {
            self.shows_keys = keys::show(ui.ctx(), shown.beholder);
        }
        toasts::show(ui, picture, shown);
        Pass { commands: asked.commands, picture }
    }

    fn panels(&mut self, ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
        ui.set_max_width(ui.available_width() - SCROLL_BAR);
        files::show(&mut self.files, ui, shown, asked);
        field::section(ui, "Transfer function", true, |ui| {
            transfer::show(&mut self.transfer, ui, shown, asked);
        });
        field::section(ui, "Look", true, |ui| look::show(ui, shown.state, asked));
        if let Beholder::Camera = shown.beholder {
            field::section(ui, "Camera", true, |ui| camera::show(&mut self.tool, ui, shown.state, asked));
        }
        field::section(ui, "Clipping", false, |ui| clip::show(ui, shown.state, asked));
        field::section(ui, "Stereo", false, |ui| stereo::show(ui, shown, asked));
    }
}

/// Commands that a pass asks for, in order.
#[derive(Debug, Default)]
pub(crate) struct Asked {
    commands: Vec<Command>,
}

impl Asked {
    fn edit(&mut self, edit: Edit) {
        self.commands.push(edit.into());
    }

    fn command(&mut self, command: Command) {
        self.commands.push(command);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::script::{Button, Drag, Dropped};
    use crate::viewer::state::Plane;
    use egui::{
        Context, Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, RawInput, Shape, TouchPhase,
        Vec2,
    };
    use wheatstone_core::volume::Grid;

    const SIZE: Vec2 = Vec2::new(800.0, 500.0);

    /// What has come of events, where the picture is, and the texts about it.
    struct Played {
        state: State,
        picture: Rect,
        texts: Vec<String>,
        /// What has been asked for but edits.
        commands: Vec<Command>,
    }

    /// What comes of events if so many come with each refresh.
    fn play(beholder: &Beholder, state: State, events: &[Event], per_refresh: usize) -> Played {
        play_in(SIZE, beholder, state, events, per_refresh)
    }

    /// The same in a window of some points.
    fn play_in(
        size: Vec2,
        beholder: &Beholder,
        mut state: State,
        events: &[Event],
        per_refresh: usize,
    ) -> Played {
        let (context, mut desk, timings) = (Context::default(), Desk::new(), Timings::default());
        let grid = Grid::centred([8, 8, 8], [1.0; 3]).unwrap();
        let up = state.look.up.direction();
        let placement = Placement::of_grid(&grid, wheatstone_core::view::world_from_patient(&grid, up));
        let (mut picture, mut texts, mut commands) = (Rect::NOTHING, Vec::new(), Vec::new());
        let mut refresh = |number: usize, events: &[Event]| {
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
                time: Some(0.004 * number as f64),
                focused: true,
                events: events.to_vec(),
                ..RawInput::default()
            };
            let output = run_passes(&context, input, |ui| {
                let shown = Shown {
                    state: &state,
                    beholder,
                    facts: None,
                    preset: None,
                    placement: Some(placement),
                    progress: None,
                    notes: &[],
                    timings: &timings,
                    device: "",
                    quality: "",
                    refresh_ms: 17.0,
                };
                let pass = desk.show(ui, &shown);
                picture = pass.picture;
                for command in pass.commands {
                    match command {
                        Command::Edit(edit) => state.apply(&edit).unwrap(),
                        other => commands.push(other),
                    }
                }
            });
            texts = output.shapes.iter().filter_map(|clipped| text(&clipped.shape)).collect();
            output.drop_without_applying_deltas();
        };
        (0..3).for_each(|number| refresh(number, &[]));
        events.chunks(per_refresh).enumerate().for_each(|(number, events)| refresh(3 + number, events));
        Played { state, picture, texts, commands }
    }

    fn text(shape: &Shape) -> Option<String> {
        match shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        }
    }

    fn after(state: &State, events: &[Event], per_refresh: usize) -> State {
        play(&Beholder::Camera, state.clone(), events, per_refresh).state
    }

    fn drag(from: [f32; 2], to: [f32; 2], button: Button, ctrl: bool) -> Vec<Event> {
        let drag = Drag { from, to, ms: 400, button, shift: false, ctrl };
        drag.events().map(|(_, event)| event).collect()
    }

    fn assert_same_however_many_at_a_time(state: &State, events: &[Event]) -> State {
        let one_by_one = after(state, events, 1);
        assert!(play(&Beholder::Camera, state.clone(), events, 1).commands.is_empty());
        assert_ne!(&one_by_one, state);
        for per_refresh in [2, 5, 17, events.len()] {
            assert_eq!(after(state, events, per_refresh), one_by_one, "{per_refresh} at a time");
        }
        one_by_one
    }

    #[test]
    fn a_drag_counts_in_full_however_many_of_its_events_come_at_once() {
        let state = State::default();
        let events = drag([60.0, 150.0], [160.0, 200.0], Button::Left, false);
        let orbited = assert_same_however_many_at_a_time(&state, &events);
        // The shorter side of a picture is half a turn.
        let side = play(&Beholder::Camera, state.clone(), &[], 1).picture.width();
        assert!(side < 500.0, "beside the panels");
        let side = f64::from(side);
        let turned_deg = orbited.camera.azimuth_deg - state.camera.azimuth_deg;
        assert!((turned_deg + 180.0 * 100.0 / side).abs() < 1e-4, "{turned_deg}");
        let raised_deg = orbited.camera.elevation_deg - state.camera.elevation_deg;
        assert!((raised_deg - 180.0 * 50.0 / side).abs() < 1e-4, "{raised_deg}");
        let events = drag([60.0, 150.0], [160.0, 150.0], Button::Left, true);
        let windowed = assert_same_however_many_at_a_time(&state, &events);
        assert_eq!(windowed.camera, state.camera);
        let width = |state: &State| state.transfer.window[1] - state.transfer.window[0];
        assert!((width(&windowed) / width(&state) - (200.0 / side).exp()).abs() < 1e-3);
        assert_same_however_many_at_a_time(&state, &drag([60.0, 150.0], [90.0, 110.0], Button::Right, false));
    }

    #[test]
    fn two_drags_at_once_are_two_drags() {
        let state = State::default();
        let mut events = drag([60.0, 150.0], [160.0, 200.0], Button::Left, false);
        events.extend(drag([160.0, 200.0], [60.0, 150.0], Button::Left, false));
        let there_and_back = after(&state, &events, events.len());
        assert!((there_and_back.camera.azimuth_deg - state.camera.azimuth_deg).abs() < 1e-4);
    }

    #[test]
    fn handles_follow_the_pointer_however_many_of_its_moves_come_at_once() {
        let mut state = State::default();
        state.apply(&Edit::ClipHandles(true)).unwrap();
        state.apply(&Edit::ClipPlane(Some(Plane::default()))).unwrap();
        let area = play(&Beholder::Camera, state.clone(), &[], 1).picture;
        let size = [area.width() as u32, area.height() as u32];
        let eye = projection::Projection::new(state.camera.view(size).unwrap(), area);
        // The patient is upright: the third axis points up.
        let above = |state: &State| eye.place(glam::DVec3::Y * (state.clip.box_hi.z - 0.5)).unwrap();
        let from = above(&state);
        let events = drag(from.into(), (from + egui::vec2(5.0, 70.0)).into(), Button::Left, false);
        let cut = assert_same_however_many_at_a_time(&state, &events);
        assert!((above(&cut).y - from.y - 70.0).abs() < 2.0, "{:?} {from:?}", above(&cut));
        let foot = eye.place(glam::DVec3::ZERO).unwrap();
        let events = drag(foot.into(), (foot + egui::vec2(40.0, 10.0)).into(), Button::Left, false);
        let moved = assert_same_however_many_at_a_time(&state, &events);
        assert!(moved.camera == state.camera && moved.clip.plane != state.clip.plane);
    }

    fn press(key: Key, modifiers: Modifiers) -> Event {
        Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
    }

    #[test]
    fn keys_that_are_held_act_once_but_for_those_that_raise_and_lower() {
        let held = |key, modifiers| {
            let events: Vec<Event> = std::iter::once(Event::ModifiersChanged(modifiers))
                .chain((0..6).map(|_| press(key, modifiers)))
                .collect();
            play(&Beholder::Camera, State::default(), &events, 1)
        };
        assert_eq!(held(Key::R, Modifiers::COMMAND).commands, [Command::Reload]);
        assert_eq!(held(Key::S, Modifiers::COMMAND).commands, [Command::SaveNew("view.json".into())]);
        assert_eq!(
            held(Key::F12, Modifiers::NONE).commands,
            [Command::ScreenshotNew("screenshot.png".into())]
        );
        let picture = held(Key::H, Modifiers::NONE).picture;
        assert_eq!(picture.width(), SIZE.x, "hidden once, not shown again");
        let raised = held(Key::I, Modifiers::NONE).state.look.isovalue - State::default().look.isovalue;
        assert!((raised - 0.12).abs() < 1e-9, "{raised}");
    }

    #[test]
    fn the_list_of_keys_scrolls_to_its_end_in_a_small_window() {
        let opened = [press(Key::Questionmark, Modifiers::NONE)];
        let idle = || std::iter::repeat_n(Event::PointerMoved(egui::pos2(250.0, 251.0)), 200);
        let end = |events: &[Event]| {
            let events: Vec<Event> = events.iter().cloned().chain(idle()).collect();
            let texts = play(&Beholder::Camera, State::default(), &events, 1).texts;
            assert!(texts.iter().any(|text| text == "Keys and mouse"), "{texts:?}");
            texts.iter().any(|text| text == "remove a point")
        };
        let wheel = |_| {
            [
                Event::PointerMoved(egui::pos2(250.0, 250.0)),
                Event::MouseWheel {
                    unit: MouseWheelUnit::Point,
                    delta: egui::vec2(0.0, -400.0),
                    phase: TouchPhase::Move,
                    source: MouseWheelSource::Wheel,
                    modifiers: Modifiers::NONE,
                },
            ]
        };
        let scrolled: Vec<Event> = opened.iter().cloned().chain((0..4).flat_map(wheel)).collect();
        assert!(!end(&opened), "it is longer than the window");
        assert!(end(&scrolled), "scrolled to its end");
    }

    #[test]
    fn a_file_that_is_dropped_is_opened_once_whatever_comes_with_it() {
        let (context, mut desk, timings) = (Context::default(), Desk::new(), Timings::default());
        let state = State::default();
        let mut commands = Vec::new();
        for hides_panels in [false, true] {
            desk.hides_panels = hides_panels;
            let file = Dropped::new(std::path::Path::new("/a/b.nrrd"));
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, SIZE)),
                dropped_files: vec![std::sync::Arc::new(file)],
                events: drag([60.0, 150.0], [160.0, 200.0], Button::Left, false),
                ..RawInput::default()
            };
            let output = run_passes(&context, input, |ui| {
                let shown = Shown {
                    state: &state,
                    beholder: &Beholder::Camera,
                    facts: None,
                    preset: None,
                    placement: None,
                    progress: None,
                    notes: &[],
                    timings: &timings,
                    refresh_ms: 17.0,
                    device: "",
                    quality: "",
                };
                let asked = desk.show(ui, &shown).commands;
                commands.extend(asked.into_iter().filter(|asked| !matches!(asked, Command::Edit(_))));
            });
            output.drop_without_applying_deltas();
        }
        let opened = Command::Drop(vec!["/a/b.nrrd".into()]);
        assert_eq!(commands, [opened.clone(), opened]);
    }

    /// Before both eyes of a headset there is what the first camera sees.
    fn headset() -> Beholder {
        let view = State::default().camera.view([640, 720]).unwrap();
        Beholder::Headset { views: Some(Box::new([view; 2])) }
    }

    #[test]
    fn in_a_headset_nothing_moves_the_camera_and_a_drag_changes_the_window() {
        let state = State::default();
        let after = |events: &[Event]| play(&headset(), state.clone(), events, 1).state;
        let windowed = after(&drag([200.0, 150.0], [250.0, 150.0], Button::Left, false));
        assert!(windowed.transfer.window != state.transfer.window && windowed.camera == state.camera);
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Point,
            delta: egui::vec2(0.0, 50.0),
            phase: TouchPhase::Move,
            source: MouseWheelSource::Wheel,
            modifiers: Modifiers::NONE,
        };
        let mut events = drag([200.0, 150.0], [250.0, 190.0], Button::Right, false);
        events.extend([wheel]);
        events.extend([Key::W, Key::ArrowLeft, Key::Home].map(|key| press(key, Modifiers::NONE)));
        assert_ne!(play(&Beholder::Camera, state.clone(), &events, 1).state.camera, state.camera);
        assert_eq!(after(&events), state);
    }

    #[test]
    fn handles_are_where_a_headsets_eyes_see_them() {
        let mut state = State::default();
        state.apply(&Edit::ClipHandles(true)).unwrap();
        let area = play(&headset(), state.clone(), &[], 1).picture;
        assert!((area.width() / area.height() - 640.0 / 720.0).abs() < 1e-4, "{area}");
        let eye = projection::Projection::new(state.camera.view([640, 720]).unwrap(), area);
        let above = eye.place(glam::DVec3::Y * (state.clip.box_hi.z - 0.5)).unwrap();
        let events = drag(above.into(), (above + egui::vec2(0.0, 30.0)).into(), Button::Left, false);
        let cut = play(&headset(), state.clone(), &events, 1).state;
        assert!(cut.clip.box_hi.z < state.clip.box_hi.z && cut.transfer == state.transfer);
    }

    #[test]
    fn panels_hold_nothing_that_a_headset_does_not_follow() {
        let mut state = State::default();
        state.stereo.arrangement = crate::viewer::state::Arrangement::SideBySide;
        let of_camera = ["Camera", "Refresh"];
        let holds = |beholder: &Beholder, wanted: &str| {
            let texts = play_in(egui::vec2(800.0, 1200.0), beholder, state.clone(), &[], 1).texts;
            texts.iter().any(|text| text == wanted)
        };
        assert!(of_camera.iter().all(|text| holds(&Beholder::Camera, text) && !holds(&headset(), text)));
        assert!(holds(&Beholder::Camera, "17 ms") && holds(&headset(), "17 ms"));
    }

    #[test]
    fn points_of_the_transfer_function_follow_the_pointer_however_many_of_its_moves_come_at_once() {
        let state = State::default();
        // The last point is at the right end of the graph, on top.
        let events = |y: f32| drag([776.0, y], [740.0, y + 40.0], Button::Left, false);
        let grips = |y: &f32| after(&state, &events(*y), 1).transfer != state.transfer;
        let y = (60..200).map(|y| y as f32).find(grips).unwrap();
        let moved = assert_same_however_many_at_a_time(&state, &events(y));
        assert!(moved.transfer.opacity != state.transfer.opacity && moved.camera == state.camera);
    }
}
