//! The volume, and files to open and to write.

use super::theme::ACCENT;
use super::{Asked, Beholder, Shown};
use crate::viewer::command::Command;
use egui::{ProgressBar, RichText, TextEdit, Ui};
use std::path::PathBuf;

/// What has been typed.
pub(super) struct Fields {
    open: String,
    view: String,
    picture: String,
    turn_pictures: u32,
}

impl Default for Fields {
    fn default() -> Self {
        Self {
            open: String::new(),
            view: "view.json".to_owned(),
            picture: "picture.png".to_owned(),
            turn_pictures: 36,
        }
    }
}

pub(super) fn show(fields: &mut Fields, ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    ui.add_space(6.0);
    match shown.facts {
        Some(facts) => {
            ui.label(RichText::new(&facts.name).strong().size(15.0));
            let [x, y, z] = facts.grid.dims();
            let size = facts.grid.size_mm();
            ui.weak(format!(
                "{x}×{y}×{z} {} · {:.0}×{:.0}×{:.0} mm · {}",
                facts.voxel_type,
                size.x,
                size.y,
                size.z,
                facts.grid.orientation_letters()
            ));
            for warning in &facts.warnings {
                ui.colored_label(ACCENT, warning);
            }
        }
        None => {
            ui.label(RichText::new("no volume yet").size(15.0));
            ui.weak("drop a file here, or name one below");
        }
    }
    if let Some(progress) = shown.progress {
        let bar = ProgressBar::new(progress.done.unwrap_or(0.0)).text(progress.what);
        ui.add(bar.animate(progress.done.is_none()));
    }
    super::field::section(ui, "Files", false, |ui| {
        ui.horizontal(|ui| {
            let is_named = !fields.open.is_empty();
            ui.add(
                TextEdit::singleline(&mut fields.open).hint_text("volume or view.json").desired_width(190.0),
            );
            if ui.add_enabled(is_named, egui::Button::new("Open")).clicked() {
                asked.command(Command::Open(PathBuf::from(&fields.open)));
            }
        });
        ui.horizontal(|ui| {
            ui.add(TextEdit::singleline(&mut fields.view).desired_width(190.0));
            if ui.button("Save view").clicked() {
                asked.command(Command::Save(PathBuf::from(&fields.view)));
            }
        });
        ui.horizontal(|ui| {
            ui.add(TextEdit::singleline(&mut fields.picture).desired_width(190.0));
            let when = match shown.beholder {
                Beholder::Camera => "once it is at rest",
                Beholder::Headset { .. } => "as the eyes see it now",
            };
            if ui.button("Picture").on_hover_text(when).clicked() {
                asked.command(Command::Picture(PathBuf::from(&fields.picture)));
            }
        });
        ui.horizontal(|ui| {
            if let Beholder::Camera = shown.beholder {
                turntable(fields, ui, asked);
            }
            if ui.button("Reload").clicked() {
                asked.command(Command::Reload);
            }
        });
    });
}

fn turntable(fields: &mut Fields, ui: &mut Ui, asked: &mut Asked) {
    if ui.button("Turntable").on_hover_text("numbered pictures of a full turn").clicked() {
        let path = PathBuf::from(&fields.picture);
        asked.command(Command::Turntable { pictures: fields.turn_pictures, path });
    }
    ui.add(egui::DragValue::new(&mut fields.turn_pictures).range(2..=360).suffix(" pictures"));
}
