//! The editor of the transfer function, over a histogram with a logarithmic scale.

use super::field::dragged;
use super::theme::{ACCENT, LINE, WELL};
use super::{Asked, Shown};
use crate::look::ModeName;
use crate::viewer::command::Command;
use crate::viewer::state::{Edit, Transfer};
use egui::{
    Color32, ComboBox, Mesh, Painter, PointerButton, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, pos2,
    vec2,
};
use wheatstone_core::transfer::TransferFunction;

const HEIGHT: f32 = 150.0;
const STRIP: f32 = 16.0;

/// How near the pointer must come, points.
const REACH: f32 = 10.0;

/// Strips that the opacity and the area under it are drawn in, and bars of the histogram.
const STRIPS: usize = 128;

/// Names that `--tf` takes, too.
const PRESETS: [&str; 14] = [
    "auto",
    "ct-bone",
    "ct-soft-tissue",
    "ct-lung",
    "ct-vessels",
    "mri-brain-t1",
    "generic",
    "gray",
    "viridis",
    "inferno",
    "magma",
    "plasma",
    "coolwarm",
    "ramp:0.1..1",
];

/// The point that is being dragged, and the colour that is chosen.
#[derive(Debug, Default)]
pub(super) struct Grip {
    opacity: Option<usize>,
    color: Option<usize>,
    chosen_color: Option<usize>,
}

pub(super) fn show(grip: &mut Grip, ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let transfer = &shown.state.transfer;
    ui.horizontal(|ui| {
        presets(grip, ui, shown.preset, asked);
        color_of_point(grip, ui, transfer, asked);
    });
    opacity_graph(grip, ui, shown, asked);
    color_strip(grip, ui, transfer, asked);
    window(ui, shown, asked);
}

fn presets(grip: &mut Grip, ui: &mut Ui, chosen: Option<&str>, asked: &mut Asked) {
    ComboBox::from_id_salt("presets").selected_text(chosen.unwrap_or("presets")).show_ui(ui, |ui| {
        for preset in PRESETS {
            if ui.selectable_label(chosen == Some(preset), preset).clicked() {
                grip.chosen_color = None;
                asked.command(Command::Preset(preset.to_owned()));
            }
        }
    });
}

fn color_of_point(grip: &Grip, ui: &mut Ui, transfer: &Transfer, asked: &mut Asked) {
    let Some((index, &[at, r, g, b])) =
        grip.chosen_color.and_then(|index| Some((index, transfer.color.get(index)?)))
    else {
        ui.weak("click a colour below");
        return;
    };
    let mut rgb = [r, g, b];
    if ui.color_edit_button_rgb(&mut rgb).changed() {
        let [r, g, b] = rgb.map(|channel| channel.clamp(0.0, 1.0));
        asked.edit(Edit::SetColorPoint { index, to: [at, r, g, b] });
    }
    ui.weak(format!("colour at {at:.3}"));
}

/// Opacities are drawn by their cube root: those of one voxel length are small.
fn height_of(alpha: f32) -> f32 {
    alpha.max(0.0).cbrt()
}

/// The inverse of [`height_of`].
fn alpha_of(height: f32) -> f32 {
    height.clamp(0.0, 1.0).powi(3)
}

fn opacity_graph(grip: &mut Grip, ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let transfer = &shown.state.transfer;
    let width = ui.available_width();
    let (area, response) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::click_and_drag());
    let painter = ui.painter_at(area);
    painter.rect_filled(area, 3.0, WELL);
    let inner = area.shrink2(vec2(6.0, 6.0));
    draw_histogram(&painter, inner, shown);
    if let Ok(function) = transfer.function() {
        draw_function(&painter, inner, &function);
    }
    let place = |&[at, alpha]: &[f32; 2]| {
        pos2(inner.left() + at * inner.width(), inner.bottom() - height_of(alpha) * inner.height())
    };
    let value = |pointer: Pos2| {
        let at = ((pointer.x - inner.left()) / inner.width()).clamp(0.0, 1.0);
        [at, alpha_of((inner.bottom() - pointer.y) / inner.height())]
    };
    let places: Vec<Pos2> = transfer.opacity.iter().map(place).collect();
    let act = follow(&mut grip.opacity, &response, &places);
    for (index, &place) in places.iter().enumerate() {
        let is_active = grip.opacity == Some(index);
        let fill = if is_active { ACCENT } else { Color32::from_gray(30) };
        painter.circle(place, 4.0, fill, Stroke::new(1.5, Color32::WHITE));
    }
    if shown.state.look.mode == ModeName::Iso {
        let x = inner.left() + shown.state.look.isovalue as f32 * inner.width();
        painter.vline(x, inner.y_range(), Stroke::new(1.5, ACCENT));
    }
    match act {
        Some(Act::Move(index, to)) => asked.edit(Edit::MoveOpacityPoint { index, to: value(to) }),
        Some(Act::Add(at)) => asked.edit(Edit::AddOpacityPoint(value(at))),
        Some(Act::Remove(index)) if places.len() > 1 => asked.edit(Edit::RemoveOpacityPoint(index)),
        Some(Act::Remove(_) | Act::Choose(_)) | None => {}
    }
}

fn color_strip(grip: &mut Grip, ui: &mut Ui, transfer: &Transfer, asked: &mut Asked) {
    let width = ui.available_width();
    let (area, response) = ui.allocate_exact_size(vec2(width, STRIP + 8.0), Sense::click_and_drag());
    let painter = ui.painter_at(area);
    let inner = Rect::from_min_size(area.min + vec2(6.0, 0.0), vec2(area.width() - 12.0, STRIP));
    if let Ok(function) = transfer.function() {
        let mut mesh = Mesh::default();
        for strip in 0..=STRIPS {
            let at = strip as f32 / STRIPS as f32;
            let x = inner.left() + at * inner.width();
            let color = color32(function.color_at(at), 1.0);
            mesh.colored_vertex(pos2(x, inner.top()), color);
            mesh.colored_vertex(pos2(x, inner.bottom()), color);
        }
        join_strips(&mut mesh);
        painter.add(mesh);
    }
    let places: Vec<Pos2> = transfer
        .color
        .iter()
        .map(|point| pos2(inner.left() + point[0] * inner.width(), inner.bottom() + 2.0))
        .collect();
    for (index, &place) in places.iter().enumerate() {
        let is_chosen = grip.chosen_color == Some(index);
        let stroke = if is_chosen { Stroke::new(2.0, ACCENT) } else { Stroke::new(1.0, LINE) };
        let [_, r, g, b] = transfer.color[index];
        painter.circle(place, 4.0, color32([r, g, b], 1.0), stroke);
    }
    let value = |pointer: Pos2| ((pointer.x - inner.left()) / inner.width()).clamp(0.0, 1.0);
    match follow(&mut grip.color, &response, &places) {
        Some(Act::Move(index, to)) => {
            grip.chosen_color = Some(index);
            if let Some(&[_, r, g, b]) = transfer.color.get(index) {
                asked.edit(Edit::SetColorPoint { index, to: [value(to), r, g, b] });
            }
        }
        Some(Act::Choose(index)) => grip.chosen_color = Some(index),
        Some(Act::Add(at)) => {
            grip.chosen_color = None;
            asked.edit(Edit::AddColorPoint(value(at)));
        }
        Some(Act::Remove(index)) if places.len() > 1 => {
            grip.chosen_color = None;
            asked.edit(Edit::RemoveColorPoint(index));
        }
        Some(Act::Remove(_)) | None => {}
    }
}

/// What the pointer does to points.
enum Act {
    Choose(usize),
    Move(usize, Pos2),
    Add(Pos2),
    Remove(usize),
}

/// A drag moves a point, a double click adds one, a second button's click removes one.
fn follow(held: &mut Option<usize>, response: &Response, places: &[Pos2]) -> Option<Act> {
    let pointer = response.interact_pointer_pos();
    let under = pointer.and_then(|pointer| nearest(places, pointer));
    if response.drag_started_by(PointerButton::Primary) {
        // By now the pointer may have moved on.
        let origin = response.ctx.input(|input| input.pointer.press_origin());
        *held = origin.and_then(|origin| nearest(places, origin));
    }
    // Another function may have fewer points.
    *held = held.filter(|&index| response.dragged() && index < places.len());
    let act = |index: usize| {
        if response.secondary_clicked() {
            Some(Act::Remove(index))
        } else if response.clicked() {
            Some(Act::Choose(index))
        } else {
            None
        }
    };
    match (*held, pointer) {
        (Some(index), Some(pointer)) => Some(Act::Move(index, pointer)),
        (None, Some(pointer)) if response.double_clicked() && under.is_none() => Some(Act::Add(pointer)),
        _ => under.and_then(act),
    }
}

fn nearest(places: &[Pos2], pointer: Pos2) -> Option<usize> {
    let distance = |&(_, place): &(usize, &Pos2)| place.distance(pointer);
    let (index, _) = places
        .iter()
        .enumerate()
        .filter(|point| distance(point) < REACH)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    Some(index)
}

fn draw_histogram(painter: &Painter, area: Rect, shown: &Shown<'_>) {
    let (Some(facts), Ok(window)) = (shown.facts, shown.state.transfer.window()) else { return };
    let counts = facts.counts(window, STRIPS);
    let log = |count: u64| (count as f32).ln_1p();
    let highest = counts.iter().copied().map(log).fold(1.0, f32::max);
    let step = area.width() / STRIPS as f32;
    for (index, &count) in counts.iter().enumerate() {
        let left = area.left() + index as f32 * step;
        let top = area.bottom() - log(count) / highest * area.height();
        let bar = Rect::from_min_max(pos2(left, top), pos2(left + step, area.bottom()));
        painter.rect_filled(bar, 0.0, Color32::from_rgb(52, 60, 72));
    }
}

fn draw_function(painter: &Painter, area: Rect, function: &TransferFunction) {
    let mut mesh = Mesh::default();
    for strip in 0..=STRIPS {
        let at = strip as f32 / STRIPS as f32;
        let x = area.left() + at * area.width();
        let color = color32(function.color_at(at), 0.65);
        mesh.colored_vertex(
            pos2(x, area.bottom() - height_of(function.opacity_at(at)) * area.height()),
            color,
        );
        mesh.colored_vertex(pos2(x, area.bottom()), color);
    }
    let curve = mesh.vertices.iter().step_by(2).map(|vertex| vertex.pos).collect();
    join_strips(&mut mesh);
    painter.add(mesh);
    painter.add(Shape::line(curve, Stroke::new(1.5, Color32::WHITE)));
}

/// Makes quads of pairs of vertices, one pair after the other.
fn join_strips(mesh: &mut Mesh) {
    let pairs = mesh.vertices.len() as u32 / 2;
    for first in (0..pairs.saturating_sub(1)).map(|pair| 2 * pair) {
        mesh.add_triangle(first, first + 1, first + 2);
        mesh.add_triangle(first + 1, first + 2, first + 3);
    }
}

fn color32([r, g, b]: [f32; 3], alpha: f32) -> Color32 {
    let [r, g, b] = [r, g, b].map(|channel| (channel * 255.0 + 0.5) as u8);
    Color32::from_rgb(r, g, b).gamma_multiply(alpha)
}

fn window(ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let [lo, hi] = shown.state.transfer.window;
    let full = shown.facts.map(|facts| facts.full_window);
    let width = full.map_or(hi - lo, |full| full.hi() - full.lo());
    let bounds = full.map_or([lo, hi], |full| [full.lo().min(lo), full.hi().max(hi)]);
    ui.horizontal(|ui| {
        ui.label("Window");
        let speed = 0.004 * width;
        if let Some(lo) = dragged(ui, lo, bounds[0]..=hi, speed).filter(|&to| to < hi) {
            asked.edit(Edit::Window([lo, hi]));
        }
        ui.label("to");
        if let Some(hi) = dragged(ui, hi, lo..=bounds[1], speed).filter(|&to| lo < to) {
            asked.edit(Edit::Window([lo, hi]));
        }
        if let Some(full) = full
            && ui.small_button("full").clicked()
        {
            asked.edit(Edit::Window([full.lo(), full.hi()]));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer_spec;

    #[test]
    fn every_preset_has_a_name_that_is_known() {
        for preset in PRESETS {
            assert!(transfer_spec::parse(preset).is_ok(), "{preset}");
        }
    }

    #[test]
    fn heights_and_opacities_are_inverse() {
        for alpha in [0.0, 0.001, 0.3, 1.0] {
            assert!((alpha_of(height_of(alpha)) - alpha).abs() < 1e-6);
        }
        assert_eq!(alpha_of(7.0), 1.0);
    }
}
