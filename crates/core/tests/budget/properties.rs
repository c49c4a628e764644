use proptest::prelude::*;
use std::collections::VecDeque;
use wheatstone_core::budget::{Batch, BudgetError, CastSchedule, CellGrid, Predictor, ViewRequest};

/// What is done to a schedule.
#[derive(Debug, Clone)]
enum Event {
    Plan(f64),
    PlanMore(f64),
    Aim(u32),
    Supersede(u32),
    Replace(u32),
    /// The times of the oldest batch come back; each cell took so long.
    Record(f64),
}

fn event() -> impl Strategy<Value = Event> {
    let seconds = || prop_oneof![Just(f64::NAN), Just(-1.0), Just(f64::INFINITY), 0.0..0.1_f64];
    let duration = prop_oneof![Just(0.0), 0.0..0.1_f64, Just(1e300)];
    prop_oneof![
        6 => seconds().prop_map(Event::Plan),
        1 => seconds().prop_map(Event::PlanMore),
        1 => (0..4_u32).prop_map(Event::Aim),
        1 => (0..4_u32).prop_map(Event::Supersede),
        1 => (0..4_u32).prop_map(Event::Replace),
        4 => duration.prop_map(Event::Record),
    ]
}

/// Pictures differ in size.
fn request(content: u32) -> ViewRequest<u32> {
    ViewRequest::new(content, CellGrid::new([90 + 17 * content, 70], 16).unwrap(), 1.0).unwrap()
}

/// Follows what a schedule says to cast.
#[derive(Default)]
struct Targets {
    view: Option<u64>,
    cells: Vec<usize>,
    front: Option<u32>,
}

impl Targets {
    /// Casts a batch of the view under way, by what the schedule said it was.
    fn cast(&mut self, batch: &Batch, content: u32) -> Result<(), TestCaseError> {
        if self.view != Some(batch.view()) {
            (self.view, self.cells) = (Some(batch.view()), vec![]);
        }
        prop_assert!(!batch.cells().is_empty());
        prop_assert!(batch.cells().iter().all(|cell| !self.cells.contains(cell)), "cast twice");
        self.cells.extend(batch.cells());
        let all = request(content).grid().cells();
        prop_assert!(self.cells.iter().all(|&cell| cell < all));
        prop_assert_eq!(batch.completes_view(), self.cells.len() == all);
        if batch.completes_view() {
            self.front = Some(content);
        }
        Ok(())
    }
}

proptest! {
    #[test]
    fn no_cell_is_lost_or_cast_twice_and_pictures_are_whole(
        events in prop::collection::vec(event(), 1..300), is_thesis: bool,
    ) {
        let predictor = if is_thesis { Predictor::Neighbourhood { bias: 1.1 } } else { Predictor::Corrected };
        let mut schedule = CastSchedule::new(request(0), predictor);
        let (mut targets, mut wanted) = (Targets::default(), 0);
        let mut waiting: VecDeque<Batch> = VecDeque::new();
        for event in events {
            match event {
                Event::Aim(content) => { wanted = content; schedule.aim(request(content)); }
                Event::Supersede(content) => { wanted = content; schedule.supersede(request(content)); }
                Event::Replace(content) => { wanted = content; schedule.replace(request(content)); }
                Event::Record(s) => if let Some(batch) = waiting.pop_front() {
                    schedule.record(&batch, &vec![s; batch.cells().len()]).unwrap();
                },
                Event::Plan(available_s) => {
                    let content = schedule.back().map_or(wanted, |back| back.content);
                    let is_due = schedule.back().is_some() || targets.front != Some(wanted);
                    let batch = schedule.plan(available_s);
                    prop_assert_eq!(batch.is_some(), is_due);
                    if let Some(batch) = batch {
                        targets.cast(&batch, content)?;
                        waiting.push_back(batch);
                    }
                }
                Event::PlanMore(left_s) => {
                    let content = schedule.back().map(|back| back.content);
                    if let Some(batch) = schedule.plan_more(left_s) {
                        targets.cast(&batch, content.unwrap())?;
                        waiting.push_back(batch);
                    }
                }
            }
            prop_assert_eq!(schedule.front().map(|front| front.content), targets.front);
        }
    }

    #[test]
    fn every_view_ends_however_little_time_there_is(available_s in prop_oneof![Just(f64::NAN), -1.0..0.01_f64]) {
        let mut schedule = CastSchedule::new(request(2), Predictor::Corrected);
        let cells = request(2).grid().cells();
        let batches = std::iter::from_fn(|| {
            let batch = schedule.plan(available_s)?;
            schedule.record(&batch, &vec![0.02; batch.cells().len()]).unwrap();
            Some(batch)
        });
        prop_assert_eq!(batches.take(cells + 1).map(|batch| batch.cells().len()).sum::<usize>(), cells);
        prop_assert_eq!(schedule.front(), Some(&request(2)));
        prop_assert_eq!(schedule.plan(available_s), None);
    }
}

#[test]
fn a_pose_takes_effect_when_the_next_view_begins() {
    let mut schedule = CastSchedule::new(request(0), Predictor::Corrected);
    let first = schedule.plan(0.01).unwrap();
    schedule.aim(request(1));
    assert_eq!(schedule.back(), Some(&request(0)));
    while schedule.back().is_some() {
        schedule.plan(0.01);
    }
    assert_eq!(schedule.front(), Some(&request(0)));
    let second = schedule.plan(0.01).unwrap();
    assert_eq!((schedule.back(), second.view()), (Some(&request(1)), first.view() + 1));
}

#[test]
fn superseding_at_every_refresh_still_shows_pictures() {
    let mut schedule = CastSchedule::new(request(0), Predictor::Corrected);
    let mut shown = vec![];
    for refresh in 0..2000 {
        schedule.supersede(request(refresh % 3));
        shown.extend(schedule.plan(0.0).filter(Batch::completes_view));
    }
    let cells = request(2).grid().cells();
    assert!(shown.len() >= 2000 / (cells + 1) - 1, "{} of {cells} cells", shown.len());
}

#[test]
fn a_transfer_function_that_triples_costs_misses_two_refreshes_at_most() {
    let mut schedule = CastSchedule::new(request(0), Predictor::Corrected);
    let mut missed = 0;
    for refresh in 0..400 {
        let cell_s = if refresh < 300 { 0.0005 } else { 0.0015 };
        match refresh {
            300 => schedule.supersede(request(4)),
            _ => schedule.aim(request(if schedule.front() == Some(&request(2)) { 3 } else { 2 })),
        }
        let batch = schedule.plan(0.009).unwrap();
        missed += usize::from(cell_s * batch.cells().len() as f64 > 0.009);
        schedule.record(&batch, &vec![cell_s; batch.cells().len()]).unwrap();
    }
    assert!(missed <= 2, "{missed}");
}

#[test]
fn a_view_that_supersedes_one_of_nothing_is_begun_with_few_cells() {
    let mut schedule = CastSchedule::new(request(4), Predictor::Corrected);
    while let Some(batch) = schedule.plan(0.009) {
        schedule.record(&batch, &vec![1e-9; batch.cells().len()]).unwrap();
    }
    schedule.supersede(request(3));
    let cells = request(3).grid().cells();
    let first = schedule.plan(0.009).unwrap();
    assert!(first.cells().len() <= cells.div_ceil(16), "{} of {cells}", first.cells().len());
    schedule.record(&first, &vec![1.0; first.cells().len()]).unwrap();
    assert_eq!(schedule.plan(0.009).unwrap().cells().len(), 1);
}

#[test]
fn times_that_are_none_are_refused() {
    let mut schedule = CastSchedule::new(request(0), Predictor::Corrected);
    let batch = schedule.plan(1.0).unwrap();
    assert_eq!(schedule.record(&batch, &[]), Err(BudgetError::Durations { durations: 0, cells: 1 }));
    assert_eq!(schedule.record(&batch, &[-1.0]), Err(BudgetError::Seconds(-1.0)));
    assert!(schedule.record(&batch, &[f64::NAN]).is_err());
    assert!(schedule.record(&batch, &[f64::INFINITY]).is_err());
    assert!(ViewRequest::new((), *request(0).grid(), 0.0).is_err());
}
