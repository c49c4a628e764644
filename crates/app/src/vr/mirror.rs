//! A window beside the headset: what the eyes are shown, and the viewer's panels.

use super::room::{Beside, Mirrored, Room};
use crate::failure::Failure;
use crate::viewer::canvas::{Canvas, Sheet};
use crate::viewer::screen::{Panels, Pictures, Screen};
use crate::viewer::show::Area;
use crate::viewer::ui::{Desk, Shown, dress, run_passes};
use crate::viewer::window::event_loop;
use anyhow::Context as _;
use egui::{Context, Rect, ViewportId};
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_render::Gpu;
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::platform::pump_events::EventLoopExtPumpEvents as _;
use winit::window::{Window, WindowId};

/// Least time from one drawing to the next: the headset comes first.
const EVERY: Duration = Duration::from_millis(100);

/// Part of the time that drawing may take: one of so many.
const ONE_OF: u32 = 10;

/// The window, and the connection to the display.
pub(crate) struct Mirror {
    events: EventLoop<()>,
    watch: Watch,
    /// When it is drawn next.
    due: Instant,
}

/// What waits for the window, then the window.
enum Watch {
    Before { gpu: Arc<Gpu>, instance: wgpu::Instance, size: [u32; 2] },
    Open(Box<Open>),
    Failed(Option<Failure>),
}

struct Open {
    window: Arc<Window>,
    gpu: Arc<Gpu>,
    input: egui_winit::State,
    context: Context,
    canvas: Canvas,
    screen: Screen,
    desk: Desk,
    has_quit: bool,
}

impl Mirror {
    /// Opens a window of some points for pictures on a device of an instance.
    pub(crate) fn open(gpu: Arc<Gpu>, instance: wgpu::Instance, size: [u32; 2]) -> Result<Self, Failure> {
        let events = event_loop()?;
        let mut mirror = Self { events, watch: Watch::Before { gpu, instance, size }, due: Instant::now() };
        mirror.pump()?;
        Ok(mirror)
    }

    fn pump(&mut self) -> Result<(), Failure> {
        self.events.pump_app_events(Some(Duration::ZERO), &mut self.watch);
        match &mut self.watch {
            Watch::Failed(failure) => {
                Err(failure.take().unwrap_or_else(|| Failure::input("the mirror is closed")))
            }
            _ => Ok(()),
        }
    }
}

impl Beside for Mirror {
    fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure> {
        let begun = Instant::now();
        if begun < self.due {
            return Ok(());
        }
        self.pump()?;
        if let Watch::Open(open) = &mut self.watch {
            open.draw(room)?;
        }
        self.due = begun + until_next(begun.elapsed());
        Ok(())
    }

    fn has_quit(&self) -> bool {
        matches!(&self.watch, Watch::Open(open) if open.has_quit)
    }
}

/// From the beginning of a drawing that took so long to the next.
fn until_next(took: Duration) -> Duration {
    EVERY.max(ONE_OF * took)
}

impl Open {
    fn new(
        event_loop: &ActiveEventLoop,
        gpu: Arc<Gpu>,
        instance: &wgpu::Instance,
        [width, height]: [u32; 2],
    ) -> Result<Self, Failure> {
        let attributes = Window::default_attributes()
            .with_title("Wheatstone, in the headset")
            .with_inner_size(LogicalSize::new(width, height));
        let window = Arc::new(event_loop.create_window(attributes).context("cannot open a window")?);
        let surface =
            instance.create_surface(Arc::clone(&window)).context("the headset's device shows no windows")?;
        let mode = wgpu::PresentMode::AutoNoVsync;
        let canvas = Canvas::of_window(&gpu, surface, window.inner_size().into(), mode)?;
        let context = Context::default();
        dress(&context);
        let largest_side = gpu.capabilities().largest_2d_side as usize;
        let input = egui_winit::State::new(
            context.clone(),
            ViewportId::ROOT,
            &*window,
            Some(window.scale_factor() as f32),
            None,
            Some(largest_side),
        );
        let screen = Screen::new(&gpu, canvas.format());
        Ok(Self { window, gpu, input, context, canvas, screen, desk: Desk::new(), has_quit: false })
    }

    fn draw(&mut self, room: &mut Room) -> Result<(), Failure> {
        let input = self.input.take_egui_input(&self.window);
        let Mirrored { session, casting, timings, device, pictures, beholder, period_s } = room.mirrored();
        let notes = session.notes.latest().to_vec();
        let quality = casting.described_quality();
        let mut area = Rect::NOTHING;
        let desk = &mut self.desk;
        let mut output = run_passes(&self.context, input, |ui| {
            let shown = Shown {
                state: session.state(),
                beholder: &beholder,
                facts: session.facts(),
                preset: session.preset(),
                placement: casting.placement(),
                progress: session.progress(),
                notes: &notes,
                timings,
                device,
                quality: &quality,
                refresh_ms: 1e3 * period_s as f32,
            };
            let pass = desk.show(ui, &shown);
            area = pass.picture;
            pass.commands.iter().for_each(|command| session.perform(command));
        });
        let size = self.canvas.size();
        let state = session.state();
        let pictures = Pictures {
            arrangement: state.stereo.arrangement,
            area: Area::of_points(area, output.pixels_per_point).within(size),
            background: state.look.background,
            eyes: pictures.cloned(),
        };
        let mut panels = Panels::new(&self.context, &mut output, size);
        self.screen.update(&self.gpu, &mut panels);
        if let Some(sheet) = self.canvas.sheet(&self.gpu) {
            self.screen.draw(&self.gpu, &sheet.view(), &pictures, &panels);
            if let Sheet::Window(texture) = sheet {
                self.gpu.queue().present(texture);
            }
        }
        let has_something_to_show = pictures.eyes.is_some() && session.progress().is_none();
        session.capture(has_something_to_show, |capture| {
            self.screen.write(&self.gpu, capture, &pictures, &panels)
        })?;
        self.screen.free(&panels);
        self.input.handle_platform_output(&self.window, output.platform_output);
        Ok(self.gpu.check()?)
    }
}

impl ApplicationHandler for Watch {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if let Self::Before { gpu, instance, size } = self {
            *self = match Open::new(event_loop, Arc::clone(gpu), instance, *size) {
                Ok(open) => Self::Open(Box::new(open)),
                Err(failure) => Self::Failed(Some(failure)),
            };
        }
    }

    fn window_event(&mut self, _: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Self::Open(open) = self else { return };
        let _ = open.input.on_window_event(&open.window, &event);
        match event {
            WindowEvent::CloseRequested => open.has_quit = true,
            WindowEvent::Resized(size) => {
                if let Err(error) = open.canvas.resize(&open.gpu, size.into()) {
                    *self = Self::Failed(Some(error.into()));
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_dear_is_drawn_less_often() {
        let ms = Duration::from_millis;
        assert_eq!(until_next(ms(2)), EVERY);
        assert_eq!(until_next(ms(25)), ms(250));
    }
}
