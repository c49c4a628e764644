//! Mode, light, sampling.

use super::Asked;
use super::field::{choice, rows, slider};
use crate::camera::Up;
use crate::look::ModeName;
use crate::viewer::state::{Edit, State};
use egui::Ui;
use wheatstone_core::scene::Shading;

const MODES: [(ModeName, &str); 6] = [
    (ModeName::Dvr, "emission and absorption"),
    (ModeName::Mip, "maximum"),
    (ModeName::Minip, "minimum"),
    (ModeName::Mean, "mean"),
    (ModeName::Xray, "x-ray"),
    (ModeName::Iso, "isosurface"),
];

/// Those that a key goes through.
pub(super) const SHADINGS: [(Shading, &str); 5] = [
    (Shading::None, "none"),
    (Shading::Phong, "phong"),
    (Shading::Shadow, "shadows"),
    (Shading::Ambient, "ambient occlusion"),
    (Shading::Directional { directions: 8 }, "8 directions"),
];

const UPS: [(Up, &str); 6] = [
    (Up::S, "superior"),
    (Up::I, "inferior"),
    (Up::A, "anterior"),
    (Up::P, "posterior"),
    (Up::L, "left"),
    (Up::R, "right"),
];

pub(super) fn show(ui: &mut Ui, state: &State, asked: &mut Asked) {
    let look = &state.look;
    rows(ui, "look", |ui| {
        choice(ui, "Mode", &MODES, look.mode, asked, Edit::Mode);
        if look.mode.is_lit() {
            choice(ui, "Shading", &SHADINGS, look.shading, asked, Edit::Shading);
        }
        if look.mode == ModeName::Iso {
            slider(ui, "Isovalue", look.isovalue, 0.0..=1.0, asked, Edit::Isovalue);
        }
        slider(ui, "Samples", look.sampling_factor, 0.25..=4.0, asked, Edit::SamplingFactor);
        if look.mode == ModeName::Dvr {
            ui.label("");
            let mut preintegrated = look.preintegrated;
            if ui.checkbox(&mut preintegrated, "pre-integrated").changed() {
                asked.edit(Edit::Preintegrated(preintegrated));
            }
            ui.end_row();
        }
        choice(ui, "Up", &UPS, look.up, asked, Edit::Up);
        ui.label("Background");
        let mut background = look.background;
        if ui.color_edit_button_rgb(&mut background).changed() {
            asked.edit(Edit::Background(background));
        }
        ui.end_row();
    });
}
