//! Panels, picture and keys: they read what is shown and ask for commands; nothing else.

mod camera;
mod clip;
mod field;
mod files;
mod handles;
mod keys;
mod look;
mod pace;
mod picture;
mod pointer;
mod projection;
mod stereo;
mod theme;
mod toasts;
mod transfer;

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
    pub(crate) facts: Option<&'a Facts>,
    pub(crate) placement: Option<Placement>,
    pub(crate) progress: Option<Progress>,
    pub(crate) notes: &'a [Note],
    pub(crate) timings: &'a Timings,
    /// What casts, and how fine the picture is.
    pub(crate) device: &'a str,
    pub(crate) quality: &'a str,
}

/// What panels remember of themselves.
pub(crate) struct Desk {
    hides_panels: bool,
    shows_keys: bool,
    tool: Tool,
    files: files::Fields,
    transfer: transfer::Grip,
    handles: handles::Grip,
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
        }
    }

    /// Lays everything out.
    pub(crate) fn show(&mut self, ui: &mut Ui, shown: &Shown<'_>) -> Pass {
        let mut asked = Asked::default();
        keys::listen(self, ui, shown.state, &mut asked);
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
                let area = ui.max_rect();
                picture::show(self, ui, area, shown, &mut asked);
                area
            })
            .inner;
        if self.shows_keys {
            self.shows_keys = keys::show(ui.ctx());
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
        field::section(ui, "Camera", true, |ui| camera::show(&mut self.tool, ui, shown.state, asked));
        field::section(ui, "Clipping", false, |ui| clip::show(ui, shown.state, asked));
        field::section(ui, "Stereo", false, |ui| stereo::show(ui, shown.state, asked));
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
