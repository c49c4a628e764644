//! Which cells to cast before the next refresh.

use super::margin::Margin;
use super::{Batch, BudgetError, CellCosts, Expectation, Predictor, ViewRequest};

/// Share of a refresh for cells of a view that supersedes another, until the first of them are measured: another transfer
/// function may make them dearer.
const SHARE_IN_DOUBT: f64 = 0.5;

/// Share of the cells of such a view that its first batch holds at most: where nothing was to be seen, all of them seem to fit.
const CELLS_IN_DOUBT: f64 = 1.0 / 16.0;

/// Share of a refresh that is kept in reserve at most. What takes a multiple of its time now and then, however few cells there are, is
/// not the cells' doing but that of another program on the device, for which no reserve is enough.
const MOST_RESERVED: f64 = 0.5;

/// How many times as long as expected a cell may seem to take. What takes longer has most likely been interrupted, as by a compositor; if
/// not, the cells about it say so as well, and the next ones are expected to take longer.
const MOST_SURPRISE: f64 = 4.0;

/// Casts a view after the other, a batch of cells per refresh (VR Alg. 4), with a front picture that is complete and a back
/// picture under way.
///
/// Before each refresh [`plan`](Self::plan) gives the cells for the time that is left when the warp's is taken away; what they
/// took is told to [`record`](Self::record), at once or refreshes later. The last cells of a view swap front and back, and the
/// rest of that refresh is left free, so that the next view begins with the newest pose. What is shown already is not cast again.
///
/// `C` is all that tells one picture from another. Which of three calls brings a new one says when it takes effect:
/// [`aim`](Self::aim), [`supersede`](Self::supersede) or [`replace`](Self::replace). Whichever it is, the front picture stays until
/// another one is complete.
#[derive(Debug, Clone)]
pub struct CastSchedule<C> {
    predictor: Predictor,
    margin: Margin,
    costs: CellCosts,
    wanted: ViewRequest<C>,
    back: Option<UnderWay<C>>,
    front: Option<ViewRequest<C>>,
    views_begun: u64,
    /// Whether work has been dropped since the last swap.
    has_superseded: bool,
    /// Whether the last view tells little about the next.
    is_next_doubtful: bool,
}

/// A view that is being cast.
#[derive(Debug, Clone)]
struct UnderWay<C> {
    request: ViewRequest<C>,
    order: Vec<usize>,
    next: usize,
    /// Whether the last view tells little about it.
    is_doubtful: bool,
}

impl<C: Clone + PartialEq> CastSchedule<C> {
    /// Begins with nothing shown and nothing known about costs.
    pub fn new(first: ViewRequest<C>, predictor: Predictor) -> Self {
        Self {
            predictor,
            margin: Margin::default(),
            costs: CellCosts::new(*first.grid(), first.work_per_pixel()),
            wanted: first,
            back: None,
            front: None,
            views_begun: 0,
            has_superseded: false,
            is_next_doubtful: false,
        }
    }

    /// Lets so large a share of batches take longer than they have, instead of one in 256: where times have long tails, most of the
    /// budget would else be kept in reserve for them.
    #[must_use]
    pub fn tolerating(self, missed_share: f64) -> Self {
        Self { margin: Margin::tolerating(missed_share), ..self }
    }

    /// The picture to cast next, when the one under way is complete: a new pose.
    pub fn aim(&mut self, request: ViewRequest<C>) {
        self.wanted = request;
    }

    /// The picture to cast now: another transfer function, a far pose, or a coarser view because something begins to move. What is
    /// known about costs is in doubt for it. Drops what is under way, unless that has itself superseded other work since the last
    /// swap. So pictures are completed however often one is superseded.
    pub fn supersede(&mut self, request: ViewRequest<C>) {
        self.aim(request);
        self.is_next_doubtful = true;
        if !self.has_superseded && self.back.take().is_some() {
            self.has_superseded = true;
        }
    }

    /// The only picture that can still be cast: another volume. Drops what is under way and what is known about costs.
    pub fn replace(&mut self, request: ViewRequest<C>) {
        self.back = None;
        self.margin.forget();
        self.costs = CellCosts::new(*request.grid(), request.work_per_pixel());
        // Times of cells cast so far are another volume's.
        self.views_begun += 2;
        self.aim(request);
    }

    /// Casting the complete picture has failed: it is not shown, and cast again if it is still wanted.
    pub fn forget_front(&mut self) {
        self.front = None;
    }

    /// The complete picture: what is shown, warped to the newest pose.
    pub fn front(&self) -> Option<&ViewRequest<C>> {
        self.front.as_ref()
    }

    /// The picture under way; none before the first batch of a view and after the last.
    pub fn back(&self) -> Option<&ViewRequest<C>> {
        self.back.as_ref().map(|back| &back.request)
    }

    /// What is known about the costs of cells.
    pub fn costs(&self) -> &CellCosts {
        &self.costs
    }

    /// Cells for a refresh with so many seconds for casting, at least one; none if the picture wanted is the one shown. While
    /// nothing is known but cells of the same view, no more than have been measured: the first may be empty corners. So it is where
    /// what is known is in doubt, but for the first batch.
    /// Time that is negative or no number counts as none.
    pub fn plan(&mut self, available_s: f64) -> Option<Batch> {
        if self.back.is_none() && self.front.as_ref() != Some(&self.wanted) {
            self.begin();
        }
        self.fill(available_s, 1)
    }

    /// More cells of the view under way for the time left in the same refresh, where [`plan`](Self::plan)'s have been measured
    /// already; none if none fit.
    pub fn plan_more(&mut self, left_s: f64) -> Option<Batch> {
        self.fill(left_s, 0)
    }

    /// Learns what the cells of a batch took, seconds. Times of views before the last are of no use any more.
    ///
    /// # Errors
    /// Not one duration for each cell, or a negative or infinite one; then nothing is learnt.
    pub fn record(&mut self, batch: &Batch, seconds: &[f64]) -> Result<(), BudgetError> {
        if seconds.len() != batch.cells.len() {
            return Err(BudgetError::Durations { durations: seconds.len(), cells: batch.cells.len() });
        }
        for &s in seconds {
            BudgetError::unless_duration(s)?;
        }
        let uninterrupted = |(&cell, &s): (&usize, &f64)| (cell, self.uninterrupted_s(cell, s));
        let timed: Vec<(usize, f64)> = batch.cells.iter().zip(seconds).map(uninterrupted).collect();
        match self.views_begun.checked_sub(batch.view) {
            Some(1) => timed.iter().for_each(|&(cell, s)| self.costs.record(cell, s)),
            Some(2) => timed.iter().for_each(|&(cell, s)| self.costs.record_late(cell, s)),
            _ => return Ok(()),
        }
        if self.costs.is_known() {
            self.margin.learn(batch.expected_s, batch.variance_s2, seconds.iter().sum());
        }
        Ok(())
    }

    /// What a cell that seems to have taken some seconds has taken most likely, where there is reason to expect anything of it.
    fn uninterrupted_s(&self, cell: usize, seconds: f64) -> f64 {
        let is_doubtful = self.back.as_ref().is_some_and(|back| back.is_doubtful);
        let is_known = self.costs.is_known() && !is_doubtful;
        let expected = self.predictor.predict(&self.costs, cell).filter(|_| is_known);
        let most_s = expected
            .map_or(f64::INFINITY, |expected| MOST_SURPRISE * expected.seconds.max(self.costs.mean_last_s()));
        seconds.min(most_s)
    }

    fn begin(&mut self) {
        let request = self.wanted.clone();
        if self.views_begun > 0 {
            self.costs = self.costs.next_view(*request.grid(), request.work_per_pixel());
        } else {
            self.costs = CellCosts::new(*request.grid(), request.work_per_pixel());
        }
        self.views_begun += 1;
        let is_doubtful = std::mem::take(&mut self.is_next_doubtful);
        self.back = Some(UnderWay { order: request.grid().order(), request, next: 0, is_doubtful });
    }

    fn fill(&mut self, available_s: f64, at_least: usize) -> Option<Batch> {
        let deviations = self.margin.deviations();
        let measured = self.costs.measured_cells();
        let back = self.back.as_mut()?;
        let most = if !self.costs.is_known() {
            measured.max(at_least)
        } else if back.is_doubtful {
            measured.max((CELLS_IN_DOUBT * back.order.len() as f64).ceil() as usize)
        } else {
            usize::MAX
        };
        let share = if back.is_doubtful && measured == 0 { SHARE_IN_DOUBT } else { 1.0 };
        let available_s = share * available_s;
        let first = back.next;
        let (mut expected_s, mut variance_s2) = (0.0, 0.0);
        while let Some(&cell) = back.order.get(back.next) {
            let unknown = Expectation { seconds: f64::INFINITY, variance_s2: 0.0 };
            let cell = self.predictor.predict(&self.costs, cell).unwrap_or(unknown);
            let wanted_s = deviations * (variance_s2 + cell.variance_s2).sqrt();
            let reserved_s = wanted_s.min(MOST_RESERVED * available_s);
            let fits = expected_s + cell.seconds + reserved_s <= available_s;
            let count = back.next - first;
            if (!fits && count >= at_least) || count >= most {
                break;
            }
            expected_s += cell.seconds;
            variance_s2 += cell.variance_s2;
            back.next += 1;
        }
        if back.next == first {
            return None;
        }
        let cells = back.order[first..back.next].to_vec();
        let completes_view = back.next == back.order.len();
        if completes_view {
            self.front = self.back.take().map(|back| back.request);
            self.has_superseded = false;
        }
        Some(Batch { view: self.views_begun - 1, cells, expected_s, variance_s2, completes_view })
    }
}
