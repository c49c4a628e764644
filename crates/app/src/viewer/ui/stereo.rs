//! One eye, two, or a light-field display.

use super::field::{choice, rows, slider};
use super::{Asked, Beholder, Shown};
use crate::viewer::state::{Arrangement, Edit, EyeMethod, LightField, ShownDisplay};
use egui::Ui;
use glam::DVec3;

pub(super) fn show(ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let stereo = &shown.state.stereo;
    let is_for_headset = matches!(shown.beholder, Beholder::Headset { .. });
    let arrangements: Vec<(Arrangement, &str)> = (shown.state.arrangements().into_iter())
        .filter(|arrangement| !(is_for_headset && arrangement.is_of_display()))
        .map(|arrangement| (arrangement, arrangement.name()))
        .collect();
    let methods = EyeMethod::ALL.map(|method| (method, method.name()));
    rows(ui, "stereo", |ui| {
        choice(ui, "Eyes", &arrangements, stereo.arrangement, asked, Edit::Arrangement);
        if stereo.has_two_eyes() || is_for_headset {
            choice(ui, "Method", &methods, stereo.method, asked, Edit::EyeMethod);
        }
        if stereo.has_two_eyes() && !is_for_headset {
            slider(ui, "Apart, m", stereo.eye_distance_m, 0.0..=0.2, asked, Edit::EyeDistance);
        }
        if stereo.arrangement.is_of_display() && !is_for_headset {
            display(ui, &shown.state.light_field, stereo.arrangement == Arrangement::LightField, asked);
        }
    });
}

/// The display, and the eye before it if that changes what is seen.
fn display(ui: &mut Ui, light_field: &LightField, has_eye: bool, asked: &mut Asked) {
    let known = ShownDisplay::known();
    let names: Vec<(ShownDisplay, &str)> =
        known.iter().map(|display| (display.clone(), display.name().unwrap_or_default())).collect();
    choice(ui, "Display", &names, light_field.display.clone(), asked, Edit::Display);
    if has_eye {
        let eye_m = light_field.eye_m();
        let reach_m = light_field.usual_eye_m().z;
        slider(ui, "Eye right, m", eye_m.x, -reach_m..=reach_m, asked, |x| {
            Edit::DisplayEye(Some(DVec3 { x, ..eye_m }))
        });
        slider(ui, "Eye away, m", eye_m.z, 0.3 * reach_m..=3.0 * reach_m, asked, |z| {
            Edit::DisplayEye(Some(DVec3 { z, ..eye_m }))
        });
    }
}
