//! A headset that is not there: recorded eyes and hands, at the refreshes of a display that a clock simulates.

use super::headset::{DepthLayer, EyeImage, Headset, Moment, Sight};
use crate::failure::Failure;
use crate::viewer::canvas;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_core::head::{Display, Pose};
use wheatstone_core::headset::{Demonstration, Eye, HiddenArea, Recording, Side, Tick};
use wheatstone_render::Gpu;

/// What is played.
#[derive(Debug)]
pub(crate) enum Played {
    Demonstration(Box<Demonstration>),
    Recording(Recording),
}

impl Played {
    /// What eyes and hands do so many seconds after the beginning; nothing any more after the end.
    pub(crate) fn tick_at(&self, time_s: f64, period_s: f64) -> Option<Tick> {
        let tick = match self {
            Self::Demonstration(demonstration) => (time_s <= demonstration.duration_s() + period_s)
                .then(|| demonstration.tick_at(time_s, period_s))?,
            Self::Recording(recording) => {
                let first_s = recording.ticks()[0].display_time_s;
                recording.tick_at(first_s + time_s)?
            }
        };
        Some(Tick { display_time_s: time_s, period_s, ..tick })
    }
}

/// When refreshes come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Clock {
    /// When it is time; those that are not drawn for in time are left out, as a headset's are.
    Real,
    /// As soon as the one before is drawn: none is left out, none is waited for.
    Patient,
}

/// Refreshes of a display that a clock simulates.
pub(crate) struct Replay {
    gpu: Arc<Gpu>,
    played: Played,
    display: Display,
    eyes: [EyeImage; 2],
    /// Of refresh 0; none before the first.
    begun: Option<Instant>,
    clock: Clock,
    /// The next that there may be.
    next: u64,
    is_closed: bool,
    /// Nothing.
    hidden: [HiddenArea; 2],
}

impl Replay {
    /// With pictures of some pixels for each eye.
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        played: Played,
        display: Display,
        clock: Clock,
        size: [u32; 2],
        depth_layer: DepthLayer,
    ) -> Result<Self, Failure> {
        let image = |format| {
            let texture = canvas::texture(&gpu, size, format)?;
            Ok::<_, Failure>(texture.create_view(&wgpu::TextureViewDescriptor::default()))
        };
        let eye = || {
            let depth = (depth_layer == DepthLayer::With).then(|| image(wgpu::TextureFormat::Depth32Float));
            let color = image(wgpu::TextureFormat::Rgba8Unorm)?;
            Ok::<_, Failure>(EyeImage { color, depth: depth.transpose()? })
        };
        let eyes = [eye()?, eye()?];
        let hidden = Default::default();
        Ok(Self { played, display, eyes, begun: None, clock, next: 0, is_closed: false, hidden, gpu })
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
        self.eyes[0].color.texture().format()
    }

    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        self.eyes[0].depth.as_ref().map(|depth| depth.texture().format())
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.eyes.each_ref().map(|eye| {
            let image = eye.color.texture();
            [image.width(), image.height()]
        })
    }

    fn hidden_areas(&self) -> &[HiddenArea; 2] {
        &self.hidden
    }

    fn sees_through(&self) -> bool {
        false
    }

    fn floor_y_m(&self) -> Option<f64> {
        Some(0.0)
    }

    fn is_patient(&self) -> bool {
        self.clock == Clock::Patient
    }

    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        if self.is_closed {
            return Ok(Moment::Ended("the session was closed".to_owned()));
        }
        if self.clock == Clock::Patient {
            self.gpu.wait()?;
        }
        let begun = *self.begun.get_or_insert_with(Instant::now);
        let period_s = self.display.period_s();
        // What is drawn from now on is shown at the next refresh that is still to come.
        let now_s = begun.elapsed().as_secs_f64();
        let refresh = match self.clock {
            Clock::Real => self.next.max((now_s / period_s).ceil() as u64),
            Clock::Patient => self.next,
        };
        self.next = refresh + 1;
        let Some(tick) = self.played.tick_at(self.display.refresh_s(refresh), period_s) else {
            return Ok(Moment::Ended("the recording is over".to_owned()));
        };
        if self.clock == Clock::Real {
            let wait_s = self.display.refresh_s(refresh) - now_s;
            std::thread::sleep(Duration::from_secs_f64(wait_s.max(0.0)));
        }
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
        self.is_closed = true;
        Ok(())
    }
}

/// A headset of which eyes and hands do what was recorded; frusta and refreshes stay its own.
pub(crate) struct Guided<H> {
    headset: H,
    played: Played,
    /// Display time of the first refresh, seconds.
    first_s: Option<f64>,
    /// Whether people know.
    is_told: bool,
}

impl<H> Guided<H> {
    pub(crate) fn new(headset: H, played: Played) -> Self {
        Self { headset, played, first_s: None, is_told: false }
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

    fn depth_format(&self) -> Option<wgpu::TextureFormat> {
        self.headset.depth_format()
    }

    fn eye_sizes(&self) -> [[u32; 2]; 2] {
        self.headset.eye_sizes()
    }

    fn hidden_areas(&self) -> &[HiddenArea; 2] {
        self.headset.hidden_areas()
    }

    fn sees_through(&self) -> bool {
        self.headset.sees_through()
    }

    fn floor_y_m(&self) -> Option<f64> {
        self.headset.floor_y_m()
    }

    fn is_patient(&self) -> bool {
        self.headset.is_patient()
    }

    fn refresh(
        &mut self,
        draw: &mut dyn FnMut(&mut dyn Sight) -> Result<(), Failure>,
    ) -> Result<Moment, Failure> {
        let Self { headset, played, first_s, .. } = self;
        let mut is_over = false;
        let moment = headset.refresh(&mut |sight| {
            let own = *sight.tick();
            let time_s = own.display_time_s - *first_s.get_or_insert(own.display_time_s);
            match played.tick_at(time_s, own.period_s) {
                Some(recorded) => draw(&mut Guide { sight, own, tick: guided(&own, &recorded) }),
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
        let warning =
            "the head and the hands are recorded ones: whoever wears the headset sees a room that moves";
        let first = (!std::mem::replace(&mut self.is_told, true)).then(|| warning.to_owned());
        first.into_iter().chain(self.headset.told()).collect()
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

/// What one head sees at a pose, for another head.
fn seen_alike(pose: &Pose, by: &Pose, other: &Pose) -> Pose {
    let by_own = by.orientation.inverse();
    other.of_own(&Pose {
        position_m: by_own * (pose.position_m - by.position_m),
        orientation: by_own * pose.orientation,
    })
}

struct Guide<'a> {
    sight: &'a mut dyn Sight,
    own: Tick,
    tick: Tick,
}

impl Sight for Guide<'_> {
    fn tick(&self) -> &Tick {
        &self.tick
    }

    fn eye_images(&mut self) -> Result<[EyeImage; 2], Failure> {
        self.sight.eye_images()
    }

    /// Where the head that looks sees it as the recorded one would.
    fn place_panel(&mut self, pose: Pose) {
        if let (Some(own), Some(recorded)) = (self.own.between_eyes(), self.tick.between_eyes()) {
            self.sight.place_panel(seen_alike(&pose, &recorded, &own));
        }
    }

    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure> {
        self.sight.panel_image()
    }
}

struct Drawn<'a> {
    tick: Tick,
    eyes: &'a [EyeImage; 2],
}

impl Sight for Drawn<'_> {
    fn tick(&self) -> &Tick {
        &self.tick
    }

    fn eye_images(&mut self) -> Result<[EyeImage; 2], Failure> {
        Ok(self.eyes.clone())
    }

    fn place_panel(&mut self, _: Pose) {}

    fn panel_image(&mut self) -> Result<Option<wgpu::TextureView>, Failure> {
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    #[test]
    fn a_panel_is_where_the_head_that_looks_sees_it_as_the_recorded_one_would() {
        let turned = |x: f64, yaw: f64| Pose {
            position_m: DVec3::new(x, 1.6, 0.2),
            orientation: DQuat::from_rotation_y(yaw),
        };
        let (recorded, own, panel) = (turned(0.1, 0.4), turned(-2.0, 2.5), turned(0.3, 1.0));
        assert!(seen_alike(&panel, &recorded, &recorded).distance_to_m(&panel) < 1e-12);
        let placed = seen_alike(&panel, &recorded, &own);
        let seen = |pose: &Pose, by: &Pose| by.orientation.inverse() * (pose.position_m - by.position_m);
        assert!(seen(&placed, &own).distance(seen(&panel, &recorded)) < 1e-12);
        let turn = |pose: &Pose, by: &Pose| by.orientation.inverse() * pose.orientation;
        assert!(turn(&placed, &own).angle_between(turn(&panel, &recorded)) < 1e-6);
    }
}
