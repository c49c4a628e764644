use crate::simulation::{AVAILABLE_S, Outcome, PERIOD_S, simulate, simulate_oracle};
use crate::turntable::Turntable;
use crate::workload::{Balls, Model, Workload};
use wheatstone_core::budget::{CELLS_PER_REFRESH, CellGrid, Predictor};

const REFRESHES: u32 = 2000;

const PERIODS_PER_VIEW: [f64; 3] = [5.0, 10.0, 20.0];

/// Cells of views of 1024² pixels as `render::live` chooses them: how many a refresh holds at least, and which share of refreshes may
/// be missed.
#[derive(Clone, Copy)]
struct Way {
    cells_per_refresh: f64,
    tolerated: f64,
}

const HARDWARE: Way = Way { cells_per_refresh: CELLS_PER_REFRESH, tolerated: 0.0 };
const SOFTWARE: Way = Way { cells_per_refresh: 30.0, tolerated: 0.008 };

impl Way {
    /// What comes of a predictor, and of the oracle, with views that take so many periods.
    fn with_oracle(
        self,
        predictor: Predictor,
        periods: f64,
        model: &dyn Model,
        latency: usize,
    ) -> [Outcome; 2] {
        let side = (1024.0 / (periods * self.cells_per_refresh).sqrt()) as u32 / 8 * 8;
        let grid = CellGrid::new([1024, 1024], side).unwrap();
        let workload = || Workload::new(grid, periods * PERIOD_S, model, periods as u64);
        [
            simulate(&mut workload(), predictor, self.tolerated, latency, REFRESHES),
            simulate_oracle(&mut workload(), REFRESHES),
        ]
    }

    /// Hardly a refresh is missed, and casting gets most of the time that the oracle gives it.
    fn assert_good(self, model: &dyn Model, periods: f64, latency: usize, what: &str) {
        let [outcome, oracle] = self.with_oracle(Predictor::Corrected, periods, model, latency);
        let share = outcome.cast_per_refresh_s() / oracle.cast_per_refresh_s();
        let case = format!(
            "{} cells a refresh, {periods} periods, {what}, latency {latency}: {:.2} % missed, {:.1} % of the oracle's time, {} of {} views",
            self.cells_per_refresh,
            100.0 * outcome.missed_share(),
            100.0 * share,
            outcome.views,
            oracle.views,
        );
        assert!(outcome.missed_share() <= 0.01 && share >= 0.8, "{case}");
    }
}

#[test]
fn hardly_a_refresh_is_missed_and_most_of_the_time_is_used() {
    for way in [HARDWARE, SOFTWARE] {
        for (periods, speed, latency) in
            PERIODS_PER_VIEW.iter().flat_map(|&p| [(p, 0.0, 0), (p, 0.5, 2), (p, 1.5, 0), (p, 1.5, 2)])
        {
            way.assert_good(&Balls { speed }, periods, latency, &format!("speed {speed}"));
        }
    }
}

#[test]
fn so_it_is_with_what_cells_of_a_turning_phantom_have_taken() {
    let mut turntable = Turntable::new();
    for (turns_per_s, latency) in [(0.0, 0), (0.1, 2), (0.3, 0)] {
        turntable.turns_per_s = turns_per_s;
        for way in [HARDWARE, SOFTWARE] {
            for periods in PERIODS_PER_VIEW {
                way.assert_good(&turntable, periods, latency, &format!("{turns_per_s} turns a second"));
            }
        }
    }
}

#[test]
fn a_program_that_takes_the_device_away_does_not_starve_casting() {
    let balls = Balls { speed: 0.5 };
    let grid = CellGrid::new([1024, 1024], 40).unwrap();
    let workload = || Workload::new(grid, 10.0 * PERIOD_S, &balls, 1);
    let oracle = simulate_oracle(&mut workload(), REFRESHES);
    for (share, periods) in [(0.05, 1.0), (0.2, 1.0), (0.2, 3.0)] {
        let mut interrupted = workload().interrupted(share, periods * PERIOD_S);
        let outcome = simulate(&mut interrupted, Predictor::Corrected, 0.0, 1, REFRESHES);
        // No reserve is enough for what is interrupted, and the rest is in time.
        assert!(outcome.missed_share() <= share + 0.03, "{share} {periods}: {outcome:?}");
        assert!(3 * outcome.views > oracle.views, "{share} {periods}: {} of {}", outcome.views, oracle.views);
    }
}

#[test]
fn a_fixed_bias_casts_less_than_a_learnt_reserve() {
    let balls = Balls { speed: 0.5 };
    let outcomes = |predictor| HARDWARE.with_oracle(predictor, 10.0, &balls, 0);
    let [thesis, _] = outcomes(Predictor::Neighbourhood { bias: 1.2 });
    let [learnt, oracle] = outcomes(Predictor::Corrected);
    assert_eq!(oracle.missed, 0);
    assert!(learnt.cast_s > 1.1 * thesis.cast_s, "{learnt:?} {thesis:?}");
}

#[test]
fn casting_goes_on_where_one_cell_takes_longer_than_a_refresh() {
    let grid = CellGrid::new([64, 64], 32).unwrap();
    let balls = Balls { speed: 0.0 };
    let mut workload = Workload::new(grid, 8.0 * AVAILABLE_S, &balls, 1);
    let outcome = simulate(&mut workload, Predictor::Corrected, 0.0, 0, 40);
    assert_eq!(outcome.views, 10);
    assert!(outcome.missed > 20, "{outcome:?}");
}
