use crate::simulation::{AVAILABLE_S, Outcome, PERIOD_S, simulate, simulate_oracle};
use crate::workload::Workload;
use wheatstone_core::budget::{CellGrid, Predictor};

const REFRESHES: u32 = 2000;

const PERIODS_PER_VIEW: [f64; 3] = [5.0, 10.0, 20.0];

/// What comes of a predictor, and of the oracle, with views of 1024² pixels that take so many periods.
fn with_oracle(predictor: Predictor, periods: f64, speed: f64, latency: usize) -> [Outcome; 2] {
    let grid = CellGrid::new([1024, 1024], 32).unwrap();
    let workload = || Workload::new(grid, periods * PERIOD_S, speed, periods as u64);
    [simulate(&mut workload(), predictor, latency, REFRESHES), simulate_oracle(&mut workload(), REFRESHES)]
}

#[test]
fn hardly_a_refresh_is_missed_and_most_of_the_time_is_used() {
    for (periods, speed, latency) in
        PERIODS_PER_VIEW.iter().flat_map(|&p| [(p, 0.0, 0), (p, 0.5, 2), (p, 1.5, 0), (p, 1.5, 2)])
    {
        let [outcome, oracle] = with_oracle(Predictor::Corrected, periods, speed, latency);
        let share = outcome.cast_per_refresh_s() / oracle.cast_per_refresh_s();
        let case = format!(
            "{periods} periods, speed {speed}, latency {latency}: {:.2} % missed, {:.1} % of the oracle's time, {} of {} views",
            100.0 * outcome.missed_share(),
            100.0 * share,
            outcome.views,
            oracle.views,
        );
        assert!(outcome.missed_share() <= 0.01 && share >= 0.8, "{case}");
    }
}

#[test]
fn a_fixed_bias_casts_less_than_a_learnt_reserve() {
    let [thesis, _] = with_oracle(Predictor::Neighbourhood { bias: 1.2 }, 10.0, 0.5, 0);
    let [learnt, oracle] = with_oracle(Predictor::Corrected, 10.0, 0.5, 0);
    assert_eq!(oracle.missed, 0);
    assert!(learnt.cast_s > 1.1 * thesis.cast_s, "{learnt:?} {thesis:?}");
}

#[test]
fn casting_goes_on_where_one_cell_takes_longer_than_a_refresh() {
    let grid = CellGrid::new([64, 64], 32).unwrap();
    let mut workload = Workload::new(grid, 8.0 * AVAILABLE_S, 0.0, 1);
    let outcome = simulate(&mut workload, Predictor::Corrected, 0, 40);
    assert_eq!(outcome.views, 10);
    assert!(outcome.missed > 20, "{outcome:?}");
}
