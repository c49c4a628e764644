//! One refresh after the other: eyes and hands in, pictures out, then work for the device.

use super::check::{Checking, Checks, Seen};
use super::depths::Depths;
use super::eyes::{cast_views, see_alike, upright_views};
use super::hands::Hands;
use super::headset::{EyeImage, Headset, Moment, Sight};
use super::keeping::Keeping;
use super::ladder::Ladder;
use super::panel::{self, Panel, Told};
use super::pointing::Pointing;
use super::report::Report;
use super::stage::{ColoredLine, Scenery, Stage};
use crate::failure::Failure;
use crate::viewer::casting::Casting;
use crate::viewer::command::Command;
use crate::viewer::eyes::{Eyes, Wanted};
use crate::viewer::lens::Lens;
use crate::viewer::loading::Arrived;
use crate::viewer::session::{Session, Showing};
use crate::viewer::state::{EyeMethod, WarpName};
use crate::viewer::timings::{Frame, Timings};
use crate::viewer::ui::Beholder;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Eye, Interaction, Scale, Side, Stand, Tick, floor, horizon};
use wheatstone_core::view::View;
use wheatstone_render::Gpu;

/// How long a headset that wants no pictures is left alone.
const NAP: Duration = Duration::from_millis(10);

/// Part of a refresh that is kept free, for what the runtime does with pictures.
const KEPT_FREE: f64 = 0.15;

/// From one refresh to the next before the headset has told it, seconds.
const USUAL_PERIOD_S: f64 = 1.0 / 90.0;

/// Part of the time from refresh to refresh that casting gets even where drawing takes too long: whatever is shown would else stay as
/// it is.
const LEAST_CAST: f64 = 0.1;

/// Part of the time for casting that a volume on its way gets.
const LOAD: f64 = 0.5;

/// How often a volume that everything waits for is looked after.
const LOOK_AFTER: Duration = Duration::from_millis(1);

/// Of the floor and the horizon.
const FLOOR_RGB: [f32; 3] = [0.35, 0.4, 0.45];

/// What can change how the volume is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Control {
    /// Hands: what part of it, and its transfer function.
    Hands,
    /// A window's panels as well: everything.
    HandsAndWindow,
}

/// What a session begins with.
pub(crate) struct Opening {
    pub(crate) session: Session,
    /// The volume that is shown at first.
    pub(crate) arrived: (Box<Arrived>, Showing),
    /// What is done once the volume is there.
    pub(crate) commands: Vec<Command>,
    pub(crate) control: Control,
    pub(crate) scale: Scale,
    /// Where the volume stands at first; none before the eyes.
    pub(crate) stand: Option<Stand>,
    pub(crate) has_floor: bool,
    /// When what is shown is compared with what should be.
    pub(crate) checks: Option<Checking>,
    /// Refreshes after which to end.
    pub(crate) refreshes: Option<u64>,
}

/// Waits for the volume that a session begins with.
pub(crate) fn load(session: &mut Session, gpu: &Arc<Gpu>) -> Result<(Box<Arrived>, Showing), Failure> {
    loop {
        if let Some(arrived) = session.step(gpu, Duration::MAX) {
            return Ok(arrived);
        }
        if session.progress().is_none() {
            let reason = session.notes.failures().first().cloned();
            return Err(Failure::input(reason.unwrap_or_else(|| "no volume is to be shown".to_owned())));
        }
        thread::sleep(LOOK_AFTER);
    }
}

/// Shows a volume in a headset until that ends, or something else wants it to.
pub(crate) fn run(
    headset: &mut dyn Headset,
    opening: Opening,
    beside: &mut dyn Beside,
) -> Result<Report, Failure> {
    let mut room = Room::new(headset, opening)?;
    let ended = loop {
        let moment = room.refresh(headset)?;
        let has_quit = room.wants_to_end() || beside.has_quit();
        match moment {
            Moment::Ended(reason) => break reason,
            Moment::Idle if has_quit => break "the session was closed".to_owned(),
            Moment::Idle => thread::sleep(NAP),
            Moment::Shown if has_quit => headset.close()?,
            Moment::Shown => {}
        }
        beside.refreshed(&mut room)?;
        room.cast()?;
    };
    room.into_report(ended)
}

/// What goes on beside the headset.
pub(crate) trait Beside {
    /// After each refresh, in time that is not spent casting: a mirror is drawn, ticks are recorded.
    fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure>;

    /// Whether the session is to end.
    fn has_quit(&self) -> bool;
}

/// What a window beside the headset shows.
pub(crate) struct Mirrored<'a> {
    pub(crate) session: &'a mut Session,
    pub(crate) casting: &'a Casting,
    pub(crate) timings: &'a Timings,
    pub(crate) device: &'a str,
    /// Of the left and the right eye, premultiplied.
    pub(crate) pictures: Option<&'a [wgpu::TextureView; 2]>,
    pub(crate) beholder: Beholder,
    /// Of the headset's refreshes.
    pub(crate) period_s: f64,
}

/// What time there is to cast in.
#[derive(Debug, Clone, Copy)]
struct Casts {
    until: Instant,
    /// However late it is.
    least: Duration,
}

/// The volume, what looks at it, and what takes hold of it.
pub(crate) struct Room {
    pub(super) gpu: Arc<Gpu>,
    pub(super) session: Session,
    pub(super) casting: Casting,
    pub(super) eyes: Eyes,
    /// Before the eyes' images.
    lenses: [Lens; 2],
    pub(super) stage: Stage,
    /// Where depths are kept.
    pub(super) depths: Option<Depths>,
    panel: Panel,
    hands: Option<Hands>,
    pointing: Option<Pointing>,
    ladder: Ladder,
    keeping: Keeping,
    checks: Option<Checks>,
    pub(super) scale: Scale,
    /// Where the volume is to stand when hands can take it; none before the eyes.
    stand: Option<Stand>,
    has_floor: bool,
    refreshes: Option<u64>,
    aimed: Vec<View>,
    /// A volume that is shown from the next refresh on.
    arrived: Option<(Box<Arrived>, Showing)>,
    tick: Option<Tick>,
    /// When the refresh before was begun; none after a pause.
    begun: Option<Instant>,
    /// None while the headset wants no pictures.
    casts: Option<Casts>,
    pub(super) pictures: Option<[wgpu::TextureView; 2]>,
    timings: Timings,
    floor_y_m: Option<f64>,
    /// Whether the room is seen behind the volume.
    sees_through: bool,
    report: Report,
}

impl Room {
    fn new(headset: &dyn Headset, opening: Opening) -> Result<Self, Failure> {
        let gpu = Arc::clone(headset.gpu());
        let Opening { session, arrived, commands, control, scale, stand, has_floor, checks, refreshes } =
            opening;
        let report = Report {
            device: format!("{} ({})", gpu.description().name, gpu.description().backend),
            headset: headset.name(),
            has_depth_layer: headset.depth_format().is_some(),
            ..Report::default()
        };
        let mut room = Self {
            session,
            casting: Casting::new(&gpu)?,
            eyes: Eyes::new(&gpu)?,
            lenses: Default::default(),
            stage: Stage::new(gpu.device(), headset.image_format(), headset.depth_format()),
            depths: headset.depth_format().map(|_| Depths::new(&gpu)).transpose()?,
            panel: Panel::new(&gpu, headset.image_format()),
            hands: None,
            pointing: None,
            ladder: Ladder::default(),
            keeping: Keeping::default(),
            checks: checks.map(Checks::new).transpose()?,
            scale,
            stand,
            has_floor,
            refreshes,
            aimed: Vec::new(),
            arrived: None,
            tick: None,
            begun: None,
            casts: None,
            pictures: None,
            timings: Timings::default(),
            floor_y_m: headset.floor_y_m(),
            sees_through: headset.sees_through(),
            report,
            gpu,
        };
        let begun = Instant::now();
        room.rehearse(headset, arrived, &commands, control)?;
        room.report.warm_up = begun.elapsed();
        Ok(room)
    }

    /// What eyes and hands did last.
    pub(crate) fn tick(&self) -> Option<&Tick> {
        self.tick.as_ref()
    }

    /// What a window beside the headset shows.
    pub(crate) fn mirrored(&mut self) -> Mirrored<'_> {
        let beholder = self.beholder();
        Mirrored {
            beholder,
            period_s: self.tick.map_or(USUAL_PERIOD_S, |tick| tick.period_s),
            session: &mut self.session,
            casting: &self.casting,
            timings: &self.timings,
            device: &self.report.device,
            pictures: self.pictures.as_ref(),
        }
    }

    fn beholder(&self) -> Beholder {
        let eyes = self.tick.and_then(|tick| tick.eyes);
        let views = match (eyes, &self.hands, &self.pictures) {
            (Some(eyes), Some(hands), Some(pictures)) => {
                let sizes = pictures
                    .each_ref()
                    .map(|picture| [picture.texture().width(), picture.texture().height()]);
                Some(Box::new(upright_views(&eyes, hands.stand(), sizes)))
            }
            _ => None,
        };
        Beholder::Headset { views }
    }

    fn wants_to_end(&self) -> bool {
        let is_over = self.refreshes.is_some_and(|most| self.report.refreshes >= most);
        is_over || self.session.has_quit()
    }

    /// Waits for the next refresh and draws it.
    fn refresh(&mut self, headset: &mut dyn Headset) -> Result<Moment, Failure> {
        let sizes = headset.eye_sizes();
        self.eyes.hide(headset.hidden_areas());
        for (lens, hidden) in self.lenses.iter_mut().zip(headset.hidden_areas()) {
            lens.hide(hidden);
        }
        let mut grabbed = [false; 2];
        let mut begun = None;
        let moment = headset.refresh(&mut |sight| {
            begun = Some(Instant::now());
            grabbed = self.draw(sight, sizes)?;
            Ok(())
        })?;
        for what in headset.told() {
            self.tell(&what);
        }
        for side in Side::BOTH.into_iter().filter(|side| grabbed[side.index()]) {
            headset.pulse(side)?;
        }
        match (&moment, begun, self.tick) {
            (Moment::Shown, Some(begun), Some(tick)) => {
                self.report.refreshes += 1;
                if tick.eyes.is_some() {
                    self.report.late.submit(tick.display_time_s, tick.period_s);
                } else {
                    self.report.late.pause();
                }
                self.report.period_s = tick.period_s;
                let period = Duration::try_from_secs_f64(tick.period_s).unwrap_or_default();
                let since = self.begun.map_or(period, |last| begun - last);
                let casts = Casts::after(begun, since, period);
                let whole = period.mul_f64(1.0 - KEPT_FREE);
                self.casts = Some(if headset.is_patient() { Casts { least: whole, ..casts } } else { casts });
                self.begun = Some(begun);
            }
            _ => {
                self.report.late.pause();
                (self.begun, self.casts) = (None, None);
            }
        }
        Ok(moment)
    }

    /// Takes a step of a load that is under way, and hands over as much casting as there is time for before the next refresh.
    fn cast(&mut self) -> Result<(), Failure> {
        let Some(casts) = self.casts else { return Ok(()) };
        if self.arrived.is_none() {
            self.arrived = self.session.step(&self.gpu, casts.left().mul_f64(LOAD));
        }
        let cast = self.casting.refresh(&self.gpu, casts.left());
        self.session.notes.survive(cast).map(drop)
    }

    /// Draws a refresh; which hands have taken hold of something.
    fn draw(&mut self, sight: &mut dyn Sight, sizes: [[u32; 2]; 2]) -> Result<[bool; 2], Failure> {
        let begun = Instant::now();
        let tick = *sight.tick();
        if let Some(eyes) = &tick.eyes {
            self.receive(eyes, sizes)?;
        }
        self.stand_up(&tick)?;
        let grabbed = self.follow_hands(&tick);
        self.point(&tick)?;
        let Some(eyes) = tick.eyes else {
            self.tick = Some(tick);
            return Ok(grabbed);
        };
        let stand = self.hands.as_ref().map(|hands| *hands.stand());
        let wanted = stand.map(|stand| upright_views(&eyes, &stand, sizes));
        if let Some(stand) = &stand {
            self.aim(&eyes, stand, sizes)?;
        }
        if let Some(front) = self.casting.front() {
            self.keeping.note(self.casting.pictures(), front.quality(), front.prepared().keeps_layers());
        }
        let asked = self.keeping.choose(self.session.state().pace.warp);
        let warp = self.ladder.choose(asked, tick.period_s);
        let layering = self.session.state().pace.layers.layering().map_err(Failure::input)?;
        self.eyes.step_by(layering.settings);
        self.pictures = match (self.casting.front(), &wanted) {
            (Some(front), Some(views)) => {
                let wanted = Wanted { picture: self.casting.pictures(), views: views.to_vec(), warp };
                let shown = self.eyes.show(&self.gpu, front, wanted);
                self.session.notes.survive(shown)?.flatten()
            }
            _ => None,
        };
        let depths = match (&mut self.depths, self.casting.front(), &wanted) {
            (Some(depths), Some(front), Some(views)) => depths.show(&self.gpu, front, views)?,
            _ => None,
        };
        let images = sight.eye_images()?;
        let submission = self.draw_eyes(&images, depths.as_ref(), &eyes, &tick, wanted.as_ref())?;
        if let Some(pose) = panel::place(&tick.hands) {
            sight.place_panel(pose);
        }
        if self.panel.is_due()
            && let Some(image) = sight.panel_image()?
        {
            self.draw_panel(&image, tick.period_s, warp)?;
        }
        self.gpu.wait_for(submission)?;
        let took = begun.elapsed();
        if self.pictures.is_some() {
            self.ladder.note(warp, took, tick.period_s);
            *self.report.warps.entry(warp.name()).or_default() += 1;
        }
        let since = self.tick.map_or(tick.period_s, |last| tick.display_time_s - last.display_time_s);
        self.timings.push(Frame { total_ms: 1e3 * since as f32, draw_ms: 1e3 * took.as_secs_f32() });
        self.report.draws.push(took);
        self.tick = Some(tick);
        Ok(grabbed)
    }

    /// Shows another volume that has arrived, where the one before stood.
    fn receive(&mut self, eyes: &[Eye; 2], sizes: [[u32; 2]; 2]) -> Result<(), Failure> {
        let Some(hands) = &self.hands else { return Ok(()) };
        let stand = *hands.stand();
        let Some((arrived, showing)) = self.arrived.take() else { return Ok(()) };
        let Some(showing) = self.session.notes.survive(self.session.renewed(showing))? else {
            return Ok(());
        };
        let views = self.cast_views(showing.state.stereo.method, eyes, &stand, sizes);
        match self.show(arrived, showing, views) {
            Ok(()) => {
                (self.stand, self.hands) = (Some(stand), None);
                Ok(())
            }
            Err(failure) if failure.is_end_of_device() => Err(failure),
            Err(failure) => {
                self.session.refuse(&failure);
                Ok(())
            }
        }
    }

    /// Shows a volume, cast from some views first.
    pub(super) fn show(
        &mut self,
        mut arrived: Box<Arrived>,
        showing: Showing,
        views: Vec<View>,
    ) -> Result<(), Failure> {
        let grid = arrived.facts.grid.clone();
        let held = arrived.held.take();
        self.casting.receive(&self.gpu, *arrived, &showing.state, views.clone())?;
        self.aimed = views;
        self.pointing = held.map(|caster| Pointing::new(caster, grid));
        self.report.volume = showing.name().to_owned();
        if let Some(checks) = &mut self.checks {
            checks.forget();
        }
        self.session.show(showing);
        Ok(())
    }

    /// Lets hands take the volume where it stands, with what is to be up: where it is or is to, or before the eyes. Until the head is
    /// tracked nobody knows where that is.
    fn stand_up(&mut self, tick: &Tick) -> Result<(), Failure> {
        let (Some(eyes), Some(facts)) = (tick.between_eyes(), self.session.facts()) else { return Ok(()) };
        let state = self.session.state();
        let up = state.look.up.direction();
        if self.hands.as_ref().is_some_and(|hands| hands.interaction.up() == up) {
            return Ok(());
        }
        let stands = self.hands.as_ref().map(|hands| *hands.stand()).or(self.stand);
        let stand = stands.unwrap_or_else(|| Stand::before(&eyes, &facts.grid, up, self.scale));
        let clip = state.settings().map_err(Failure::input)?.clip;
        self.hands = Some(Hands::new(Interaction::new(&facts.grid, up, stand, &clip), state));
        Ok(())
    }

    fn follow_hands(&mut self, tick: &Tick) -> [bool; 2] {
        let Some(hands) = &mut self.hands else { return [false; 2] };
        let (commands, grabbed) = hands.update(tick, &self.session);
        commands.iter().for_each(|command| self.session.perform(command));
        grabbed
    }

    /// Looks up what the hands point at.
    fn point(&mut self, tick: &Tick) -> Result<(), Failure> {
        if let (Some(pointing), Some(hands)) = (&mut self.pointing, &self.hands) {
            let values = pointing.values_under(&tick.hands, hands.stand(), self.session.state());
            self.report.values_under_hands = self.session.notes.survive(values)?.unwrap_or_default();
        }
        Ok(())
    }

    /// Has the next picture cast from where the eyes are, unless that would be the same.
    fn aim(&mut self, eyes: &[Eye; 2], stand: &Stand, sizes: [[u32; 2]; 2]) -> Result<(), Failure> {
        let views = self.cast_views(self.session.state().stereo.method, eyes, stand, sizes);
        let is_same = self
            .casting
            .placement()
            .is_some_and(|placement| see_alike(&views, &self.aimed, placement.world_from_texture()));
        if !is_same {
            self.aimed = views;
        }
        let mut state = self.session.state().clone();
        state.pace.warp = self.keeping.choose(state.pace.warp);
        let followed = self.casting.follow(&self.gpu, &state, self.aimed.clone());
        self.session.notes.survive(followed).map(drop)
    }

    /// What is to be cast for the eyes; that it is not by the method that is asked for is told once.
    pub(super) fn cast_views(
        &mut self,
        method: EyeMethod,
        eyes: &[Eye; 2],
        stand: &Stand,
        sizes: [[u32; 2]; 2],
    ) -> Vec<View> {
        let (used, views) = cast_views(method, eyes, stand, sizes);
        if used != method && !self.report.is_canted {
            self.report.is_canted = true;
            self.tell("the displays are canted or far apart: each eye's picture is cast");
        }
        self.report.eye_method = used;
        views
    }

    /// Tells people something, in the panel and beside the headset.
    fn tell(&mut self, what: &str) {
        eprintln!("{what}");
        self.session.notes.done(what);
    }

    pub(super) fn draw_eyes(
        &mut self,
        images: &[EyeImage; 2],
        depths: Option<&[wgpu::TextureView; 2]>,
        eyes: &[Eye; 2],
        tick: &Tick,
        wanted: Option<&[View; 2]>,
    ) -> Result<wgpu::SubmissionIndex, Failure> {
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let behind = if self.has_floor { surroundings(tick, self.floor_y_m) } else { Vec::new() };
        let in_front = self.hands.as_ref().map_or_else(Vec::new, |hands| hands.lines(tick));
        let background = (!self.sees_through).then_some(self.session.state().look.background);
        let [left, right] = &mut self.lenses;
        let visible = [(left, 0), (right, 1)].map(|(lens, eye): (&mut Lens, usize)| {
            let size = images[eye].color.texture().size();
            lens.visible(&eyes[eye].frustum, [size.width, size.height])
        });
        for (eye, image) in images.iter().enumerate() {
            let picture = self.pictures.as_ref().map(|pictures| &pictures[eye]);
            let depths = depths.map(|depths| &depths[eye]);
            let size = image.color.texture().size();
            let drawn = self.eyes.drawn(eye, [size.width, size.height]);
            let visible: Vec<_> = visible[eye].iter().map(|rect| rect.within(&drawn)).collect();
            let scenery =
                Scenery { behind: &behind, picture, depths, visible: &visible, in_front: &in_front };
            self.stage.draw(&self.gpu, &mut encoder, image, &eyes[eye], background, &scenery);
        }
        if let (Some(checks), Some(_), Some(wanted), Some(front)) =
            (&mut self.checks, &self.pictures, wanted, self.casting.front())
            && checks.is_due()
        {
            let cast_from: Vec<View> = front.pictures().map(|(_, view)| view).collect();
            for side in Side::BOTH {
                let eye = side.index();
                let seen = Seen {
                    eye: eyes[eye],
                    wanted: wanted[eye],
                    cast_from: cast_from[eye.min(cast_from.len() - 1)],
                    resolution: front.quality().resolution(),
                    visible: visible[eye].to_vec(),
                    background,
                    behind: behind.clone(),
                    in_front: in_front.clone(),
                };
                let kept =
                    checks.keep(&self.gpu, &mut encoder, self.session.state(), side, &images[eye], seen);
                self.session.notes.survive(kept)?;
            }
        }
        Ok(self.gpu.queue().submit([encoder.finish()]))
    }

    pub(super) fn draw_panel(
        &mut self,
        image: &wgpu::TextureView,
        period_s: f64,
        warp: WarpName,
    ) -> Result<(), Failure> {
        let state = self.session.state();
        let [lo, hi] = state.transfer.window;
        let transfer = self.session.preset().map_or_else(String::new, |preset| format!(", {preset}"));
        let look = format!("{}{transfer}, window {lo:.4} to {hi:.4}", state.look.mode.name());
        let late = self.report.late.total();
        let refreshes =
            format!("{}, warp {}, {} dropped", self.timings.described(), warp.name(), late.dropped);
        let notes: Vec<String> = self.session.notes.latest().iter().map(|note| note.text.clone()).collect();
        let told = Told {
            volume: &self.report.volume,
            look: &look,
            values: self.report.values_under_hands,
            refreshes: &refreshes,
            notes: &notes,
            timings: &self.timings,
            period_ms: 1e3 * period_s as f32,
        };
        self.panel.draw(&self.gpu, image, &told)
    }

    fn into_report(mut self, ended: String) -> Result<Report, Failure> {
        self.gpu.wait()?;
        let mut report = self.report;
        report.stand = self.hands.as_ref().map(|hands| *hands.stand());
        report.pictures = self.casting.pictures();
        report.view = serde_json::to_value(self.session.state()).map_err(Failure::input)?;
        report.failures = self.session.notes.failures().to_vec();
        report.ended = ended;
        if let Some(checks) = self.checks.take() {
            report.checked = checks.finish(&self.gpu, &mut self.casting)?;
        }
        Ok(report)
    }
}

impl Casts {
    /// After a refresh that was begun some time after the one before.
    fn after(begun: Instant, since: Duration, period: Duration) -> Self {
        Self { until: begun + period.mul_f64(1.0 - KEPT_FREE), least: since.max(period).mul_f64(LEAST_CAST) }
    }

    fn left(self) -> Duration {
        self.until.saturating_duration_since(Instant::now()).max(self.least)
    }
}

/// The floor, where it is known, and the horizon about the head.
fn surroundings(tick: &Tick, floor_y_m: Option<f64>) -> Vec<ColoredLine> {
    let Some(Pose { position_m, .. }) = tick.between_eyes() else { return Vec::new() };
    let floor = floor_y_m.into_iter().flat_map(|y_m| floor(position_m, y_m));
    floor
        .chain(horizon(position_m))
        .map(|line| ColoredLine::new(line.ends_m, line.alphas, FLOOR_RGB))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::Source;
    use crate::viewer::loading::Destination;
    use crate::vr::{Clock, DepthLayer, Played, Replay};
    use std::path::{Path, PathBuf};
    use wheatstone_core::head::Display;
    use wheatstone_core::headset::Demonstration;
    use wheatstone_render::GpuError;

    /// When another volume is opened.
    const OPENED_AT: u64 = 5;

    /// Opens another volume, and notes what every refresh from then on shows.
    struct Opener {
        file: PathBuf,
        noted: Vec<Noted>,
    }

    struct Noted {
        /// What a load is at, and the part that is done.
        load: Option<(&'static str, Option<f32>)>,
        volume: String,
        shown: Option<PathBuf>,
        has_pictures: bool,
    }

    impl Beside for Opener {
        fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure> {
            if room.report.refreshes == OPENED_AT {
                room.session.perform(&Command::Open(self.file.clone()));
            }
            if room.report.refreshes >= OPENED_AT {
                let load = room.session.progress().map(|progress| (progress.what, progress.done));
                if load.is_some_and(|(_, done)| done.is_none()) {
                    // A recording is not over before a file is read.
                    thread::sleep(NAP);
                }
                self.noted.push(Noted {
                    load,
                    volume: room.report.volume.clone(),
                    shown: room.session.state().file.clone(),
                    has_pictures: room.pictures.is_some(),
                });
            }
            Ok(())
        }

        fn has_quit(&self) -> bool {
            self.noted.iter().rev().take_while(|noted| noted.load.is_none()).count() > 5
        }
    }

    fn write_volume(path: &Path, [x, y, z]: [usize; 3]) {
        let header = format!(
            "NRRD0004\ntype: uchar\ndimension: 3\nsizes: {x} {y} {z}\nencoding: raw\nendian: little\n\n"
        );
        let voxels = (0..x * y * z).map(|index| (index % 251) as u8);
        std::fs::write(path, header.into_bytes().into_iter().chain(voxels).collect::<Vec<u8>>()).unwrap();
    }

    /// Shows `first.nrrd` of a folder without a headset, with something beside; nothing if tests without a device are asked for.
    fn show_first(folder: &Path, beside: &mut dyn Beside) -> Option<Result<Report, Failure>> {
        if std::env::var("WHEATSTONE_SKIP_GPU_TESTS").is_ok_and(|value| value == "1") {
            return None;
        }
        let gpu = Gpu::open_software().or_else(|_| Gpu::open_best());
        let gpu =
            Arc::new(gpu.unwrap_or_else(|error| panic!("{error}; WHEATSTONE_SKIP_GPU_TESTS=1 skips this")));
        let first = folder.join("first.nrrd");
        write_volume(&first, [16; 3]);
        let source = Source { file: Some(first), layout: None };
        let mut session = Session::begin(source, Arc::new(|| ()), Destination::Headset).unwrap();
        let arrived = load(&mut session, &gpu).unwrap();
        let demonstration = Demonstration::new(&arrived.0.facts.grid, arrived.1.state.look.up.direction());
        let stand = Some(*demonstration.stand());
        let played = Played::Demonstration(Box::new(demonstration));
        let mut headset =
            Replay::new(gpu, played, Display::default(), Clock::Patient, [32; 2], DepthLayer::Without)
                .unwrap();
        let opening = Opening {
            session,
            arrived,
            commands: Vec::new(),
            control: Control::Hands,
            scale: Scale::Human,
            stand,
            has_floor: false,
            checks: None,
            refreshes: None,
        };
        Some(run(&mut headset, opening, beside))
    }

    fn open_beside(folder: &Path, file: &str) -> Option<(Report, Vec<Noted>)> {
        let mut opener = Opener { file: folder.join(file), noted: Vec::new() };
        let report = show_first(folder, &mut opener)?.unwrap();
        Some((report, opener.noted))
    }

    /// Pulls the device out after some refreshes.
    struct Unplugging(u32);

    impl Beside for Unplugging {
        fn refreshed(&mut self, room: &mut Room) -> Result<(), Failure> {
            self.0 = self.0.saturating_sub(1);
            if self.0 == 0 {
                room.gpu.device().destroy();
            }
            Ok(())
        }

        fn has_quit(&self) -> bool {
            false
        }
    }

    #[test]
    fn a_device_that_is_lost_ends_the_session_and_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let Some(lost) = show_first(folder.path(), &mut Unplugging(5)) else { return };
        assert!(matches!(lost, Err(Failure::Gpu(GpuError::Lost { .. }))), "{lost:?}");
    }

    #[test]
    fn the_volume_before_is_shown_until_another_has_arrived_in_steps() {
        let folder = tempfile::tempdir().unwrap();
        write_volume(&folder.path().join("second.nrrd"), [128, 128, 48]);
        let Some((report, noted)) = open_beside(folder.path(), "second.nrrd") else { return };
        assert_eq!((&*report.volume, &report.failures), ("second.nrrd", &Vec::new()));
        let arrived = noted.iter().position(|noted| noted.volume == "second.nrrd").unwrap();
        for noted in &noted[..arrived] {
            assert_eq!(noted.volume, "first.nrrd");
            assert!(noted.has_pictures && noted.shown.as_ref().unwrap().ends_with("first.nrrd"));
        }
        for noted in &noted[arrived..] {
            assert_eq!((&*noted.volume, noted.load), ("second.nrrd", None));
            assert!(noted.has_pictures && noted.shown.as_ref().unwrap().ends_with("second.nrrd"));
        }
        // A step is at most four times as large as those before, and the first is small.
        for what in ["uploading", "looking for empty space"] {
            let done = |noted: &Noted| noted.load.filter(|load| load.0 == what).and_then(|load| load.1);
            let done: Vec<f32> = noted.iter().filter_map(done).collect();
            assert!(done.len() >= 4, "{what} in {} refreshes: {done:?}", done.len());
            assert!(done.is_sorted() && done[0] == 0.0, "{what}: {done:?}");
        }
    }

    #[test]
    fn a_file_that_is_no_volume_leaves_the_one_before() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("bad.nrrd"), "no volume").unwrap();
        let Some((report, noted)) = open_beside(folder.path(), "bad.nrrd") else { return };
        assert_eq!(report.volume, "first.nrrd");
        assert!(
            report.failures.len() == 1 && report.failures[0].contains("bad.nrrd"),
            "{:?}",
            report.failures
        );
        assert!(noted.iter().all(|noted| noted.volume == "first.nrrd" && noted.has_pictures));
    }

    #[test]
    fn casting_goes_on_where_drawing_takes_a_whole_refresh() {
        let ms = Duration::from_millis;
        let past =
            |since: Duration| Casts { until: Instant::now(), ..Casts::after(Instant::now(), since, ms(11)) };
        assert!(past(ms(11)).left() > ms(1));
        // A tenth of the time that refreshes do take.
        assert!(past(ms(80)).left() >= ms(8));
        let ahead = Casts::after(Instant::now() + ms(1000), ms(11), ms(11));
        assert!(ahead.left() > ms(900));
    }
}
