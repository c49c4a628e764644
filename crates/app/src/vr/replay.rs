//! A headset that is not there: recorded eyes and hands, at the refreshes of a display that a clock simulates.

use super::headset::{Headset, Moment, Sight};
use crate::failure::Failure;
use crate::viewer::canvas;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_core::head::Display;
use wheatstone_core::headset::{Eye, Recording, Side, Tick};
use wheatstone_render::Gpu;

/// What eyes and hands do so many seconds after the beginning of a recording; nothing any more after its end.
fn tick_at(recording: &Recording, time_s: f64, period_s: f64) -> Option<Tick> {
    let first_s = recording.ticks().first()?.display_time_s;
    let tick = recording.tick_at(first_s + time_s)?;
    Some(Tick { display_time_s: time_s, period_s, ..tick })
}

/// Refreshes come when the clock says so; those that are not drawn for in time are left out, as a headset's are.
pub(crate) struct Replay {
    gpu: Arc<Gpu>,
    recording: Recording,
    display: Display,
    eyes: [wgpu::Texture; 2],
    /// Of refresh 0; none before the first.
    begun: Option<Instant>,
    /// The next that there may be.
    next: u64,
}

impl Replay {
    /// With pictures of some pixels for each eye.
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        recording: Recording,
        display: Display,
        size: [u32; 2],
    ) -> Result<Self, Failure> {
        let eye = || canvas::texture(&gpu, size, wgpu::TextureFormat::Rgba8Unorm);
        let eyes = [eye()?, eye()?];
        Ok(Self { recording, display, eyes, begun: None, next: 0, gpu })
    }
}

impl Headset for Replay {
    fn gpu(&self) -> &Arc<Gpu> {
        &self.gpu
    }

    fn name(&self) -> String {
        "no headset".to_owned()
    }

    fn image_format(&self) -> wgpu::TextureFormat {
        self.eyes[0].format()
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.eyes.each_ref().map(|eye| [eye.width(), eye.height()])
    }

    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        let begun = *self.begun.get_or_insert_with(Instant::now);
        let period_s = self.display.period_s();
        // What is drawn from now on is shown at the next refresh that is still to come.
        let now_s = begun.elapsed().as_secs_f64();
        let refresh = self.next.max((now_s / period_s).floor() as u64);
        self.next = refresh + 1;
        let Some(tick) = tick_at(&self.recording, self.display.refresh_s(refresh), period_s) else {
            return Ok(Moment::Ended("the recording is over".to_owned()));
        };
        let wait_s = self.display.refresh_s(refresh) - now_s;
        std::thread::sleep(Duration::from_secs_f64(wait_s.max(0.0)));
        draw(&mut Drawn { tick, eyes: &self.eyes })?;
        Ok(Moment::Shown)
    }

    fn pulse(&mut self, _: Side) -> Result<(), Failure> {
        Ok(())
    }

    fn told(&mut self) -> Vec<String> {
        Vec::new()
    }

    fn close(&mut self) -> Result<(), Failure> {
        self.next = u64::MAX;
        Ok(())
    }
}

/// A headset of which eyes and hands do what was recorded; frusta and refreshes stay its own.
pub(crate) struct Guided<H> {
    headset: H,
    recording: Recording,
    /// Display time of the first refresh, seconds.
    first_s: Option<f64>,
}

impl<H> Guided<H> {
    pub(crate) fn new(headset: H, recording: Recording) -> Self {
        Self { headset, recording, first_s: None }
    }
}

impl<H: Headset> Headset for Guided<H> {
    fn gpu(&self) -> &Arc<Gpu> {
        self.headset.gpu()
    }

    fn name(&self) -> String {
        self.headset.name()
    }

    fn image_format(&self) -> wgpu::TextureFormat {
        self.headset.image_format()
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.headset.eye_sizes()
    }

    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        let Self { headset, recording, first_s } = self;
        let mut is_over = false;
        let moment = headset.refresh(&mut |sight| {
            let own = *sight.tick();
            let time_s = own.display_time_s - *first_s.get_or_insert(own.display_time_s);
            match tick_at(recording, time_s, own.period_s) {
                Some(recorded) => draw(&mut Guide { sight, tick: guided(&own, &recorded) }),
                None => {
                    is_over = true;
                    Ok(())
                }
            }
        })?;
        Ok(if is_over { Moment::Ended("the recording is over".to_owned()) } else { moment })
    }

    fn pulse(&mut self, side: Side) -> Result<(), Failure> {
        self.headset.pulse(side)
    }

    fn told(&mut self) -> Vec<String> {
        self.headset.told()
    }

    fn close(&mut self) -> Result<(), Failure> {
        self.headset.close()
    }
}

/// Recorded poses through a headset's own lenses.
fn guided(own: &Tick, recorded: &Tick) -> Tick {
    let eyes = own
        .eyes
        .zip(recorded.eyes)
        .map(|(own, recorded)| [0, 1].map(|eye: usize| Eye { frustum: own[eye].frustum, ..recorded[eye] }));
    Tick { eyes, hands: recorded.hands, ..*own }
}

struct Guide<'a> {
    sight: &'a mut dyn Sight,
    tick: Tick,
}

impl Sight for Guide<'_> {
    fn tick(&self) -> &Tick {
        &self.tick
    }

    fn eye_images(&mut self) -> Result<[wgpu::TextureView; 2], Failure> {
        self.sight.eye_images()
    }

    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure> {
        self.sight.panel_image()
    }
}

struct Drawn<'a> {
    tick: Tick,
    eyes: &'a [wgpu::Texture; 2],
}

impl Sight for Drawn<'_> {
    fn tick(&self) -> &Tick {
        &self.tick
    }

    fn eye_images(&mut self) -> Result<[wgpu::TextureView; 2], Failure> {
        Ok(self.eyes.each_ref().map(|eye| eye.create_view(&wgpu::TextureViewDescriptor::default())))
    }

    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure> {
        Ok(None)
    }
}
