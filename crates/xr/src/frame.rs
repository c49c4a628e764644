//! One refresh: where the eyes and hands will be, and the pictures for it.

use crate::error::{Called, XrError};
use crate::eyes::eyes;
use crate::layers::Panel;
use crate::runtime::STEREO;
use crate::session::Session;
use crate::swapchain::Swapchain;
use openxr as xr;
use wheatstone_core::headset::{Hand, Tick};

/// A refresh that is to be drawn for. It has to be ended; one that is dropped shows nothing.
pub struct Frame<'s> {
    session: &'s mut Session,
    time: xr::Time,
    views: Option<[xr::View; 2]>,
    tick: Tick,
    ended: bool,
}

/// What an eye's picture is drawn to. All its pixels are to be drawn; what the image held before is not defined.
#[derive(Debug, Clone)]
pub struct EyeImage {
    /// Display-referred colours, premultiplied, of [`Session::image_format`]. They are shown as they are written.
    pub color: wgpu::TextureView,
    /// Depths along the view's −Z as `near_m / depth_m`, of the eye's [`Frustum`](wheatstone_core::view::Frustum) and
    /// [`wgpu::TextureFormat::Depth32Float`]: 1 is nearest, 0 infinitely far; where they were asked for and are offered.
    pub depth: Option<wgpu::TextureView>,
}

impl<'s> Frame<'s> {
    /// The frame that the runtime has just let begin.
    pub(crate) fn begun(session: &'s mut Session, state: &xr::FrameState) -> Result<Self, XrError> {
        let time = state.predicted_display_time;
        let tick = Tick {
            display_time_s: seconds(time.as_nanos()),
            period_s: seconds(state.predicted_display_period.as_nanos()),
            eyes: None,
            hands: [Hand::default(); 2],
        };
        let mut frame = Self { session, time, views: None, tick, ended: false };
        if state.should_render {
            frame.locate_eyes()?;
        }
        frame.tick.hands = frame.session.hands(time)?;
        Ok(frame)
    }

    fn locate_eyes(&mut self) -> Result<(), XrError> {
        let Session { handle, world, .. } = &*self.session;
        let (flags, views) = handle.locate_views(STEREO, self.time, &world.space).called("xrLocateViews")?;
        let views = <[xr::View; 2]>::try_from(views).map_err(|views| XrError::Refused {
            call: "xrLocateViews",
            reason: format!("{} views of a stereo headset", views.len()),
        })?;
        self.tick.eyes = eyes(flags, views);
        self.views = self.tick.eyes.map(|_| views);
        Ok(())
    }

    /// When the refresh is, where the eyes will be then, and what the hands do.
    pub fn tick(&self) -> &Tick {
        &self.tick
    }

    /// The session, for its clock and its haptics.
    pub fn session(&self) -> &Session {
        self.session
    }

    /// Waits until the runtime has no more use for the next images of the left and the right eye, which is soon. They are shown if this was
    /// called, there are eyes in the tick, and the frame is ended.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn acquire_eyes(&mut self) -> Result<[EyeImage; 2], XrError> {
        let [left, right] = self.session.eye_images.each_mut().map(|eye| {
            let depth = eye.depth.as_mut().map(Swapchain::acquire).transpose()?;
            Ok::<_, XrError>(EyeImage { color: eye.color.acquire()?, depth })
        });
        Ok([left?, right?])
    }

    /// Waits for an image to draw the panel to; none if the session has no panel. One that is not drawn anew shows what it showed before.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn acquire_panel(&mut self) -> Result<Option<wgpu::TextureView>, XrError> {
        self.session.panel_image.as_mut().map(Swapchain::acquire).transpose()
    }

    /// Shows what was drawn, all of which has to be submitted, and the panel in front of it.
    ///
    /// # Errors
    /// A lost runtime.
    pub fn end(mut self, panel: Option<&Panel>) -> Result<(), XrError> {
        self.finish(panel)
    }

    fn finish(&mut self, panel: Option<&Panel>) -> Result<(), XrError> {
        self.ended = true;
        let drawn = self.session.eye_images.iter().all(|eye| eye.color.is_ready());
        let views = self.views.filter(|_| drawn);
        let released = self.session.release_images();
        let shown = match released {
            Ok(()) => self.session.show(self.time, views, panel),
            Err(_) => self.session.show(self.time, None, None),
        };
        released.and(shown)
    }
}

impl Drop for Frame<'_> {
    fn drop(&mut self) {
        if !self.ended {
            self.views = None;
            // The next call into the runtime tells of a loss again.
            let _ = self.finish(None);
        }
    }
}

fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 * 1e-9
}
