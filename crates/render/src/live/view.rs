//! One picture under a budget.

use super::cells::{CellSizes, RigCells};
use super::clock::PieceClock;
use super::open_batch::OpenBatch;
use super::piece::Piece;
use super::spares::Spares;
use super::under_way::UnderWay;
use super::wanted::Wanted;
use super::{Activity, Front, LiveError, Measured, Refresh};
use crate::gpu::{Gpu, GpuError, SUBMISSION_TIMEOUT};
use crate::renderer::{Prepared, Renderer};
use crate::uniforms::ViewUniform;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use wheatstone_core::budget::{CastSchedule, Predictor, Quality, QualityControl, ViewRequest};
use wheatstone_core::view::View;

/// Rays are not cast in shorter parts, seconds.
const SHORTEST_PIECE_S: f64 = 0.004;

/// Targets that are in no picture are kept up to the pixels of so many of full quality: those of all levels of a view that comes to
/// rest have 1.6 times as many as the last.
const SPARE_PICTURES: u64 = 2;

/// Share of refreshes that may be late on software Vulkan, which shares the processor with all that runs besides.
const MISSED_SHARE_OF_SOFTWARE: f64 = 0.008;

/// The pictures of a rig's views, cast together a few cells per refresh. Whatever changes, and however often, the front
/// picture is whole: of all views, from one pose, with one volume's settings.
///
/// Which of three calls brings a change says when it takes effect: [`aim`](Self::aim), [`supersede`](Self::supersede) or
/// [`replace`](Self::replace). They are cheap; what is made of them is up to the next refresh.
#[derive(Debug)]
pub struct LiveView {
    schedule: CastSchedule<Wanted>,
    control: Option<QualityControl>,
    cell_sizes: CellSizes,
    /// Of a picture, pixels.
    largest_side: u32,
    /// At full quality.
    wanted: Wanted,
    change: Option<Change>,
    /// The settings with longer steps.
    coarser: HashMap<Quality, Arc<Prepared>>,
    /// Of the view that began last.
    last_quality: Quality,
    /// Samples of the view that began last, as far as they depend on quality and settings.
    last_work: f64,
    under_way: Option<UnderWay>,
    open: Option<OpenBatch>,
    flight: Option<Flight>,
    front: Option<Front>,
    /// Set as long as the last cells of the front picture are in flight.
    unproven: Option<Unproven>,
    spares: Spares,
    clock: PieceClock,
    uniforms: wgpu::Buffer,
    /// Time that the host took to hand the last pieces over, before the device begins with them.
    handing_over_s: f64,
    begun: Instant,
}

/// What has changed since the last refresh, the least first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Change {
    Pose,
    Settings,
    Volume,
}

/// Pieces that the device has been given.
#[derive(Debug)]
struct Flight {
    /// Which cells of their batch they are of.
    places: Vec<usize>,
    submitted: Instant,
    budget_s: f64,
    is_first: bool,
}

/// A front picture whose last cells may yet fail.
#[derive(Debug)]
struct Unproven {
    /// What was shown before it.
    before: Option<Front>,
}

impl LiveView {
    /// Begins with nothing shown. Without a control every view is of full quality.
    ///
    /// # Errors
    /// [`LiveError::Views`] unless there are views of one size, a size that the device cannot hold, a lost device.
    pub fn new(
        gpu: &Gpu,
        settings: Arc<Prepared>,
        views: &[View],
        control: Option<QualityControl>,
    ) -> Result<Self, LiveError> {
        let largest_side = gpu.capabilities().largest_2d_side;
        let wanted = Wanted::new(views, settings, largest_side)?;
        let cell_sizes = CellSizes::of(gpu.description().is_software);
        let (request, _) = request(&wanted, cell_sizes.first_side())?;
        let uniforms = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("views of pieces"),
            size: (PieceClock::MOST_PIECES * size_of::<ViewUniform>()) as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        let clock = PieceClock::new(gpu);
        let missed_share = if gpu.description().is_software { MISSED_SHARE_OF_SOFTWARE } else { 0.0 };
        gpu.check()?;
        Ok(Self {
            schedule: CastSchedule::new(request, Predictor::Corrected).tolerating(missed_share),
            control: control.map(|control| control.beginning_at(Quality::COARSEST)),
            cell_sizes,
            largest_side,
            wanted,
            change: None,
            coarser: HashMap::new(),
            last_quality: Quality::COARSEST,
            last_work: 1.0,
            under_way: None,
            open: None,
            flight: None,
            front: None,
            unproven: None,
            spares: Spares::default(),
            clock,
            uniforms,
            handing_over_s: 0.0,
            begun: Instant::now(),
        })
    }

    /// The views to cast next, when those under way are complete: a new pose or size.
    ///
    /// # Errors
    /// [`LiveError::Views`] unless there are views, all of one size, and a size that the device cannot hold; then nothing
    /// changes.
    pub fn aim(&mut self, views: &[View]) -> Result<(), LiveError> {
        let wanted = Wanted::new(views, Arc::clone(&self.wanted.settings), self.largest_side)?;
        if wanted != self.wanted {
            self.want(wanted, Change::Pose);
        }
        Ok(())
    }

    /// Other settings of the same volume, such as a transfer function or longer steps: drops the picture under way, unless one has been
    /// dropped since the last was complete, so that pictures are completed however often settings change.
    pub fn supersede(&mut self, settings: Arc<Prepared>) {
        self.want(self.wanted.with_settings(settings), Change::Settings);
    }

    /// Another volume, or settings with which a sample takes far more or less time: drops the picture under way and what is known of times.
    pub fn replace(&mut self, settings: Arc<Prepared>) {
        self.want(self.wanted.with_settings(settings), Change::Volume);
    }

    /// What all cells of the view that began last take, as far as is known, seconds.
    pub fn view_s(&self) -> Option<f64> {
        self.schedule.costs().view_s()
    }

    /// The newest picture that is whole. Work submitted from now on finds it finished.
    pub fn front(&self) -> Option<&Front> {
        self.front.as_ref()
    }

    /// Learns what has been finished and hands cells over that take no longer than a budget, but at least one, or the least
    /// part of one; never waits.
    ///
    /// # Errors
    /// No memory, a lost or hung device. The picture under way is then begun anew; in the
    /// place of one that may be faulty the one before is shown.
    pub fn refresh(
        &mut self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        budget: Duration,
    ) -> Result<Refresh, LiveError> {
        let refresh = self.try_refresh(gpu, renderer, budget.as_secs_f64());
        if refresh.is_err() {
            self.give_up(gpu);
        }
        refresh
    }

    fn try_refresh(
        &mut self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        budget_s: f64,
    ) -> Result<Refresh, LiveError> {
        gpu.poll()?;
        let mut measured = None;
        if let Some(flight) = &self.flight {
            let Some(seconds) = self.clock.read()? else {
                return if flight.submitted.elapsed() > SUBMISSION_TIMEOUT {
                    Err(GpuError::Hung { seconds: SUBMISSION_TIMEOUT.as_secs() }.into())
                } else {
                    Ok(Refresh { activity: Activity::Busy, measured })
                };
            };
            measured = self.learn(&seconds)?;
        }
        if let Some(change) = self.change.take() {
            self.apply(change, budget_s)?;
        }
        if let Some(idle) = self.plan(gpu, renderer, (budget_s - self.handing_over_s).max(0.0))? {
            return Ok(Refresh { activity: idle, measured });
        }
        let start = Instant::now();
        let activity = self.hand_over(gpu, renderer, budget_s)?;
        self.handing_over_s = start.elapsed().as_secs_f64().min(0.5 * budget_s);
        Ok(Refresh { activity, measured })
    }

    fn want(&mut self, wanted: Wanted, change: Change) {
        self.wanted = wanted;
        self.change = self.change.max(Some(change));
    }

    /// The pieces in flight have taken some seconds each.
    fn learn(&mut self, seconds: &[f64]) -> Result<Option<Measured>, LiveError> {
        let (Some(flight), Some(open)) = (self.flight.take(), &mut self.open) else { return Ok(None) };
        open.add(&flight.places, seconds);
        self.close_batch()?;
        self.prove_front();
        let Flight { budget_s, is_first, .. } = flight;
        Ok(Some(Measured { budget_s, cast_s: seconds.iter().sum(), is_first }))
    }

    /// The front picture's last cells are done: what was shown before is not needed any more.
    fn prove_front(&mut self) {
        let before = self.unproven.take().and_then(|unproven| unproven.before);
        before
            .into_iter()
            .flat_map(|before| before.targets)
            .for_each(|target| self.spares.give_back_target(target));
    }

    /// Tells the schedule what the cells of a batch took, if all of them are cast.
    fn close_batch(&mut self) -> Result<(), LiveError> {
        if let Some(open) = self.open.take_if(|open| open.is_handed_over()) {
            self.schedule.record(&open.batch, open.seconds())?;
        }
        Ok(())
    }

    fn apply(&mut self, change: Change, budget_s: f64) -> Result<(), LiveError> {
        let now_s = self.begun.elapsed().as_secs_f64();
        if change > Change::Pose {
            self.coarser.clear();
        }
        let (request, _) =
            request(&self.wanted.with_quality(self.last_quality), self.cell_sizes.first_side())?;
        match change {
            Change::Volume => {
                self.last_quality = Quality::COARSEST;
                self.schedule.replace(request);
            }
            Change::Settings => self.schedule.supersede(request),
            Change::Pose => {
                let view_s = self.view_s().unwrap_or(f64::NAN);
                let is_too_fine =
                    |control: &QualityControl| control.is_too_fine(self.last_quality, view_s, budget_s);
                if self.schedule.back().is_some() && self.control.as_ref().is_some_and(is_too_fine) {
                    self.schedule.supersede(request);
                }
            }
        }
        if let Some(control) = self.control.as_mut().filter(|_| change < Change::Volume) {
            control.moved(now_s);
        }
        let completes = self.open.as_ref().is_some_and(|open| open.batch.completes_view());
        if self.schedule.back().is_none() && !completes {
            self.open = None;
            self.under_way.take().into_iter().for_each(|view| view.give_up(&mut self.spares));
        }
        Ok(())
    }

    /// Sees to it that there is a batch to cast; or says why there is none.
    fn plan(&mut self, gpu: &Gpu, renderer: &Renderer, budget_s: f64) -> Result<Option<Activity>, LiveError> {
        if self.open.is_some() {
            return Ok(None);
        }
        if self.schedule.back().is_none()
            && let Some(idle) = self.begin(gpu, renderer, budget_s)?
        {
            return Ok(Some(idle));
        }
        let (Some(view), Some(batch)) = (&self.under_way, self.schedule.plan(budget_s)) else {
            return Ok(Some(Activity::Resting));
        };
        let piece_s = budget_s.max(SHORTEST_PIECE_S);
        let fits = batch.expected_s() <= piece_s;
        let cut = |(place, &cell): (usize, &usize)| {
            let whole = view.whole_cell(place, cell)?;
            let share = if fits {
                1.0
            } else if batch.expected_s().is_finite() {
                piece_s / batch.expected_s()
            } else {
                Piece::guessed_share(&view.prepared, &whole.squares, piece_s)
            };
            Some(Piece::of_cell(&whole, &view.prepared, share))
        };
        let pieces = batch.cells().iter().enumerate().filter_map(cut).flatten().collect();
        self.open = Some(OpenBatch::new(batch, pieces, fits));
        Ok(None)
    }

    /// Begins the view that is wanted; or says why none is.
    fn begin(
        &mut self,
        gpu: &Gpu,
        renderer: &Renderer,
        budget_s: f64,
    ) -> Result<Option<Activity>, LiveError> {
        let front = self.front.as_ref().filter(|front| front.wanted.is_of_same(&self.wanted));
        let shown = front.map(|front| front.wanted.quality);
        if shown == Some(Quality::FULL) {
            return Ok(Some(Activity::Resting));
        }
        let s_per_work = self.schedule.costs().view_s().map(|view_s| view_s / self.last_work);
        let now_s = self.begun.elapsed().as_secs_f64();
        let last_s = s_per_work.map(|s| s * self.wanted.with_quality(self.last_quality).work());
        let quality = self.control.as_mut().map_or(Quality::FULL, |control| {
            control.next(now_s, self.last_quality, last_s.unwrap_or(f64::NAN), budget_s)
        });
        if shown.is_some_and(|shown| shown <= quality) {
            return Ok(Some(Activity::Waiting));
        }
        let wanted = self.wanted.with_quality(quality);
        let work = wanted.work();
        let side = s_per_work.map_or(self.cell_sizes.first_side(), |s| {
            self.cell_sizes.side(wanted.covered_px(), s * work, budget_s)
        });
        let (request, cells) = request(&wanted, side)?;
        let prepared = self.prepared(gpu, renderer, quality)?;
        self.spares.keep_within(SPARE_PICTURES * self.wanted.full_px());
        let view = UnderWay::new(gpu, renderer, &mut self.spares, wanted, cells, prepared)?;
        self.under_way = Some(view);
        if self.front.as_ref().is_some_and(|front| self.wanted.is_far_from(&front.wanted)) {
            self.schedule.supersede(request);
        } else {
            self.schedule.aim(request);
        }
        self.last_quality = quality;
        self.last_work = work;
        Ok(None)
    }

    /// The wanted settings with the steps of a quality.
    fn prepared(
        &mut self,
        gpu: &Gpu,
        renderer: &Renderer,
        quality: Quality,
    ) -> Result<Arc<Prepared>, GpuError> {
        let settings = &self.wanted.settings;
        if quality == Quality::FULL {
            return Ok(Arc::clone(settings));
        }
        if let Some(coarser) = self.coarser.get(&quality) {
            return Ok(Arc::clone(coarser));
        }
        let coarser = Arc::new(renderer.with_longer_steps(gpu, settings, quality.step_factor())?);
        self.coarser.insert(quality, Arc::clone(&coarser));
        Ok(coarser)
    }

    /// Gives pieces of the batch to the device.
    fn hand_over(
        &mut self,
        gpu: &Gpu,
        renderer: &mut Renderer,
        budget_s: f64,
    ) -> Result<Activity, LiveError> {
        let (Some(view), Some(open)) = (&mut self.under_way, &mut self.open) else {
            return Ok(Activity::Resting);
        };
        let pieces = open.take(PieceClock::MOST_PIECES);
        let is_cast = |piece: &&Piece| !piece.squares.is_empty();
        let places: Vec<usize> = pieces.iter().filter(is_cast).map(|piece| piece.place).collect();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        view.encode(gpu, renderer, &mut encoder, (&pieces, &self.uniforms), &self.clock)?;
        if !places.is_empty() {
            self.clock.encode_reading(&mut encoder, places.len());
        }
        gpu.queue.submit([encoder.finish()]);
        let completes_view = open.is_handed_over() && open.batch.completes_view();
        let cells = open.batch.cells().len();
        if places.is_empty() {
            self.close_batch()?;
        } else {
            let is_first = open.batch.expected_s().is_infinite();
            let submitted = Instant::now();
            self.clock.begin_reading(gpu, places.len());
            self.flight = Some(Flight { places, submitted, budget_s, is_first });
        }
        if completes_view {
            let whole = self.under_way.take().map(|view| view.complete(&mut self.spares));
            let before = std::mem::replace(&mut self.front, whole);
            self.unproven = Some(Unproven { before });
        }
        gpu.check()?;
        if self.flight.is_none() {
            self.prove_front();
        }
        Ok(Activity::Casting { cells, completes_view })
    }

    /// After an error: nothing is under way, and nothing that may be faulty is shown.
    fn give_up(&mut self, gpu: &Gpu) {
        self.under_way = None;
        self.open = None;
        self.spares = Spares::default();
        self.clock = PieceClock::new(gpu);
        self.flight = None;
        if let Some(unproven) = self.unproven.take() {
            self.front = unproven.before;
            self.schedule.forget_front();
        }
        self.change = Some(Change::Volume);
    }
}

/// The request of a picture of cells with sides of so many pixels or more, and its cells.
fn request(wanted: &Wanted, side: u32) -> Result<(ViewRequest<Wanted>, RigCells), LiveError> {
    let cells = RigCells::new(wanted.size(), wanted.eyes(), side)?;
    Ok((ViewRequest::new(wanted.clone(), cells.grid(), wanted.work_per_pixel())?, cells))
}
