//! One refresh after the other: input, commands, pictures, panels; then work for the device.

use super::canvas::{Canvas, Sheet};
use super::casting::{Casting, seen, views};
use super::command::Command;
use super::eyes::{BeyondReach, Eyes, Wanted};
use super::report::Report;
use super::screen::{Panels, Pictures, Screen};
use super::script::{Dropped, Due, Happening, Player, Status, of_what_exists};
use super::session::Session;
use super::show::Area;
use super::timings::Timings;
use super::ui::{Beholder, Desk, Shown, dress, run_passes};
use crate::failure::Failure;
use crate::spec::clamped_side;
use egui::{Context, PlatformOutput, RawInput, Rect, ViewportId};
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_render::Gpu;

/// How often a cast under way is looked after.
const LOOK_AFTER: Duration = Duration::from_millis(3);

/// When a window that could not be drawn on is tried again.
const TRY_AGAIN: Duration = Duration::from_millis(20);

/// How often messages are looked at.
const READ_NOTES: Duration = Duration::from_millis(500);

/// From one refresh to the next on software Vulkan.
const SOFTWARE_TIME: Duration = Duration::from_millis(40);

/// Rates of monitors that are believed, refreshes in 1000 s.
const USUAL_MILLIHERTZ: RangeInclusive<u32> = 10_000..=1_000_000;

/// The rate of a monitor that does not tell it.
const UNKNOWN_MILLIHERTZ: u32 = 60_000;

/// Session, device and panels.
pub(crate) struct Viewer {
    gpu: Arc<Gpu>,
    session: Session,
    casting: Casting,
    screen: Screen,
    eyes: Eyes,
    desk: Desk,
    context: Context,
    player: Option<Player>,
    timings: Timings,
    report: Report,
    /// What drawing the last refresh took.
    last_draw: Duration,
    /// Pictures that were complete when the last refresh was drawn.
    drawn_pictures: u64,
    /// When panels want to be drawn again.
    repaint_at: Option<Instant>,
    /// Whether eyes' pictures get finer when nothing is left to cast.
    can_refine: bool,
    /// What panels have told of how fine the picture is.
    told_quality: String,
    /// From one refresh of the display to the next.
    display_time: Duration,
}

/// What the window has to do after a refresh.
pub(crate) struct Refreshed {
    pub(crate) platform: PlatformOutput,
    /// A size that is asked for, points.
    pub(crate) resize: Option<[u32; 2]>,
}

impl Viewer {
    pub(crate) fn new(
        gpu: Arc<Gpu>,
        session: Session,
        player: Option<Player>,
        context: Context,
        canvas: &Canvas,
        begun: Instant,
    ) -> Result<Self, Failure> {
        dress(&context);
        let device = format!("{} ({})", gpu.description().name, gpu.description().backend);
        Ok(Self {
            casting: Casting::new(&gpu)?,
            screen: Screen::new(&gpu, canvas.format()),
            eyes: Eyes::new(&gpu)?.beyond_reach(BeyondReach::AsItIs),
            desk: Desk::new(),
            timings: Timings::default(),
            report: Report::new(begun, device),
            last_draw: Duration::ZERO,
            drawn_pictures: 0,
            repaint_at: Some(begun),
            can_refine: false,
            told_quality: String::new(),
            display_time: display_time(gpu.description().is_software, None),
            gpu,
            session,
            context,
            player,
        })
    }

    pub(crate) fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// What is shown is on a monitor that is refreshed so many times in 1000 s, if that is known.
    pub(crate) fn move_to_monitor(&mut self, refresh_rate_millihertz: Option<u32>) {
        self.display_time = display_time(self.gpu.description().is_software, refresh_rate_millihertz);
    }

    /// Whether the window is to fill the whole screen.
    pub(crate) fn fills_screen(&self) -> bool {
        self.session.fills_screen()
    }

    /// Whether the program is to end.
    pub(crate) fn has_quit(&self) -> bool {
        self.session.has_quit()
    }

    /// What has been measured, with everything that has failed.
    pub(crate) fn into_report(self) -> Report {
        let mut report = self.report;
        report.failures = self.session.notes.failures().to_vec();
        report
    }

    /// Asks for a refresh: something has come in.
    pub(crate) fn touch(&mut self) {
        let now = Instant::now();
        self.repaint_at = Some(self.repaint_at.map_or(now, |at| at.min(now)));
    }

    /// When the next refresh or the next look after the cast is due; none as long as nothing comes in.
    pub(crate) fn due_at(&self) -> Option<Instant> {
        let cast = (!self.casting.is_resting()).then(|| Instant::now() + LOOK_AFTER);
        [self.refresh_at(), cast].into_iter().flatten().min()
    }

    /// Whether a refresh is due; else [`Viewer::look_after`] what is being cast.
    pub(crate) fn wants_refresh(&self) -> bool {
        self.refresh_at().is_some_and(|at| at <= Instant::now())
    }

    /// Gives the device more to cast without drawing anything.
    pub(crate) fn look_after(&mut self) -> Result<(), Failure> {
        let budget = self.refresh_time();
        let looked = self.casting.refresh(&self.gpu, budget);
        self.survive(looked).map(drop)
    }

    /// Takes in events, draws, shows, and hands over work.
    pub(crate) fn refresh(&mut self, mut input: RawInput, canvas: &mut Canvas) -> Result<Refreshed, Failure> {
        let begun = Instant::now();
        let wanted = self.refresh_at().map_or(begun, |at| at.min(begun));
        self.receive(canvas)?;
        let (due, resize) = self.play(begun, &mut input);
        let mut output = self.run_panels(input);
        let area = output.1;
        let size = canvas.size();
        let pixels = Area::of_points(area, output.0.pixels_per_point).within(size);
        let state = self.session.state();
        let followed =
            views(state, pixels.size()).and_then(|aimed| self.casting.follow(&self.gpu, state, aimed));
        self.survive(followed)?;
        let mut panels = Panels::new(&self.context, &mut output.0, size);
        self.screen.update(&self.gpu, &mut panels);
        let (pictures, has_picture) = self.pictures(pixels)?;
        if self.described_quality() != self.told_quality {
            self.touch();
        }
        if let Some(sheet) = canvas.sheet(&self.gpu) {
            let submission = self.screen.draw(&self.gpu, &sheet.view(), &pictures, &panels);
            if let Sheet::Window(texture) = sheet {
                self.gpu.queue().present(texture);
            }
            let waited = self.gpu.wait_for(submission);
            self.survive(waited.map_err(Failure::Gpu))?;
            self.report.shown(has_picture, self.gpu.device());
            let due: Vec<Instant> = due.iter().map(|due| due.at).collect();
            self.report.latencies.record(&due, Instant::now());
        } else {
            self.repaint_at = Some(Instant::now() + TRY_AGAIN);
        }
        self.capture(&pictures, has_picture, &panels)?;
        self.screen.free(&panels);
        self.drawn_pictures = self.casting.pictures();
        self.measure(wanted, begun);
        let (whole, drawing) = (self.refresh_time(), self.last_draw);
        let budget = whole.saturating_sub(drawing).max(drawing.min(whole));
        let cast = self.casting.refresh(&self.gpu, budget);
        self.survive(cast)?;
        Ok(Refreshed { platform: output.0.platform_output, resize })
    }

    /// When the next refresh is due.
    fn refresh_at(&self) -> Option<Instant> {
        let now = Instant::now();
        let player = self.player.as_ref().and_then(|player| player.next_at(self.status()));
        let is_busy = self.casting.pictures() != self.drawn_pictures
            || (self.casting.is_resting() && self.can_refine)
            || (self.session.is_capturing()
                && self.session.progress().is_none()
                && self.casting.front().is_some()
                && self.casting.is_resting());
        [self.repaint_at, player, is_busy.then_some(now)].into_iter().flatten().min()
    }

    fn status(&self) -> Status {
        Status {
            is_loading: self.session.progress().is_some(),
            is_at_rest: self.casting.is_resting() && !self.can_refine && !self.session.is_capturing(),
        }
    }

    /// Shows a volume that has arrived, if it can be prepared.
    fn receive(&mut self, canvas: &Canvas) -> Result<(), Failure> {
        let Some((arrived, showing)) = self.session.step(&self.gpu, self.refresh_time()) else {
            return Ok(());
        };
        let received = views(&showing.state, canvas.size())
            .and_then(|aimed| self.casting.receive(&self.gpu, *arrived, &showing.state, aimed));
        match received {
            Ok(()) => self.session.show(showing),
            Err(failure) if failure.is_end_of_device() => return Err(failure),
            Err(failure) => self.session.refuse(&failure),
        }
        Ok(())
    }

    /// Does what a script has due; gives that, and a size that it asks for.
    fn play(&mut self, now: Instant, input: &mut RawInput) -> (Vec<Due>, Option<[u32; 2]>) {
        let status = self.status();
        let Some(player) = &mut self.player else { return (Vec::new(), None) };
        let due = player.due(now, status).unwrap_or_else(|reason| {
            self.session.notes.failed(reason);
            self.session.perform(&Command::Quit);
            Vec::new()
        });
        let mut resize = None;
        for Due { happening, .. } in &due {
            match happening {
                Happening::Command(command) => self.session.perform(command),
                Happening::Event(event) => input.events.push(event.clone()),
                Happening::EditOfSome(edit) => {
                    let edit = of_what_exists(edit, self.session.state());
                    self.session.perform(&edit.into());
                }
                Happening::Drop(path) => input.dropped_files.push(Arc::new(Dropped::new(path))),
                Happening::Resize(size) => resize = Some(size.map(clamped_side)),
            }
        }
        (due, resize)
    }

    /// Lays the panels out and does what they ask for; gives what is to be drawn and the picture's area in points.
    fn run_panels(&mut self, input: RawInput) -> (egui::FullOutput, Rect) {
        let refresh_ms = 1e3 * self.refresh_time().as_secs_f32();
        self.told_quality = self.described_quality();
        let Self { session, casting, desk, timings, report, context, told_quality, .. } = self;
        let notes = session.notes.latest().to_vec();
        let mut has_asked = false;
        let mut area = Rect::NOTHING;
        let output = run_passes(context, input, |ui| {
            let shown = Shown {
                state: session.state(),
                beholder: &Beholder::Camera,
                facts: session.facts(),
                preset: session.preset(),
                placement: casting.placement(),
                progress: session.progress(),
                notes: &notes,
                timings,
                device: &report.device,
                quality: told_quality,
                refresh_ms,
            };
            let pass = desk.show(ui, &shown);
            area = pass.picture;
            has_asked |= !pass.commands.is_empty();
            pass.commands.iter().for_each(|command| session.perform(command));
        });
        let delay =
            output.viewport_output.get(&ViewportId::ROOT).map_or(Duration::MAX, |out| out.repaint_delay);
        let delay = if has_asked { Duration::ZERO } else { delay };
        let delay = if notes.is_empty() { delay } else { delay.min(READ_NOTES) };
        self.repaint_at = Instant::now().checked_add(delay);
        (output, area)
    }

    /// How finely what is shown is cast, and how it is shown, in words.
    fn described_quality(&self) -> String {
        let is_of_display = self.session.state().stereo.arrangement.is_of_display();
        let shown = if is_of_display { "shown as it is cast".to_owned() } else { self.eyes.described() };
        format!("{}\n{shown}", self.casting.described_quality())
    }

    /// What is to be shown in an area, and whether it shows something.
    fn pictures(&mut self, area: Area) -> Result<(Pictures, bool), Failure> {
        self.can_refine = false;
        if self.session.state().stereo.arrangement.is_of_display() {
            self.display_pictures(area)
        } else {
            self.screen.show_eyes();
            let pictures = self.eyes_pictures(area)?;
            let has_picture = pictures.eyes.is_some();
            Ok((pictures, has_picture))
        }
    }

    /// The views of a light-field display: a refresh shows the newest whole picture of all of them, so that none lags behind.
    fn display_pictures(&mut self, area: Area) -> Result<(Pictures, bool), Failure> {
        let state = self.session.state();
        let (arrangement, background) = (state.stereo.arrangement, state.look.background);
        let pictures = Pictures { arrangement, area, background, eyes: None };
        let shown = match self.casting.front() {
            Some(front) => {
                let picture = self.casting.pictures();
                self.screen.show_display(&self.gpu, (front, picture), &pictures, &state.light_field)
            }
            None => Ok(false),
        };
        let has_picture = self.survive(shown)?.unwrap_or(false);
        Ok((pictures, has_picture))
    }

    fn eyes_pictures(&mut self, area: Area) -> Result<Pictures, Failure> {
        let state = self.session.state();
        let (arrangement, background) = (state.stereo.arrangement, state.look.background);
        // What was cast for a display is not for eyes.
        let front = self.casting.front().filter(|front| front.pictures().count() <= 2);
        let eyes = match (front, seen(state, area.size())) {
            (Some(front), Ok(views)) => {
                let layering = state.pace.layers.layering().map_err(Failure::input)?;
                self.eyes.step_by(layering.settings);
                let wanted = Wanted { picture: self.casting.pictures(), views, warp: state.warp() };
                let shown = if self.casting.is_resting() && self.eyes.shows(&wanted) {
                    self.eyes.refine(&self.gpu, front)
                } else {
                    self.eyes.show(&self.gpu, front, wanted)
                };
                self.can_refine = self.eyes.can_refine();
                shown
            }
            (None, Ok(_)) => Ok(None),
            (_, Err(failure)) => Err(failure),
        };
        let eyes = self.survive(eyes)?.flatten();
        Ok(Pictures { arrangement, area, background, eyes })
    }

    /// Writes the files that are asked for.
    fn capture(&mut self, pictures: &Pictures, has_picture: bool, panels: &Panels) -> Result<(), Failure> {
        let is_at_rest = self.casting.is_resting()
            && !self.can_refine
            && self.session.progress().is_none()
            && has_picture
            && self.casting.pictures() == self.drawn_pictures;
        let Self { gpu, session, screen, .. } = self;
        session.capture(is_at_rest, |capture| screen.write(gpu, capture, pictures, panels))
    }

    fn measure(&mut self, wanted: Instant, begun: Instant) {
        self.last_draw = begun.elapsed();
        self.timings.note(wanted, begun, self.last_draw, self.refresh_time());
        self.report.refreshes.push(self.last_draw);
    }

    fn refresh_time(&self) -> Duration {
        self.session.state().pace.refresh_time(self.display_time)
    }

    fn survive<T>(&mut self, outcome: Result<T, Failure>) -> Result<Option<T>, Failure> {
        self.session.notes.survive(outcome)
    }
}

/// From one refresh of a monitor to the next. Software Vulkan shares the processor with all that draws: it gets the time of 25 Hz.
fn display_time(is_software: bool, refresh_rate_millihertz: Option<u32>) -> Duration {
    if is_software {
        return SOFTWARE_TIME;
    }
    let usual = |rate: &u32| USUAL_MILLIHERTZ.contains(rate);
    Duration::from_secs_f64(
        1e3 / f64::from(refresh_rate_millihertz.filter(usual).unwrap_or(UNKNOWN_MILLIHERTZ)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refreshes_are_those_of_the_monitor_but_on_software() {
        let ms = |is_software, rate| 1e3 * display_time(is_software, rate).as_secs_f64();
        assert!((ms(false, Some(144_000)) - 1000.0 / 144.0).abs() < 1e-6);
        assert!((ms(false, Some(59_940)) - 1000.0 / 59.94).abs() < 1e-6);
        for unknown in [None, Some(0), Some(u32::MAX)] {
            assert!((ms(false, unknown) - 1000.0 / 60.0).abs() < 1e-6, "{unknown:?}");
        }
        for rate in [None, Some(60_000), Some(240_000)] {
            assert_eq!(ms(true, rate), 40.0);
        }
    }
}
