//! The panel above the left hand: what is shown, what is pointed at, and how refreshes go.

use crate::failure::Failure;
use crate::viewer::screen::{Panels, Pictures, Screen};
use crate::viewer::show::Area;
use crate::viewer::state::Arrangement;
use crate::viewer::timings::Timings;
use crate::viewer::ui::dress;
use egui::{Color32, Context, Pos2, RawInput, Rect, RichText, Sense, Ui, Vec2};
use glam::{DQuat, DVec3};
use std::f64::consts::FRAC_PI_4;
use std::time::{Duration, Instant};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Side};
use wheatstone_render::Gpu;

/// Width and height, pixels.
pub(crate) const SIZE: [u32; 2] = [512, 320];

/// Pixels of a point of text, which is to be read at arm's length.
const PIXELS_PER_POINT: f32 = 1.5;

/// How often it is drawn anew.
const EVERY: Duration = Duration::from_millis(200);

/// Height of the graph, points.
const GRAPH: f32 = 40.0;

/// What the panel tells.
pub(crate) struct Told<'a> {
    pub(crate) volume: &'a str,
    /// Mode, window and preset.
    pub(crate) look: &'a str,
    /// Under the hands' pointers, in the file's unit.
    pub(crate) values: [Option<f64>; 2],
    pub(crate) refreshes: &'a str,
    pub(crate) notes: &'a [String],
    pub(crate) timings: &'a Timings,
    pub(crate) period_ms: f32,
}

/// Above the left hand, tilted towards the eyes; nowhere without that hand.
pub(crate) fn place(hands: &[Hand; 2]) -> Option<Pose> {
    let above =
        Pose { position_m: DVec3::new(0.0, 0.08, -0.06), orientation: DQuat::from_rotation_x(-FRAC_PI_4) };
    Some(hands[Side::Left.index()].grip?.of_own(&above))
}

/// Draws the panel.
pub(crate) struct Panel {
    screen: Screen,
    context: Context,
    drawn: Option<Instant>,
}

impl Panel {
    /// For images of a format.
    pub(crate) fn new(gpu: &Gpu, format: wgpu::TextureFormat) -> Self {
        let context = Context::default();
        dress(&context);
        context.set_pixels_per_point(PIXELS_PER_POINT);
        Self { screen: Screen::new(gpu, format), context, drawn: None }
    }

    /// Whether it is time to draw it anew.
    pub(crate) fn is_due(&self) -> bool {
        self.drawn.is_none_or(|drawn| drawn.elapsed() >= EVERY)
    }

    /// Draws it to an image of its size.
    pub(crate) fn draw(
        &mut self,
        gpu: &Gpu,
        image: &wgpu::TextureView,
        told: &Told<'_>,
    ) -> Result<(), Failure> {
        self.drawn = Some(Instant::now());
        let size_points = SIZE.map(|side| side as f32 / PIXELS_PER_POINT);
        let input = RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::from(size_points))),
            ..RawInput::default()
        };
        let mut output = self.context.run_ui(input, |ui| {
            egui::Frame::new().inner_margin(10.0).show(ui, |ui| lay_out(ui, told));
        });
        let mut panels = Panels::new(&self.context, &mut output, SIZE);
        self.screen.update(gpu, &mut panels);
        let nothing = Pictures {
            arrangement: Arrangement::Mono,
            area: Area::whole(SIZE),
            background: [0.0; 3],
            eyes: None,
        };
        self.screen.draw(gpu, image, &nothing, &panels);
        self.screen.free(&panels);
        Ok(gpu.check()?)
    }
}

fn lay_out(ui: &mut Ui, told: &Told<'_>) {
    ui.label(RichText::new(told.volume).strong());
    ui.label(told.look);
    for (hand, value) in ["left", "right"].into_iter().zip(told.values) {
        if let Some(value) = value {
            ui.label(format!("{hand} hand at {value:.4}"));
        }
    }
    ui.label(told.refreshes);
    graph(ui, told.timings, told.period_ms);
    for note in told.notes.iter().rev().take(2) {
        ui.label(RichText::new(note).weak());
    }
}

/// What drawing took of the latest refreshes, the newest at the right, and the time that a refresh has.
fn graph(ui: &mut Ui, timings: &Timings, period_ms: f32) {
    let (rect, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), GRAPH), Sense::hover());
    let painter = ui.painter_at(rect);
    let highest_ms = 1.5 * period_ms.max(1e-3);
    let step = rect.width() / timings.most_recent() as f32;
    let at = |ms: f32| rect.bottom() - rect.height() * (ms / highest_ms).min(1.0);
    for (age, frame) in timings.recent().enumerate() {
        let right = rect.right() - age as f32 * step;
        let color = if frame.draw_ms > period_ms { Color32::LIGHT_RED } else { Color32::LIGHT_BLUE };
        let bar =
            Rect::from_min_max(Pos2::new(right - step, at(frame.draw_ms)), Pos2::new(right, rect.bottom()));
        painter.rect_filled(bar, 0.0, color);
    }
    painter.hline(rect.x_range(), at(period_ms), (1.0, Color32::WHITE));
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Shape;

    /// All texts of a layout.
    fn texts(told: &Told<'_>) -> Vec<String> {
        let context = Context::default();
        let output = context.run_ui(RawInput::default(), |ui| lay_out(ui, told));
        let text = |shape: &Shape| match shape {
            Shape::Text(text) => Some(text.galley.text().to_owned()),
            _ => None,
        };
        let texts = output.shapes.iter().filter_map(|clipped| text(&clipped.shape)).collect();
        output.drop_without_applying_deltas();
        texts
    }

    #[test]
    fn the_panel_tells_the_value_under_each_pointer_that_meets_something() {
        let timings = Timings::default();
        let told = |values| Told {
            volume: "a volume",
            look: "",
            values,
            refreshes: "",
            notes: &[],
            timings: &timings,
            period_ms: 11.0,
        };
        let right = texts(&told([None, Some(127.5)]));
        assert!(right.contains(&"a volume".to_owned()), "{right:?}");
        assert!(right.contains(&"right hand at 127.5000".to_owned()), "{right:?}");
        assert!(!right.iter().any(|text| text.contains("left hand")), "{right:?}");
        assert!(!texts(&told([None; 2])).iter().any(|text| text.contains("hand")));
    }
}
