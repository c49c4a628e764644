//! Colours and spaces.

use egui::{Color32, Context, CornerRadius, Stroke, Theme, Visuals};

/// What is active.
pub(super) const ACCENT: Color32 = Color32::from_rgb(242, 160, 61);
/// What is wrong or late.
pub(super) const ALARM: Color32 = Color32::from_rgb(235, 87, 87);
/// Lines over the picture.
pub(super) const LINE: Color32 = Color32::from_rgb(200, 208, 220);
/// Behind panels, 0 to 1.
pub(crate) const PANEL: [f64; 3] = [24.0 / 255.0, 27.0 / 255.0, 33.0 / 255.0];
/// Behind graphs.
pub(super) const WELL: Color32 = Color32::from_rgb(14, 16, 20);

/// Gives a context the program's look: dark, so that pictures keep their contrast.
pub(crate) fn dress(context: &Context) {
    context.set_theme(Theme::Dark);
    context.set_visuals(Visuals {
        window_fill: Color32::from_rgb(28, 31, 38),
        extreme_bg_color: WELL,
        selection: egui::style::Selection {
            bg_fill: ACCENT.gamma_multiply(0.45),
            stroke: Stroke::new(1.0, ACCENT),
        },
        window_corner_radius: CornerRadius::same(6),
        ..Visuals::dark()
    });
    context.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.spacing.slider_width = 130.0;
        style.interaction.selectable_labels = false;
    });
}
