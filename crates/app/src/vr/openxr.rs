//! A headset that an OpenXR runtime tells of.

use super::headset::{DepthLayer, EyeImage, Headset, Moment, OfPictures, Sight};
use super::panel;
use crate::failure::Failure;
use std::sync::Arc;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{HiddenArea, Side, Tick};
use wheatstone_render::Gpu;
use wheatstone_xr::{
    EndReason, Floor, Frame, Graphics, Panel, Phase, Runtime, Session, SessionEvent, SessionOptions, XrError,
};

/// Of the panel in the room.
const M_PER_PIXEL: f32 = 0.0004;

/// How long a hand feels that it has taken hold of something, seconds, and how strongly.
const PULSE: (f64, f32) = (0.02, 0.6);

/// Pixels of an eye's picture that software Vulkan has time for.
const MOST_PIXELS_ON_CPU: f64 = 640.0 * 720.0;

/// A session of a runtime.
pub(crate) struct OpenXr {
    session: Session,
    graphics: Graphics,
    runtime: String,
    hidden: [HiddenArea; 2],
    told: Vec<String>,
}

/// A runtime that has been connected to, and its device: what does not change when a session ends.
pub(crate) struct Connected(Graphics);

impl Connected {
    /// Connects to the runtime that the system has set up.
    pub(crate) fn connect() -> Result<Self, Failure> {
        Ok(Self(Runtime::connect("Wheatstone")?.open_gpu()?))
    }

    /// The device.
    pub(crate) fn gpu(&self) -> &Arc<Gpu> {
        self.0.gpu()
    }

    /// What a window's surface is made by.
    pub(crate) fn instance(&self) -> &wgpu::Instance {
        self.0.instance()
    }
}

impl OpenXr {
    /// Begins a session. From then on nothing else may give the device work from another thread.
    pub(crate) fn begin(
        Connected(graphics): Connected,
        OfPictures { depth_layer, image_scale, is_read }: OfPictures,
    ) -> Result<Self, Failure> {
        let has_depth = depth_layer == DepthLayer::With;
        let options = SessionOptions {
            image_scale: image_scale.unwrap_or_else(|| affordable_scale(&graphics)),
            panel_px: Some(panel::SIZE),
            has_depth,
            has_readable_images: is_read,
            ..SessionOptions::default()
        };
        let session = Session::begin(&graphics, options)?;
        let runtime = graphics.runtime().description().name.clone();
        let mut told = Vec::new();
        if has_depth && session.depth_format().is_none() {
            let no_depths = format!("{runtime} takes no depths (XR_KHR_composition_layer_depth)");
            eprintln!("--depth-layer: {no_depths}");
            told.push(no_depths);
        }
        let hidden = [hidden_area(&session, 0)?, hidden_area(&session, 1)?];
        Ok(Self { session, graphics, runtime, hidden, told })
    }

    /// Takes note of what has happened.
    fn take_note(&mut self) -> Result<(), Failure> {
        let events: Vec<SessionEvent> = self.session.events().collect();
        for event in &events {
            match event {
                &SessionEvent::HiddenAreaChanged { eye } => {
                    if let Some(hidden) = self.hidden.get_mut(eye) {
                        *hidden = hidden_area(&self.session, eye)?;
                    }
                }
                other => self.told.extend(told(other)),
            }
        }
        Ok(())
    }
}

/// What is recommended, but for software Vulkan.
fn affordable_scale(graphics: &Graphics) -> f64 {
    let area = |[width, height]: [u32; 2]| f64::from(width) * f64::from(height);
    let recommended = graphics.runtime().description().eye_sizes.map(area);
    if graphics.gpu().description().is_software {
        (MOST_PIXELS_ON_CPU / recommended[0].max(recommended[1])).sqrt().min(1.0)
    } else {
        1.0
    }
}

/// What the lens hides of an eye's picture, as far as the runtime tells.
fn hidden_area(session: &Session, eye: usize) -> Result<HiddenArea, Failure> {
    Ok(session.hidden_area(eye)?.unwrap_or_default())
}

impl Headset for OpenXr {
    fn gpu(&self) -> &Arc<Gpu> {
        self.graphics.gpu()
    }

    fn name(&self) -> String {
        self.runtime.clone()
    }

    fn image_format(&self) -> wgpu::TextureFormat {
        self.session.image_format()
    }

    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        self.session.depth_format()
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.session.eye_sizes()
    }

    fn hidden_areas(&self) -> &[HiddenArea; 2] {
        &self.hidden
    }

    fn sees_through(&self) -> bool {
        self.session.sees_through()
    }

    fn floor_y_m(&self) -> Option<f64> {
        match self.session.floor() {
            Floor::Stage | Floor::Local => Some(0.0),
            Floor::Unknown => None,
        }
    }

    fn is_patient(&self) -> bool {
        false
    }

    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        let phase = self.session.poll()?;
        self.take_note()?;
        match phase {
            Phase::Idle => Ok(Moment::Idle),
            Phase::Ended(EndReason::Exited) => Ok(Moment::Ended("the session was closed".to_owned())),
            Phase::Ended(EndReason::Lost) => {
                Ok(Moment::Ended("the runtime took the session away".to_owned()))
            }
            Phase::Running => {
                let mut frame = self.session.wait()?;
                let mut drawn = Drawn { frame: &mut frame, panel: None };
                draw(&mut drawn)?;
                let panel = drawn.panel;
                frame.end(panel.as_ref())?;
                Ok(Moment::Shown)
            }
        }
    }

    fn pulse(&mut self, side: Side) -> Result<(), Failure> {
        Ok(self.session.pulse(side, PULSE.0, PULSE.1)?)
    }

    fn told(&mut self) -> Vec<String> {
        std::mem::take(&mut self.told)
    }

    fn close(&mut self) -> Result<(), Failure> {
        Ok(self.session.request_exit()?)
    }
}

/// An event in words, if it is worth any.
fn told(event: &SessionEvent) -> Option<String> {
    match event {
        SessionEvent::FocusLost => Some("another program has the hands now".to_owned()),
        SessionEvent::FocusGained => Some("the hands are here".to_owned()),
        SessionEvent::Recentred => Some("the room has a new middle".to_owned()),
        SessionEvent::RuntimeEnding => Some("the headset's software is ending".to_owned()),
        SessionEvent::RefreshRateChanged { hz } => Some(format!("{hz:.0} refreshes per second")),
        _ => None,
    }
}

struct Drawn<'a, 's> {
    frame: &'a mut Frame<'s>,
    panel: Option<Panel>,
}

impl Sight for Drawn<'_, '_> {
    fn tick(&self) -> &Tick {
        self.frame.tick()
    }

    fn eye_images(&mut self) -> Result<[EyeImage; 2], Failure> {
        Ok(self.frame.acquire_eyes()?.map(|image| EyeImage { color: image.color, depth: image.depth }))
    }

    fn place_panel(&mut self, pose: Pose) {
        self.panel = Some(Panel { pose, size_m: panel::SIZE.map(|side| side as f32 * M_PER_PIXEL) });
    }

    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure> {
        Ok(self.frame.acquire_panel()?)
    }
}

impl From<XrError> for Failure {
    fn from(error: XrError) -> Self {
        match error {
            XrError::Gpu(error) => Self::Gpu(error),
            other => Self::Internal(other.into()),
        }
    }
}
