//! Messages and progress over the picture.

use super::Shown;
use super::theme::{ACCENT, ALARM};
use crate::viewer::notes::Tone;
use egui::{Align2, Color32, FontId, Rect, Stroke, StrokeKind, Ui, pos2, vec2};

pub(super) fn show(ui: &Ui, picture: Rect, shown: &Shown<'_>) {
    let painter = ui.painter_at(picture);
    let font = FontId::proportional(14.0);
    let mut bottom = picture.bottom() - 12.0;
    for note in shown.notes.iter().rev() {
        let color = match note.tone {
            Tone::Done => Color32::from_gray(215),
            Tone::Warning => ACCENT,
            Tone::Failed => ALARM,
        };
        let text = painter.layout(note.text.clone(), font.clone(), color, picture.width() - 48.0);
        let area = Rect::from_min_size(
            pos2(picture.left() + 12.0, bottom - text.size().y - 10.0),
            text.size() + vec2(16.0, 10.0),
        );
        painter.rect(
            area,
            4.0,
            Color32::from_black_alpha(190),
            Stroke::new(1.0, color.gamma_multiply(0.4)),
            StrokeKind::Inside,
        );
        painter.galley(area.min + vec2(8.0, 5.0), text, color);
        bottom = area.top() - 6.0;
    }
    if let Some(progress) = shown.progress {
        let percent = progress.done.map(|done| format!(" {:.0} %", 100.0 * done)).unwrap_or_default();
        let text = format!("{}…{percent}", progress.what);
        painter.text(picture.center_top() + vec2(0.0, 14.0), Align2::CENTER_TOP, text, font, ACCENT);
    } else if shown.facts.is_none() {
        let text = "Drop a volume here: .nii .nii.gz .nrrd .mha .raw";
        painter.text(
            picture.center(),
            Align2::CENTER_CENTER,
            text,
            FontId::proportional(18.0),
            Color32::GRAY,
        );
    }
}
