//! A session: from the begin of its pictures to their end.

use crate::actions::Actions;
use crate::device::{Graphics, session_info};
use crate::error::{Called, XrError};
use crate::event::SessionEvent;
use crate::frame::Frame;
use crate::hand_tracking::HandTracking;
use crate::runtime::{Runtime, STEREO};
use crate::space::{Floor, World};
use crate::state::{Duty, EndReason, States};
use crate::swapchain::{Content, Reading, Swapchain};
use openxr as xr;
use std::collections::VecDeque;
use std::marker::PhantomData;
use std::time::Duration;
use wheatstone_core::headset::{Hand, Side};

/// Longest time that the device is waited for when a session ends.
const SETTLING_TIMEOUT: Duration = Duration::from_secs(120);

/// What a session is to have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SessionOptions {
    /// Width and height of the eyes' pictures, as parts of what the runtime recommends; no more than it takes.
    pub image_scale: f64,
    /// Width and height of the panel, pixels; none without it.
    pub panel_px: Option<[u32; 2]>,
    /// Whether depths are given along with pictures, where the runtime takes them. It then moves pictures about as the surfaces that they
    /// are of, which translucent volumes are not.
    pub has_depth: bool,
    /// Whether images can be copied and sampled after they are drawn, for a mirror or a test.
    pub has_readable_images: bool,
    /// How often the display is to refresh, per second; none leaves it to the runtime.
    pub refresh_rate_hz: Option<f32>,
}

impl Default for SessionOptions {
    /// Pictures as the runtime recommends, and nothing else.
    fn default() -> Self {
        Self {
            image_scale: 1.0,
            panel_px: None,
            has_depth: false,
            has_readable_images: false,
            refresh_rate_hz: None,
        }
    }
}

/// Whether there are frames to make.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Not now: the headset is not worn, or the session is being begun or stopped.
    Idle,
    /// One for each refresh.
    Running,
    /// Never again.
    Ended(EndReason),
}

/// The images of an eye.
pub(crate) struct EyeImages {
    pub(crate) color: Swapchain,
    pub(crate) depth: Option<Swapchain>,
}

/// Pictures for a headset, refresh by refresh. It stays on the thread that it was begun on.
///
/// Dropped, it waits until the device has done what was submitted.
pub struct Session {
    pub(crate) eye_images: [EyeImages; 2],
    pub(crate) panel_image: Option<Swapchain>,
    /// After the images and before the rest, so that the device has let go of the images when the session ends.
    settling: Settling,
    pub(crate) stream: xr::FrameStream<xr::Vulkan>,
    waiter: xr::FrameWaiter,
    pub(crate) world: World,
    pub(crate) actions: Actions,
    hand_tracking: Option<HandTracking>,
    pub(crate) handle: xr::Session<xr::Vulkan>,
    queue: wgpu::Queue,
    runtime: Runtime,
    pub(crate) blend_mode: xr::EnvironmentBlendMode,
    format: wgpu::TextureFormat,
    states: States,
    events: VecDeque<SessionEvent>,
    on_one_thread: PhantomData<*const ()>,
}

impl Session {
    /// Begins a session on the device of the headset.
    ///
    /// # Errors
    /// [`XrError::NoFormat`], a lost runtime, [`XrError::Refused`] by a runtime that has a session of this program already.
    pub fn begin(graphics: &Graphics, options: SessionOptions) -> Result<Self, XrError> {
        let runtime = graphics.runtime().clone();
        let device = graphics.gpu().device();
        let blend_mode = blend_mode(&runtime)?;
        // SAFETY: the device was opened by this runtime, and is kept until the session is destroyed. Its queue is used by this thread alone,
        // as `Graphics` asks for.
        let (handle, waiter, stream) = unsafe {
            runtime.instance.create_session_with_guard::<xr::Vulkan>(
                runtime.system,
                &session_info(device)?,
                Box::new(device.clone()),
            )
        }
        .called("xrCreateSession")?;
        let formats = handle.enumerate_swapchain_formats().called("xrEnumerateSwapchainFormats")?;
        let color = Content::color(&formats)?;
        let wants_depth = options.has_depth && runtime.description().has_depth_layers;
        let depth = Content::depth(&formats).filter(|_| wants_depth);
        let reading = if options.has_readable_images { Reading::Sampled } else { Reading::Never };
        let swapchain = |content, size| Swapchain::new(&handle, device, content, size, reading);
        let [left, right] = runtime.description().image_sizes(options.image_scale).map(|size| {
            let depth = depth.map(|depth| swapchain(depth, size)).transpose()?;
            Ok::<_, XrError>(EyeImages { color: swapchain(color, size)?, depth })
        });
        let panel_image = options.panel_px.map(|size| swapchain(color, size)).transpose()?;
        let tracks_hands = runtime.description().has_hand_tracking;
        let session = Self {
            eye_images: [left?, right?],
            panel_image,
            settling: Settling { device: device.clone() },
            stream,
            waiter,
            world: World::new(&handle)?,
            actions: Actions::new(&handle)?,
            hand_tracking: tracks_hands.then(|| HandTracking::new(&handle)).transpose()?,
            handle,
            queue: graphics.gpu().queue().clone(),
            runtime,
            blend_mode,
            format: color.view_format(),
            states: States::new(),
            events: VecDeque::new(),
            on_one_thread: PhantomData,
        };
        graphics.gpu().check()?;
        if let Some(hz) = options.refresh_rate_hz {
            session.request_refresh_rate(hz)?;
        }
        Ok(session)
    }

    /// Takes note of what has happened, without waiting.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn poll(&mut self) -> Result<Phase, XrError> {
        let mut buffer = xr::EventDataBuffer::new();
        let instance = self.runtime.instance.clone();
        while let Some(event) = instance.poll_event(&mut buffer).called("xrPollEvent")? {
            self.note(event)?;
        }
        Ok(self.phase())
    }

    /// Whether eyes see the room where pictures are transparent.
    pub fn sees_through(&self) -> bool {
        self.blend_mode != xr::EnvironmentBlendMode::OPAQUE
    }

    /// Whether there are frames to make, as of the last [`Session::poll`].
    pub fn phase(&self) -> Phase {
        match self.states.ended() {
            Some(reason) => Phase::Ended(reason),
            None if self.states.running() => Phase::Running,
            None => Phase::Idle,
        }
    }

    /// Waits until the runtime wants the next frame, and begins it. What was submitted before goes on meanwhile.
    ///
    /// # Errors
    /// A lost runtime, or a session that is not [running](Phase::Running).
    pub fn wait(&mut self) -> Result<Frame<'_>, XrError> {
        let state = self.waiter.wait().called("xrWaitFrame")?;
        self.stream.begin().called("xrBeginFrame")?;
        Frame::begun(self, &state)
    }

    fn note(&mut self, event: xr::Event<'_>) -> Result<(), XrError> {
        match event {
            xr::Event::SessionStateChanged(change) if change.session() == self.handle.as_raw() => {
                self.change_state(change.state())?;
            }
            xr::Event::InstanceLossPending(_) => {
                self.states.lose();
                self.events.push_back(SessionEvent::RuntimeEnding);
            }
            xr::Event::ReferenceSpaceChangePending(change)
                if change.reference_space_type() == self.world.kind =>
            {
                self.events.push_back(SessionEvent::Recentred);
            }
            xr::Event::InteractionProfileChanged(_) => {
                let controllers = self.actions.controllers(&self.handle)?;
                self.events.push_back(SessionEvent::ControllersChanged(controllers));
            }
            xr::Event::DisplayRefreshRateChangedFB(change) => {
                let hz = change.to_display_refresh_rate();
                self.events.push_back(SessionEvent::RefreshRateChanged { hz });
            }
            xr::Event::VisibilityMaskChangedKHR(change) => {
                let eye = change.view_index() as usize;
                self.events.push_back(SessionEvent::HiddenAreaChanged { eye });
            }
            xr::Event::EventsLost(lost) => {
                self.events.push_back(SessionEvent::EventsLost { count: lost.lost_event_count() });
            }
            _ => {}
        }
        Ok(())
    }

    fn change_state(&mut self, to: xr::SessionState) -> Result<(), XrError> {
        let had_focus = self.states.focused();
        match self.states.change(to) {
            Duty::Nothing => {}
            Duty::Begin => self.handle.begin(STEREO).called("xrBeginSession").map(drop)?,
            Duty::End => self.handle.end().called("xrEndSession").map(drop)?,
        }
        match (had_focus, self.states.focused()) {
            (false, true) => self.events.push_back(SessionEvent::FocusGained),
            (true, false) => self.events.push_back(SessionEvent::FocusLost),
            _ => {}
        }
        Ok(())
    }

    /// What has happened since this was last asked, oldest first.
    pub fn events(&mut self) -> impl Iterator<Item = SessionEvent> {
        self.events.drain(..)
    }

    /// Whether hands act on this program.
    pub fn has_focus(&self) -> bool {
        self.states.focused()
    }

    /// Whether what is drawn can be seen.
    pub fn is_visible(&self) -> bool {
        self.states.visible()
    }

    /// What height 0 of the world is.
    pub fn floor(&self) -> Floor {
        self.world.floor
    }

    /// The format of what eyes' pictures and the panel are drawn to.
    pub fn image_format(&self) -> wgpu::TextureFormat {
        self.format
    }

    /// The format of the depths that are given along with the eyes' pictures, if they are.
    pub fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        let [left, _] = &self.eye_images;
        left.depth.as_ref().map(Swapchain::format)
    }

    /// Width and height of the left and the right eye's pictures, pixels.
    pub fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.eye_images.each_ref().map(|images| images.color.size())
    }

    /// Now, on the clock of [`Tick::display_time_s`](wheatstone_core::headset::Tick); none if the runtime does not tell.
    pub fn now_s(&self) -> Option<f64> {
        let extensions = self.runtime.instance.exts();
        #[cfg(windows)]
        let has_clock = extensions.khr_win32_convert_performance_counter_time.is_some();
        #[cfg(not(windows))]
        let has_clock = extensions.khr_convert_timespec_time.is_some();
        let now = has_clock.then(|| self.runtime.instance.now().ok()).flatten()?;
        Some(now.as_nanos() as f64 * 1e-9)
    }

    /// Makes a hand's controller vibrate, for so many seconds (0 is the shortest that can be felt) and with an amplitude from 0 to 1. Hands
    /// that hold none feel nothing.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn pulse(&self, side: Side, seconds: f64, amplitude: f32) -> Result<(), XrError> {
        let duration = match Duration::try_from_secs_f64(seconds).map(xr::Duration::try_from) {
            Ok(Ok(duration)) if duration != xr::Duration::NONE => duration,
            _ => xr::Duration::MIN_HAPTIC,
        };
        let vibration = xr::HapticVibration::new()
            .duration(duration)
            .frequency(xr::FREQUENCY_UNSPECIFIED)
            .amplitude(amplitude.clamp(0.0, 1.0));
        self.actions.pulse(&self.handle, side, &vibration)
    }

    /// Asks the runtime to stop the session; [`Phase::Ended`] comes when it has.
    ///
    /// # Errors
    /// A lost runtime, or a session that is not [running](Phase::Running).
    pub fn request_exit(&self) -> Result<(), XrError> {
        self.handle.request_exit().called("xrRequestExitSession")
    }

    /// What both hands do, by their controllers or bare; nothing without the focus.
    pub(crate) fn hands(&self, time: xr::Time) -> Result<[Hand; 2], XrError> {
        if !self.states.focused() {
            return Ok([Hand::default(); 2]);
        }
        self.actions.sync(&self.handle)?;
        let [left, right] = Side::BOTH.map(|side| {
            let with_controller = self.actions.hand(&self.handle, side, &self.world, time)?;
            match (with_controller, &self.hand_tracking) {
                (Some(hand), _) => Ok(hand),
                (None, Some(tracking)) => Ok(tracking.hand(side, &self.world, time)?.unwrap_or_default()),
                (None, None) => Ok::<_, XrError>(Hand::default()),
            }
        });
        Ok([left?, right?])
    }

    /// Hands all images that were acquired to the runtime, in the state that it wants.
    pub(crate) fn release_images(&mut self) -> Result<(), XrError> {
        let Self { eye_images, panel_image, settling, queue, .. } = self;
        let mut images: Vec<_> = eye_images
            .iter_mut()
            .flat_map(|eye| [Some(&mut eye.color), eye.depth.as_mut()])
            .chain([panel_image.as_mut()])
            .flatten()
            .collect();
        let transitions: Vec<_> = images.iter().filter_map(|image| image.transition()).collect();
        if !transitions.is_empty() {
            let mut encoder =
                settling.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            encoder.transition_resources(std::iter::empty(), transitions.into_iter());
            queue.submit([encoder.finish()]);
        }
        images.iter_mut().try_for_each(|image| image.release())
    }

    pub(crate) fn has_visibility_masks(&self) -> bool {
        self.runtime.description().has_visibility_masks
    }

    pub(crate) fn has_refresh_rates(&self) -> bool {
        self.runtime.description().has_refresh_rates
    }
}

/// Waits, when it is dropped, until the device has done what was submitted and has let go of what was dropped before.
struct Settling {
    device: wgpu::Device,
}

impl Drop for Settling {
    fn drop(&mut self) {
        let wait = wgpu::PollType::Wait { submission_index: None, timeout: Some(SETTLING_TIMEOUT) };
        // A lost device has let go of everything; its owner learns of the loss by `Gpu::check`.
        let _ = self.device.poll(wait);
    }
}

/// Nothing but pictures is seen where the headset can do that; else its first way of seeing the room too.
fn blend_mode(runtime: &Runtime) -> Result<xr::EnvironmentBlendMode, XrError> {
    let offered = runtime
        .instance
        .enumerate_environment_blend_modes(runtime.system, STEREO)
        .called("xrEnumerateEnvironmentBlendModes")?;
    Ok(opaque_or_first(&offered))
}

fn opaque_or_first(offered: &[xr::EnvironmentBlendMode]) -> xr::EnvironmentBlendMode {
    let opaque = xr::EnvironmentBlendMode::OPAQUE;
    if offered.contains(&opaque) { opaque } else { offered.first().copied().unwrap_or(opaque) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_room_is_seen_only_where_nothing_else_is_offered() {
        use xr::EnvironmentBlendMode as Mode;
        assert_eq!(opaque_or_first(&[Mode::ALPHA_BLEND, Mode::OPAQUE]), Mode::OPAQUE);
        assert_eq!(opaque_or_first(&[Mode::ALPHA_BLEND, Mode::ADDITIVE]), Mode::ALPHA_BLEND);
        assert_eq!(opaque_or_first(&[]), Mode::OPAQUE);
    }
}
