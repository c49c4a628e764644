//! The viewer in a window.

use super::canvas::Canvas;
use super::cycle::Viewer;
use super::job::Waker;
use super::loading::Destination;
use super::report::Report;
use super::session::Session;
use super::{Opening, Player};
use crate::failure::Failure;
use anyhow::{Context as _, anyhow};
use egui::{Context, ViewportId};
use std::panic;
use std::sync::Arc;
use std::time::Instant;
use wheatstone_render::{Gpu, GpuError, gpu};
use winit::application::ApplicationHandler;
use winit::dpi::LogicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::window::{Fullscreen, Window, WindowId};

/// Something has happened in the background.
struct Wake;

/// Opens the window and runs until it is closed.
pub(crate) fn run(opening: Opening) -> Result<Report, Failure> {
    let event_loop = event_loop()?;
    let proxy = event_loop.create_proxy();
    let wake: Waker = Arc::new(move || drop(proxy.send_event(Wake)));
    let Opening { source, edits, player, size, begun } = opening;
    let session = Session::begin(source, wake, Destination::Window)?.edited(&edits)?;
    let mut app = App { stage: Stage::Before(Some(Box::new(Before { session, player, size, begun }))) };
    event_loop.run_app(&mut app).context("the window's event loop")?;
    match app.stage {
        Stage::Open(open) => Ok(open.viewer.into_report()),
        Stage::Failed(failure) => Err(failure),
        Stage::Before(_) => Err(Failure::Internal(anyhow!("the window was never opened"))),
    }
}

/// The connection to the display. A library that is missing makes winit panic.
pub(crate) fn event_loop<Event: 'static>() -> Result<EventLoop<Event>, Failure> {
    let built =
        panic::catch_unwind(|| EventLoop::with_user_event().build().map_err(|error| error.to_string()));
    let reason = match built {
        Ok(Ok(event_loop)) => return Ok(event_loop),
        // What comes before is the place in winit's source.
        Ok(Err(error)) => {
            error.rsplit(": ").next().unwrap_or_default().trim_end_matches(['.', ')']).to_owned()
        }
        Err(_) => "a library is missing".to_owned(),
    };
    Err(Failure::Internal(anyhow!(
        "no display to open a window on ({reason}): set DISPLAY or WAYLAND_DISPLAY, install libxkbcommon-x11, \
         libXcursor and libXi, run under xvfb-run, or make pictures without a window: `wheatstone render`"
    )))
}

struct App {
    stage: Stage,
}

enum Stage {
    Before(Option<Box<Before>>),
    Open(Box<Open>),
    Failed(Failure),
}

/// What waits for the window.
struct Before {
    session: Session,
    player: Option<Player>,
    size: [u32; 2],
    begun: Instant,
}

struct Open {
    window: Arc<Window>,
    input: egui_winit::State,
    canvas: Canvas,
    viewer: Viewer,
}

impl Before {
    fn open(self, event_loop: &ActiveEventLoop) -> Result<Open, Failure> {
        let [width, height] = self.size;
        let attributes = Window::default_attributes()
            .with_title("Wheatstone")
            .with_inner_size(LogicalSize::new(width, height));
        let window = Arc::new(event_loop.create_window(attributes).context("cannot open a window")?);
        let instance = gpu::instance();
        let surface = instance.create_surface(Arc::clone(&window)).map_err(|_| no_adapter())?;
        let gpu = Arc::new(Gpu::open_for_surface(&instance, &surface)?);
        let canvas =
            Canvas::of_window(&gpu, surface, window.inner_size().into(), wgpu::PresentMode::AutoVsync)?;
        let context = Context::default();
        let largest_side = gpu.capabilities().largest_2d_side as usize;
        let input = egui_winit::State::new(
            context.clone(),
            ViewportId::ROOT,
            &*window,
            Some(window.scale_factor() as f32),
            None,
            Some(largest_side),
        );
        let mut viewer = Viewer::new(gpu, self.session, self.player, context, &canvas, self.begun)?;
        viewer.move_to_monitor(refresh_rate_millihertz(&window));
        Ok(Open { window, input, canvas, viewer })
    }
}

/// Of the monitor that a window is on, refreshes in 1000 s.
fn refresh_rate_millihertz(window: &Window) -> Option<u32> {
    window.current_monitor().and_then(|monitor| monitor.refresh_rate_millihertz())
}

/// No driver knows windows.
fn no_adapter() -> Failure {
    Failure::Gpu(GpuError::NoAdapter { found: gpu::adapters().len() })
}

impl Open {
    fn refresh(&mut self) -> Result<(), Failure> {
        let input = self.input.take_egui_input(&self.window);
        let refreshed = self.viewer.refresh(input, &mut self.canvas)?;
        self.input.handle_platform_output(&self.window, refreshed.platform);
        if self.viewer.fills_screen() != self.window.fullscreen().is_some() {
            let fullscreen = self.viewer.fills_screen().then_some(Fullscreen::Borderless(None));
            self.window.set_fullscreen(fullscreen);
        }
        if let Some([width, height]) = refreshed.resize {
            let size = self.window.request_inner_size(LogicalSize::new(width, height));
            size.map_or(Ok(()), |size| self.canvas.resize(self.viewer.gpu(), size.into()))?;
        }
        Ok(())
    }

    fn on_event(&mut self, event: &WindowEvent) -> Result<(), Failure> {
        if self.input.on_window_event(&self.window, event).repaint {
            self.viewer.touch();
        }
        match event {
            WindowEvent::RedrawRequested => self.refresh(),
            WindowEvent::Moved(_) => {
                self.viewer.move_to_monitor(refresh_rate_millihertz(&self.window));
                Ok(())
            }
            WindowEvent::Resized(size) => {
                self.viewer.touch();
                self.viewer.move_to_monitor(refresh_rate_millihertz(&self.window));
                Ok(self.canvas.resize(self.viewer.gpu(), (*size).into())?)
            }
            _ => Ok(()),
        }
    }

    /// Asks for a refresh if one is due, looks after the cast if not; when to come again.
    fn go_on(&mut self) -> Result<ControlFlow, Failure> {
        if self.viewer.wants_refresh() {
            self.window.request_redraw();
            return Ok(ControlFlow::Wait);
        }
        self.viewer.look_after()?;
        Ok(self.viewer.due_at().map_or(ControlFlow::Wait, ControlFlow::WaitUntil))
    }
}

impl App {
    fn end_unless(&mut self, event_loop: &ActiveEventLoop, outcome: Result<(), Failure>) {
        if let Err(failure) = outcome {
            self.stage = Stage::Failed(failure);
            event_loop.exit();
        }
    }
}

impl ApplicationHandler<Wake> for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let Stage::Before(before) = &mut self.stage else { return };
        let Some(before) = before.take() else { return };
        match before.open(event_loop) {
            Ok(open) => self.stage = Stage::Open(Box::new(open)),
            Err(failure) => self.end_unless(event_loop, Err(failure)),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, _: Wake) {
        if let Stage::Open(open) = &mut self.stage {
            open.viewer.touch();
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Stage::Open(open) = &mut self.stage else { return };
        if event == WindowEvent::CloseRequested {
            event_loop.exit();
            return;
        }
        let outcome = open.on_event(&event);
        self.end_unless(event_loop, outcome);
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Stage::Open(open) = &mut self.stage else { return };
        if open.viewer.has_quit() {
            event_loop.exit();
            return;
        }
        match open.go_on() {
            Ok(control_flow) => event_loop.set_control_flow(control_flow),
            Err(failure) => self.end_unless(event_loop, Err(failure)),
        }
    }
}
