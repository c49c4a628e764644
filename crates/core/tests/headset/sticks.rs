//! Steps through presets, and shifts of the window.

use crate::hands::*;
use wheatstone_core::headset::{Changes, Hand, Interaction, Tick};

/// What a sequence of sticks and triggers leads to, at so many refreshes per second.
fn play(rate_hz: f64, duration_s: f64, hand_at: impl Fn(f64) -> Hand) -> (Interaction, Vec<Changes>) {
    let mut interaction = interaction();
    let mut changes: Vec<Changes> = Vec::new();
    for refresh in 0..=(duration_s * rate_hz).round() as u32 {
        let display_time_s = f64::from(refresh) / rate_hz;
        let hands = [Hand::default(), hand_at(display_time_s)];
        let tick = Tick { display_time_s, period_s: 1.0 / rate_hz, eyes: None, hands };
        let window = changes.last().map_or(window(), |last| last.window);
        changes.push(interaction.update(&tick, window));
    }
    (interaction, changes)
}

fn steps(rate_hz: f64, duration_s: f64, stick_at: impl Fn(f64) -> [f32; 2]) -> i32 {
    let hand_at = |time_s| Hand { stick: stick_at(time_s), ..Hand::default() };
    play(rate_hz, duration_s, hand_at).1.iter().map(|changes| changes.preset_steps).sum()
}

#[test]
fn a_flick_is_one_step() {
    let swung = |time_s: f64| (8.0 * time_s).sin() as f32;
    for rate_hz in [30.0, 72.0, 120.0] {
        // Half a swing to the right; then one to the left; then trembling about what counts as down.
        assert_eq!(steps(rate_hz, 0.39, |time_s| [swung(time_s), 0.0]), 1);
        assert_eq!(steps(rate_hz, 0.78, |time_s| [-swung(time_s), 0.0]), 0);
        let trembles = |time_s: f64| [0.7 + 0.2 * (60.0 * time_s).sin() as f32, 0.1];
        assert_eq!(steps(rate_hz, 0.45, trembles), 1);
        assert_eq!(steps(rate_hz, 0.45, |_| [0.6, 0.0]), 0);
        assert_eq!(steps(rate_hz, 0.45, |_| [-1.0, 0.0]), -1);
        assert_eq!(steps(rate_hz, 0.45, |_| [0.8, 0.9]), 0, "it means up");
    }
}

#[test]
fn a_stick_that_is_held_goes_on_every_half_second() {
    for (duration_s, expected) in [(0.4, 1), (0.9, 2), (2.4, 5)] {
        assert_eq!(steps(90.0, duration_s, |_| [1.0, 0.0]), expected);
        assert_eq!(steps(90.0, duration_s, |_| [-1.0, 0.0]), -expected);
    }
}

#[test]
fn the_window_shifts_by_half_its_width_a_second_whatever_the_rate() {
    for rate_hz in [20.0, 72.0, 144.0] {
        let (_, changes) = play(rate_hz, 1.0, |_| Hand { stick: [0.0, 1.0], ..Hand::default() });
        let last = changes[changes.len() - 1].window;
        assert!((last.lo() - 100.0).abs() < 1e-9 && (last.hi() - 500.0).abs() < 1e-9, "{last:?}");
    }
    // Half-way beyond the dead zone, down.
    let (_, changes) = play(90.0, 1.0, |_| Hand { stick: [0.0, -0.6], ..Hand::default() });
    let last = changes[changes.len() - 1].window;
    assert!((last.lo() + 200.0).abs() < 1e-4 && (last.hi() - last.lo() - 400.0).abs() < 1e-9, "{last:?}");
}

#[test]
fn the_window_doubles_in_a_second_with_the_trigger_pulled() {
    let (_, changes) = play(90.0, 1.0, |_| Hand { stick: [0.0, 1.0], ..pulled(at(9.0, 9.0, 9.0)) });
    let last = changes[changes.len() - 1].window;
    assert!((last.lo() + 300.0).abs() < 1e-6 && (last.hi() - 500.0).abs() < 1e-6, "{last:?}");
}

#[test]
fn a_stick_near_its_middle_changes_nothing() {
    let (_, changes) = play(90.0, 1.0, |time_s| {
        let angle = 5.0 * time_s as f32;
        Hand { stick: [0.2 * angle.cos(), 0.2 * angle.sin()], ..Hand::default() }
    });
    for change in changes {
        assert_eq!((change.window, change.preset_steps), (window(), 0));
    }
}

#[test]
fn times_and_sticks_that_are_none_change_nothing() {
    let mut interaction = interaction();
    let stick = Hand { stick: [f32::NAN, f32::NAN], ..Hand::default() };
    for display_time_s in [0.0, f64::NAN, -1.0, f64::INFINITY, 1.0, 1e300] {
        let tick = Tick { display_time_s, period_s: PERIOD_S, eyes: None, hands: [stick; 2] };
        let changes = interaction.update(&tick, window());
        assert_eq!((changes.window, changes.preset_steps), (window(), 0));
    }
    // A long pause counts as a short one.
    let up = Hand { stick: [0.0, 1.0], ..Hand::default() };
    let mut interaction = crate::hands::interaction();
    let mut update = |display_time_s| {
        let tick = Tick { display_time_s, period_s: PERIOD_S, eyes: None, hands: [up, Hand::default()] };
        interaction.update(&tick, window()).window
    };
    update(0.0);
    assert!((update(1000.0).lo() - window().lo() - 20.0).abs() < 1e-9);
}
