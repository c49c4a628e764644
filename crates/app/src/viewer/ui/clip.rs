//! Box and plane.

use super::Asked;
use super::field::{dragged, rows};
use crate::viewer::state::{Edit, Plane, State};
use egui::Ui;

pub(super) fn show(ui: &mut Ui, state: &State, asked: &mut Asked) {
    let clip = &state.clip;
    ui.horizontal(|ui| {
        let mut has_handles = clip.has_handles;
        if ui.checkbox(&mut has_handles, "handles in the picture").changed() {
            asked.edit(Edit::ClipHandles(has_handles));
        }
        if ui.small_button("reset").clicked() {
            asked.edit(Edit::ResetClip);
        }
    });
    rows(ui, "box", |ui| {
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            ui.label(format!("Box {name}"));
            ui.horizontal(|ui| {
                let ends = [(axis, clip.box_lo[axis]), (axis + 3, clip.box_hi[axis])];
                for (face, at) in ends {
                    if let Some(to) = dragged(ui, at, 0.0..=1.0, 0.005) {
                        asked.edit(Edit::MoveFace { face, to });
                    }
                }
            });
            ui.end_row();
        }
        ui.label("Plane");
        let mut has_plane = clip.plane.is_some();
        if ui.checkbox(&mut has_plane, "cut").changed() {
            asked.edit(Edit::ClipPlane(has_plane.then(Plane::default)));
        }
        ui.end_row();
        if let Some(plane) = clip.plane {
            ui.label("Offset, m");
            if let Some(offset_m) = dragged(ui, plane.offset_m, -2.0..=2.0, 0.005) {
                asked.edit(Edit::ClipPlane(Some(Plane { offset_m, ..plane })));
            }
            ui.end_row();
        }
    });
}
