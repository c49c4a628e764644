//! The viewer without a window: a script's events in, pictures out.

use super::Opening;
use super::canvas::Canvas;
use super::cycle::Viewer;
use super::job::Waker;
use super::loading::Destination;
use super::report::Report;
use super::script::Player;
use super::session::Session;
use crate::failure::Failure;
use egui::{Context, Pos2, RawInput, Rect, Vec2};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};
use wheatstone_render::Gpu;

/// Longest time between two looks at what goes on in the background.
const NAP: Duration = Duration::from_millis(5);

/// Plays the script to its end.
pub(crate) fn run(opening: Opening) -> Result<Report, Failure> {
    let Opening { source, edits, player, size, begun } = opening;
    let player = player.map(Player::then_quit);
    let has_news = Arc::new(AtomicBool::new(false));
    let news = Arc::clone(&has_news);
    let wake: Waker = Arc::new(move || news.store(true, Ordering::Release));
    let session = Session::begin(source, wake, Destination::Window)?.edited(&edits)?;
    let gpu = Arc::new(Gpu::open_best()?);
    let mut canvas = Canvas::offscreen(&gpu, size)?;
    let mut viewer = Viewer::new(gpu, session, player, Context::default(), &canvas, begun)?;
    while !viewer.has_quit() {
        if has_news.swap(false, Ordering::AcqRel) {
            viewer.touch();
        }
        if viewer.wants_refresh() {
            let [width, height] = canvas.size();
            let input = RawInput {
                screen_rect: Some(Rect::from_min_size(Pos2::ZERO, Vec2::new(width as f32, height as f32))),
                time: Some(begun.elapsed().as_secs_f64()),
                focused: true,
                ..RawInput::default()
            };
            if let Some(size) = viewer.refresh(input, &mut canvas)?.resize {
                canvas.resize(viewer.gpu(), size)?;
                viewer.touch();
            }
        } else {
            viewer.look_after()?;
            let until = viewer.due_at().map_or(NAP, |due| due.saturating_duration_since(Instant::now()));
            thread::sleep(until.min(NAP));
        }
    }
    Ok(viewer.into_report())
}
