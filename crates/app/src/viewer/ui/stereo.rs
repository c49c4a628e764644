//! One eye or two.

use super::field::{choice, rows, slider};
use super::{Asked, Beholder, Shown};
use crate::viewer::state::{Arrangement, Edit, EyeMethod};
use egui::Ui;

pub(super) fn show(ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let stereo = &shown.state.stereo;
    let is_for_headset = matches!(shown.beholder, Beholder::Headset { .. });
    let arrangements = Arrangement::ALL.map(|arrangement| (arrangement, arrangement.name()));
    let methods = EyeMethod::ALL.map(|method| (method, method.name()));
    rows(ui, "stereo", |ui| {
        choice(ui, "Eyes", &arrangements, stereo.arrangement, asked, Edit::Arrangement);
        let has_two_eyes = stereo.arrangement != Arrangement::Mono;
        if has_two_eyes || is_for_headset {
            choice(ui, "Method", &methods, stereo.method, asked, Edit::EyeMethod);
        }
        if has_two_eyes && !is_for_headset {
            slider(ui, "Apart, m", stereo.eye_distance_m, 0.0..=0.2, asked, Edit::EyeDistance);
        }
    });
}
