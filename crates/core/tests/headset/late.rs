//! What counts as missed.

use proptest::prelude::*;
use wheatstone_core::headset::{Late, Second};

const PERIOD_S: f64 = 1.0 / 90.0;

proptest! {
    #[test]
    fn gaps_are_counted_whatever_the_jitter(gaps in prop::collection::vec((1..5_u32, -0.2..0.2_f64), 1..300)) {
        let mut late = Late::default();
        let start_s = 5000.0;
        late.submit(start_s, PERIOD_S);
        let (mut refresh, mut expected) = (0, Second::default());
        let mut last_jitter = 0.0;
        for (gap, jitter) in gaps {
            refresh += gap;
            let time_s = (f64::from(refresh) + jitter) * PERIOD_S;
            late.submit(start_s + time_s, PERIOD_S);
            prop_assume!((jitter - last_jitter).abs() < 0.45 && (time_s - 1.0).abs() > 1e-9);
            last_jitter = jitter;
            if time_s > 1.0 {
                expected.shown += 1;
                expected.dropped += gap - 1;
            }
        }
        prop_assert_eq!(late.total(), expected);
    }
}

#[test]
fn seconds_are_told_one_by_one() {
    let mut late = Late::default();
    // A little after whole periods, so that rounding decides nothing.
    let time_s = |refresh: i32| f64::from(refresh) * PERIOD_S + if refresh > 0 { 1e-6 } else { 0.0 };
    for refresh in (0..360).filter(|refresh| refresh % 90 != 45 && !(180..270).contains(refresh)) {
        late.submit(time_s(refresh), PERIOD_S);
    }
    let seconds: Vec<Second> = late.seconds().collect();
    let second = |shown, dropped| Second { shown, dropped };
    // What has been dropped is known when the next picture is shown.
    assert_eq!(seconds, [second(89, 1), second(89, 1), second(0, 0), second(89, 91)]);
    assert_eq!(late.total(), second(178, 92));
    for refresh in 360..360 + 90 * 100 {
        late.submit(time_s(refresh), PERIOD_S);
    }
    assert_eq!(late.seconds().count(), 60);
    assert!(late.seconds().all(|second| second.dropped == 0));
}

#[test]
fn pauses_and_times_that_are_none_do_not_count() {
    let mut late = Late::default();
    for time_s in [f64::NAN, f64::INFINITY] {
        late.submit(time_s, PERIOD_S);
    }
    for refresh in 0..180 {
        late.submit(f64::from(refresh) * PERIOD_S, PERIOD_S);
    }
    let before = late.total();
    assert_eq!(before.dropped, 0);
    late.pause();
    late.submit(100.0, PERIOD_S);
    assert_eq!(late.total(), Second { shown: before.shown + 1, dropped: 0 });
    for time_s in [100.0, 99.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        late.submit(time_s, PERIOD_S);
        assert_eq!(late.total().shown, before.shown + 1, "{time_s}");
    }
    for period_s in [0.0, -1.0, f64::NAN] {
        late.submit(101.0 - period_s.abs().min(0.5), period_s);
        assert_eq!(late.total().dropped, 0);
    }
    late.submit(1e300, PERIOD_S);
    assert_eq!(late.total().dropped, u32::MAX);
    assert_eq!(late.seconds().count(), 60);
}
