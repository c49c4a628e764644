//! One eye or two.

use super::Asked;
use super::field::{choice, rows, slider};
use crate::viewer::state::{Arrangement, Edit, EyeMethod, State};
use egui::Ui;

pub(super) fn show(ui: &mut Ui, state: &State, asked: &mut Asked) {
    let stereo = &state.stereo;
    let arrangements = Arrangement::ALL.map(|arrangement| (arrangement, arrangement.name()));
    let methods = EyeMethod::ALL.map(|method| (method, method.name()));
    rows(ui, "stereo", |ui| {
        choice(ui, "Eyes", &arrangements, stereo.arrangement, asked, Edit::Arrangement);
        if stereo.arrangement != Arrangement::Mono {
            choice(ui, "Method", &methods, stereo.method, asked, Edit::EyeMethod);
            slider(ui, "Apart, m", stereo.eye_distance_m, 0.0..=0.2, asked, Edit::EyeDistance);
        }
    });
}
