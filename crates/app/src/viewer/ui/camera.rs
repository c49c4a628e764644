//! Where the eye is, and what dragging the picture does.

use super::Asked;
use super::field::{rows, slider};
use super::pointer::Tool;
use crate::viewer::state::{Edit, Face, State};
use egui::Ui;

pub(super) fn show(tool: &mut Tool, ui: &mut Ui, state: &State, asked: &mut Asked) {
    ui.horizontal(|ui| {
        for other in Tool::ALL {
            ui.selectable_value(tool, other, other.name()).on_hover_text(other.help());
        }
    });
    ui.horizontal_wrapped(|ui| {
        for face in Face::ALL {
            if ui.small_button(face.name()).clicked() {
                asked.edit(Edit::Face(face));
            }
        }
        if ui.small_button("reset").clicked() {
            asked.edit(Edit::ResetCamera);
        }
    });
    let camera = &state.camera;
    rows(ui, "camera", |ui| {
        slider(ui, "Field of view", camera.fov_deg, 10.0..=120.0, asked, Edit::FieldOfView);
        ui.label("Eye");
        ui.weak(format!(
            "{:.0}° {:.0}° {:.2} m",
            camera.azimuth_deg, camera.elevation_deg, camera.distance_m
        ));
        ui.end_row();
    });
}
