//! How long refreshes take, beside how long they may.

use super::field::{choice, rows, slider};
use super::theme::{ACCENT, ALARM, WELL};
use super::{Asked, Beholder, Shown};
use crate::viewer::state::{Edit, WarpName};
use egui::{Align2, Color32, FontId, Rect, Sense, Stroke, Ui, pos2, vec2};

const HEIGHT: f32 = 70.0;

/// The budget line is at this part of the height.
const BUDGET_AT: f32 = 0.5;

pub(super) fn show(ui: &mut Ui, shown: &Shown<'_>, asked: &mut Asked) {
    let pace = &shown.state.pace;
    graph(ui, shown);
    ui.weak(shown.quality);
    let warps = WarpName::ALL.map(|warp| (warp, warp.name()));
    rows(ui, "pace", |ui| {
        if let Beholder::Camera = shown.beholder {
            let shown_ms = f64::from(shown.refresh_ms);
            let rates = [(None, "as the display"), (pace.refresh_ms.or(Some(shown_ms)), "fixed")];
            choice(ui, "Refresh", &rates, pace.refresh_ms, asked, Edit::Refresh);
            if let Some(refresh_ms) = pace.refresh_ms {
                slider(ui, "Every, ms", refresh_ms, 5.0..=200.0, asked, |ms| Edit::Refresh(Some(ms)));
            }
        }
        choice(ui, "Warp", &warps, pace.warp, asked, Edit::Warp);
    });
    if let Beholder::Camera = shown.beholder
        && shown.state.warp() != pace.warp
    {
        let [asked, instead] = [pace.warp, shown.state.warp()].map(WarpName::name);
        ui.weak(format!("{instead}: one cast by {asked} is the same to both eyes"));
    }
}

fn graph(ui: &mut Ui, shown: &Shown<'_>) {
    let width = ui.available_width();
    let (area, _) = ui.allocate_exact_size(vec2(width, HEIGHT), Sense::hover());
    let painter = ui.painter_at(area);
    painter.rect_filled(area, 3.0, WELL);
    let budget_ms = shown.refresh_ms;
    let points_per_ms = BUDGET_AT * HEIGHT / budget_ms;
    let frames = shown.timings.recent();
    let step = width / shown.timings.most_recent() as f32;
    for (index, frame) in frames.enumerate() {
        let right = area.right() - index as f32 * step;
        let bar = |ms: f32, color: Color32| {
            let top = (area.bottom() - ms * points_per_ms).max(area.top());
            let corners = [pos2(right - step, top), pos2(right, area.bottom())];
            painter.rect_filled(Rect::from_min_max(corners[0], corners[1]), 0.0, color);
        };
        let is_late = frame.total_ms > 1.1 * budget_ms;
        bar(frame.total_ms, if is_late { ALARM.gamma_multiply(0.8) } else { Color32::from_gray(90) });
        bar(frame.draw_ms, Color32::from_rgb(88, 140, 190));
    }
    let y = area.bottom() - BUDGET_AT * HEIGHT;
    painter.hline(area.x_range(), y, Stroke::new(1.0, ACCENT));
    let font = FontId::proportional(11.0);
    painter.text(
        pos2(area.left() + 4.0, y - 1.0),
        Align2::LEFT_BOTTOM,
        format!("{budget_ms:.0} ms"),
        font.clone(),
        ACCENT,
    );
    let text = shown.timings.described();
    painter.text(area.left_top() + vec2(4.0, 3.0), Align2::LEFT_TOP, text, font, Color32::from_gray(170));
}
