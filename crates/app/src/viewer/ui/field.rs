//! Fields of panels.

use super::Asked;
use crate::viewer::state::Edit;
use egui::{CollapsingHeader, ComboBox, DragValue, Grid, RichText, Slider, Ui};
use std::ops::RangeInclusive;

/// A part of a panel that can be folded.
pub(super) fn section(ui: &mut Ui, title: &str, is_open: bool, contents: impl FnOnce(&mut Ui)) {
    CollapsingHeader::new(RichText::new(title).strong()).default_open(is_open).show(ui, |ui| {
        contents(ui);
        ui.add_space(4.0);
    });
}

/// Names on the left, fields on the right.
pub(super) fn rows(ui: &mut Ui, id: &str, contents: impl FnOnce(&mut Ui)) {
    Grid::new(id).num_columns(2).min_col_width(76.0).show(ui, contents);
}

/// One of a few.
pub(super) fn choice<T: Clone + PartialEq>(
    ui: &mut Ui,
    name: &str,
    all: &[(T, &str)],
    value: T,
    asked: &mut Asked,
    edit: impl Fn(T) -> Edit,
) {
    ui.label(name);
    let text = all.iter().find(|(other, _)| *other == value).map_or("…", |(_, text)| *text);
    ComboBox::from_id_salt(name).selected_text(text).width(150.0).show_ui(ui, |ui| {
        for (other, text) in all {
            if ui.selectable_label(*other == value, *text).clicked() {
                asked.edit(edit(other.clone()));
            }
        }
    });
    ui.end_row();
}

/// A number on a slider.
pub(super) fn slider(
    ui: &mut Ui,
    name: &str,
    value: f64,
    range: RangeInclusive<f64>,
    asked: &mut Asked,
    edit: impl Fn(f64) -> Edit,
) {
    ui.label(name);
    let mut changed = value;
    if ui.add(Slider::new(&mut changed, range)).changed() {
        asked.edit(edit(changed));
    }
    ui.end_row();
}

/// A number that is dragged; nothing where it stays.
pub(super) fn dragged(ui: &mut Ui, value: f64, range: RangeInclusive<f64>, speed: f64) -> Option<f64> {
    let mut changed = value;
    ui.add(DragValue::new(&mut changed).range(range).speed(speed).max_decimals(3))
        .changed()
        .then_some(changed)
}
