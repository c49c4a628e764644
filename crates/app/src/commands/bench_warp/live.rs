//! What is shown at which refresh, in real time.

use super::aim::{Aim, AimName};
use super::timeline::{Pace, Refresh};
use crate::backend::LiveEngine;
use crate::failure::Failure;
use serde_json::{Value, json};
use std::thread::sleep;
use std::time::{Duration, Instant};
use wheatstone_core::head::{Display, HeadMotion, Pose};
use wheatstone_core::view::View;
use wheatstone_render::live::{Activity, LiveView};
use wheatstone_render::warp::{Picture, Shown, Warps};
use wheatstone_render::{Gpu, GpuError};

/// Room that a refresh has while it is found out what pictures take.
const PROBE_BUDGET: Duration = Duration::from_millis(20);

/// Pictures that are cast to find out what they take.
const PROBES: u32 = 4;

/// Time that is kept for a warp, as a multiple of the longest in the probes.
const RESERVED_WARPS: f64 = 2.0;

/// How well casting has kept to its time during a motion.
#[derive(Debug, Clone)]
pub(super) struct Keeping {
    pub(super) case: String,
    pace: Pace,
    refreshes: usize,
    missed: usize,
    /// Latest that a warp was done after its refresh, seconds; negative if all were early.
    latest_s: f64,
    /// Time that cells took, seconds.
    cast_s: f64,
}

impl Keeping {
    /// Share of the time of refreshes that cells took, without what is kept for the warp.
    fn cast_share(&self) -> f64 {
        self.cast_s / (self.refreshes as f64 * self.pace.available_s())
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "case": self.case,
            "render_ms": 1e3 * self.pace.render_s,
            "period_ms": 1e3 * self.pace.display.period_s(),
            "reserve_ms": 1e3 * self.pace.reserve_s,
            "refreshes": self.refreshes,
            "missed": self.missed,
            "latest_ms": 1e3 * self.latest_s,
            "cast_share": self.cast_share(),
        })
    }

    pub(super) fn to_line(&self) -> String {
        format!(
            "{}: pictures of {:.0} ms, refreshes of {:.1} ms with {:.1} ms for the warp: {} of {} missed, by {:.1} ms at most; \
             {:.0} % of the other time casts",
            self.case,
            1e3 * self.pace.render_s,
            1e3 * self.pace.display.period_s(),
            1e3 * self.pace.reserve_s,
            self.missed,
            self.refreshes,
            1e3 * self.latest_s,
            1e2 * self.cast_share(),
        )
    }
}

/// What turns the newest picture into what the eyes see: the quad warp, on the device.
struct Screen {
    warps: Warps,
    picture: Picture,
}

impl Screen {
    fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, GpuError> {
        Ok(Self { warps: Warps::new(gpu, Picture::FORMAT)?, picture: Picture::new(gpu, size)? })
    }

    /// Shows the front picture as a view wants it, and waits until that is done.
    fn show(&mut self, gpu: &Gpu, live: &LiveView, wanted: &View) -> Result<(), Failure> {
        let mut encoder = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if let Some(front) = live.front()
            && let Some((target, view)) = front.pictures().next()
        {
            let shown = Shown::new(target, view, front.prepared());
            self.warps
                .quad(gpu, &mut encoder, &shown, wanted, self.picture.canvas())
                .map_err(Failure::input)?;
        }
        gpu.queue().submit([encoder.finish()]);
        Ok(gpu.wait()?)
    }
}

/// A display of which a picture takes so many refreshes, by what the device takes for some views of a motion and for warping
/// them.
pub(super) fn fitting_pace(
    engine: &mut LiveEngine<'_>,
    motion: &HeadMotion,
    like: &View,
    refreshes: f64,
    least_reserve_s: f64,
) -> Result<Pace, Failure> {
    let mut live = engine.view(motion.eyes_at(0.0).view(like))?;
    let mut screen = Screen::new(engine.gpu, like.size)?;
    let (mut render_s, mut reserve_s) = (0.0, least_reserve_s);
    for probe in 0..PROBES {
        let time_s = motion.duration_s() * f64::from(probe) / f64::from(PROBES);
        live.aim(&[motion.eyes_at(time_s).view(like)])?;
        render_s = complete(engine, &mut live)?;
        let start = Instant::now();
        screen.show(engine.gpu, &live, &motion.eyes_at(0.0).view(like))?;
        if probe > 0 {
            reserve_s = reserve_s.max(RESERVED_WARPS * start.elapsed().as_secs_f64());
        }
    }
    let display = Display::new((render_s / refreshes + reserve_s).recip()).map_err(Failure::input)?;
    Ok(Pace { display, render_s, reserve_s })
}

/// Casts a picture to its end; what that took, seconds.
fn complete(engine: &mut LiveEngine<'_>, live: &mut LiveView) -> Result<f64, Failure> {
    let (mut cast_s, mut is_complete) = (0.0, false);
    loop {
        engine.gpu.wait()?;
        let refresh = live.refresh(engine.gpu, engine.renderer, PROBE_BUDGET)?;
        if is_complete {
            return Ok(cast_s + refresh.measured.map_or(0.0, |measured| measured.cast_s));
        }
        is_complete = match refresh.activity {
            Activity::Casting { completes_view, .. } => completes_view,
            _ => true,
        };
        cast_s += refresh.measured.map_or(0.0, |measured| measured.cast_s);
    }
}

/// The refreshes of a motion as [`timeline::refreshes`](super::timeline::refreshes) simulates them, but as they come out: cells
/// are cast, and each refresh is waited for.
pub(super) fn refreshes(
    engine: &mut LiveEngine<'_>,
    (motion, aim): (&HeadMotion, AimName),
    like: &View,
    pace: &Pace,
    case: String,
) -> Result<(Vec<Refresh>, Keeping), Failure> {
    let period_s = pace.display.period_s();
    let ahead_s = (pace.render_s / pace.available_s()).ceil() * period_s;
    let mut live = engine.view(motion.eyes_at(0.0).view(like))?;
    complete(engine, &mut live)?;
    let mut screen = Screen::new(engine.gpu, like.size)?;
    screen.show(engine.gpu, &live, like)?;
    let latest_s = f64::NEG_INFINITY;
    let mut keeping = Keeping { case, pace: *pace, refreshes: 0, missed: 0, latest_s, cast_s: 0.0 };
    let (mut shown, mut picture) = (Vec::new(), 0);
    let start = Instant::now();
    let mut refresh = 0.0;
    let mut aim = Aim::new(aim, motion);
    while refresh * period_s <= motion.duration_s() {
        let begins_s = refresh * period_s;
        sleep_until(start, begins_s);
        live.aim(&[aim.eyes_at(begins_s + ahead_s, begins_s)?.view(like)])?;
        let warp_begins_s = begins_s + pace.available_s();
        let left_s = (warp_begins_s - start.elapsed().as_secs_f64()).max(0.0);
        let done = live.refresh(engine.gpu, engine.renderer, Duration::from_secs_f64(left_s))?;
        picture += u64::from(matches!(done.activity, Activity::Casting { completes_view: true, .. }));
        keeping.cast_s += done.measured.map_or(0.0, |measured| measured.cast_s);
        sleep_until(start, warp_begins_s);
        refresh += 1.0;
        let eyes = motion.eyes_at(refresh * period_s);
        screen.show(engine.gpu, &live, &eyes.view(like))?;
        let late_s = start.elapsed().as_secs_f64() - refresh * period_s;
        let is_missed = late_s > 0.0;
        keeping.missed += usize::from(is_missed);
        keeping.refreshes += 1;
        keeping.latest_s = keeping.latest_s.max(late_s);
        let front = live.front().and_then(|front| front.pictures().next());
        let cast_from = front.map_or(eyes, |(_, view)| Pose::of(&view));
        shown.push(Refresh { eyes, cast_from, picture, is_missed });
    }
    Ok((shown, keeping))
}

fn sleep_until(start: Instant, time_s: f64) {
    sleep(Duration::from_secs_f64(time_s).saturating_sub(start.elapsed()));
}
