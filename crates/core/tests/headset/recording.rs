//! Recordings: what is written is read back, and what is none is refused.

use crate::hands::*;
use glam::DQuat;
use proptest::prelude::*;
use wheatstone_core::head::{Display, Pose};
use wheatstone_core::headset::{
    Demonstration, Eye, Hand, LineError, Pinch, Recorder, Recording, RecordingError, Tick, TickError,
};
use wheatstone_core::view::AnatomicalDirection::Superior;
use wheatstone_core::view::Frustum;

fn any_hand() -> impl Strategy<Value = Hand> {
    let pressed = (0.0_f32..=1.0, 0.0_f32..=1.0, prop::array::uniform2(-1.0_f32..=1.0), any::<bool>());
    let pinch =
        (poses(), 0.0_f32..=1.0).prop_map(|(pose, closed)| Pinch { position_m: pose.position_m, closed });
    (prop::option::of(poses()), prop::option::of(poses()), pressed, prop::option::of(pinch)).prop_map(
        |(grip, aim, (squeeze, trigger, stick, menu), pinch)| Hand {
            grip,
            aim,
            squeeze,
            trigger,
            stick,
            menu,
            pinch,
        },
    )
}

fn any_eye() -> impl Strategy<Value = Eye> {
    let far_m = prop_oneof![Just(f64::INFINITY), 1.0..1e4_f64];
    (poses(), prop::array::uniform4(0.1..2.0_f64), far_m).prop_map(
        |(pose, [left, right, down, up], far_m)| Eye {
            pose,
            frustum: Frustum { left: -left, right, down: -down, up, near_m: 0.01, far_m },
        },
    )
}

fn any_ticks() -> impl Strategy<Value = Vec<Tick>> {
    let tick =
        (prop::option::of((any_eye(), any_eye())), (any_hand(), any_hand()), 0.001..0.1_f64, any::<bool>());
    prop::collection::vec(tick, 1..8).prop_map(|ticks| {
        let mut display_time_s = 1234.5;
        ticks
            .into_iter()
            .map(|(eyes, (left, right), gap_s, is_usual)| {
                display_time_s += gap_s;
                let period_s = if is_usual { PERIOD_S } else { gap_s };
                Tick { display_time_s, period_s, eyes: eyes.map(|(a, b)| [a, b]), hands: [left, right] }
            })
            .collect()
    })
}

fn text(recording: &Recording) -> String {
    let mut text = Vec::new();
    recording.write(&mut text).unwrap();
    String::from_utf8(text).unwrap()
}

fn demonstration() -> Recording {
    Demonstration::new(&grid(), Superior).recording(Display::new(10.0).unwrap()).unwrap()
}

fn assert_close(a: &Tick, b: &Tick, tolerance: f64) {
    let pair = |a: Option<Pose>, b: Option<Pose>| match (a, b) {
        (Some(a), Some(b)) => {
            assert!(a.distance_to_m(&b).max(a.angle_to_rad(&b)) <= tolerance, "{a:?} {b:?}");
        }
        (a, b) => assert_eq!(a, b),
    };
    for side in 0..2 {
        let (of_a, of_b) = (a.hands[side], b.hands[side]);
        pair(of_a.grip, of_b.grip);
        pair(of_a.aim, of_b.aim);
        let pressed = |hand: Hand| Hand { grip: None, aim: None, ..hand };
        assert_eq!(pressed(of_a), pressed(of_b));
        let eye = |tick: &Tick| tick.eyes.map(|eyes| eyes[side]);
        pair(eye(a).map(|eye| eye.pose), eye(b).map(|eye| eye.pose));
        assert_eq!(eye(a).map(|eye| eye.frustum), eye(b).map(|eye| eye.frustum));
    }
    assert_eq!((a.display_time_s, a.period_s), (b.display_time_s, b.period_s));
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(ticks in any_ticks()) {
        let recording = Recording::new(ticks.clone()).unwrap();
        let read = Recording::read(text(&recording).as_bytes()).unwrap();
        prop_assert_eq!(read.ticks().len(), ticks.len());
        for (read, tick) in read.ticks().iter().zip(&ticks) {
            assert_close(read, tick, 1e-14);
        }
    }

    #[test]
    fn between_ticks_is_between_them(ticks in any_ticks(), share in 0.0..1.0_f64) {
        let recording = Recording::new(ticks).unwrap();
        for pair in recording.ticks().windows(2) {
            let [before, after] = [&pair[0], &pair[1]];
            assert_eq!(recording.tick_at(before.display_time_s).as_ref(), Some(before));
            let time_s = before.display_time_s + share * (after.display_time_s - before.display_time_s);
            prop_assume!(time_s > before.display_time_s && time_s < after.display_time_s);
            let between = recording.tick_at(time_s).unwrap();
            prop_assert_eq!(between.display_time_s, time_s);
            prop_assert_eq!(between.eyes.is_some(), before.eyes.is_some() && after.eyes.is_some());
            for side in 0..2 {
                let [a, b, c] = [before, &between, after].map(|tick| tick.hands[side]);
                prop_assert_eq!((a.squeeze, a.trigger, a.stick, a.menu), (b.squeeze, b.trigger, b.stick, b.menu));
                prop_assert_eq!(b.grip.is_some(), a.grip.is_some() && c.grip.is_some());
                if let (Some(a), Some(b), Some(c)) = (a.grip, b.grip, c.grip) {
                    let whole = [a.distance_to_m(&c), a.angle_to_rad(&c)];
                    prop_assert!((a.distance_to_m(&b) + b.distance_to_m(&c) - whole[0]).abs() < ROUNDING);
                    prop_assert!((a.angle_to_rad(&b) + b.angle_to_rad(&c) - whole[1]).abs() < 1e-6);
                    let share = (time_s - before.display_time_s) / (after.display_time_s - before.display_time_s);
                    prop_assert!((a.distance_to_m(&b) - share * whole[0]).abs() < ROUNDING);
                    prop_assert!((a.angle_to_rad(&b) - share * whole[1]).abs() < 1e-6);
                }
            }
        }
        let [first, last] = [0, recording.ticks().len() - 1].map(|index| recording.ticks()[index].display_time_s);
        prop_assert_eq!(recording.tick_at(first - 1e-3), None);
        prop_assert!(recording.tick_at(last).is_some());
        prop_assert_eq!(recording.tick_at(last + 1e-3), None);
        prop_assert_eq!(recording.tick_at(f64::NAN), None);
    }

    #[test]
    fn arbitrary_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), line in 0..3_usize, at in 0..400_usize) {
        let _ = Recording::read(bytes.as_slice());
        // And in the middle of something that is a recording otherwise.
        let whole = text(&demonstration());
        let mut lines: Vec<Vec<u8>> = whole.lines().take(3).map(|line| line.as_bytes().to_vec()).collect();
        let at = at.min(lines[line].len());
        lines[line].splice(at..at, bytes);
        let _ = Recording::read(lines.join(&b'\n').as_slice());
    }
}

#[test]
fn a_replay_at_another_rate_is_the_same_motion() {
    let recording = Demonstration::new(&grid(), Superior).recording(Display::new(200.0).unwrap()).unwrap();
    let display = Display::new(72.0).unwrap();
    let replayed: Vec<Tick> = recording.replay(display).collect();
    assert_eq!(replayed.len(), (recording.duration_s() * 72.0).floor() as usize + 1);
    let truth = Demonstration::new(&grid(), Superior);
    for tick in &replayed {
        let expected = truth.tick_at(tick.display_time_s, display.period_s());
        let (found, expected) = (tick.between_eyes().unwrap(), expected.between_eyes().unwrap());
        assert!(found.distance_to_m(&expected) < 1e-5 && found.angle_to_rad(&expected) < 1e-5);
        assert_eq!(tick.period_s, display.period_s());
    }
}

#[test]
fn frusta_and_period_are_written_once() {
    let text = text(&demonstration());
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 107);
    assert!(lines[0].contains("\"wheatstone_recording\":1") && lines[0].contains("\"left\":-1.2"));
    assert!(lines[1..].iter().all(|line| !line.contains("left") && !line.contains("period_s")));
    assert!(text.len() < 107 * 1500, "{}", text.len() / 107);
}

#[test]
fn the_documented_example_is_read() {
    let document = include_str!("../../../../docs/recordings.md");
    let example = document.split("```json\n").nth(1).unwrap().split("```").next().unwrap();
    let recording = Recording::read(example.as_bytes()).unwrap();
    let [first, last] = recording.ticks() else { panic!("{recording:?}") };
    assert!(first.eyes.is_some() && last.eyes.is_none());
    assert_eq!(first.eyes.unwrap()[1].frustum.far_m, f64::INFINITY);
    assert_eq!((first.period_s, last.period_s), (0.02, 0.04));
    assert!(first.hands[1].grip.is_some() && last.hands[0].stick == [-1.0, 0.25] && last.hands[1].menu);
    assert_eq!(text(&recording), example);
    assert!(document.contains("8192 bytes") && document.contains("324,000 ticks"));
}

#[test]
fn bad_lines_are_refused_by_number() {
    let whole = text(&demonstration());
    let lines: Vec<&str> = whole.lines().take(4).collect();
    let changed = |line: usize, from: &str, to: &str| {
        let mut lines: Vec<String> = lines.iter().map(|&line| line.to_owned()).collect();
        assert!(lines[line - 1].contains(from), "{from} in {}", lines[line - 1]);
        lines[line - 1] = lines[line - 1].replacen(from, to, 1);
        Recording::read(lines.join("\n").as_bytes()).unwrap_err().to_string()
    };
    let expect = |message: String, parts: &[&str]| {
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        assert!(!message.contains("at line 1"), "{message}");
    };
    expect(changed(1, "recording\":1", "recording\":2"), &["line 1", "version 2", "version 1"]);
    expect(changed(1, "\"s, m, ", "\"ms, mm, "), &["line 1", "ms, mm", "must be"]);
    expect(changed(1, "period_s", "perod_s"), &["line 1", "perod_s"]);
    expect(changed(3, "\"time_s\":0.1", "\"time_s\":0.0"), &["line 3", "order of time"]);
    expect(changed(3, "\"time_s\":0.1", "\"time_s\":1e9"), &["line 3", "at most 86400 s apart"]);
    expect(changed(3, "\"time_s\":0.1", "\"time_s\":1e999"), &["line 3", "column"]);
    expect(changed(3, "\"time_s\":0.1", "\"time_s\":1e99"), &["line 3", "time_s", "must be from"]);
    expect(changed(4, "\"squeeze\":0.0", "\"squeeze\":1.5"), &["line 4", "squeeze is 1.5"]);
    expect(changed(4, "\"stick\":[0.0,0.0]", "\"stick\":[0.0,-7]"), &["line 4", "stick is -7"]);
    expect(changed(4, "\"stick\":[0.0,0.0]", "\"stick\":[0.0,1e39]"), &["line 4"]);
    expect(changed(4, "\"hands\":", "\"feet\":"), &["line 4", "feet"]);
    expect(changed(2, "\"orientation\":[", "\"orientation\":[0.1,"), &["line 2", "column"]);
    expect(changed(2, "\"position_m\":[", "\"position_m\":[\"x\","), &["line 2", "column"]);
    expect(changed(2, "1.0]}", "1.1]}"), &["line 2", "unit orientation"]);
    expect(changed(1, "\"right\":1.0", "\"right\":-2.0"), &["line 2", "left must be below right"]);
    expect(changed(4, "{", &format!("{{{}", " ".repeat(9000))), &["line 4", "8192"]);
    let frusta = &lines[0][lines[0].find(",\"frusta\"").unwrap()..lines[0].len() - 1];
    expect(changed(1, frusta, ""), &["line 2", "frusta"]);
    expect(Recording::read(lines[0].as_bytes()).unwrap_err().to_string(), &["at least one tick"]);
    expect(Recording::read(&b""[..]).unwrap_err().to_string(), &["at least one tick"]);
    expect(Recording::read(&b"\xff\xfe"[..]).unwrap_err().to_string(), &["line 1"]);
}

#[test]
fn orientations_are_read_with_unit_length() {
    let lines = text(&demonstration()).lines().take(2).collect::<Vec<_>>().join("\n");
    let rounded = lines.replacen("\"orientation\":[0.0,0.0,0.0,1.0]", "\"orientation\":[0,0,0.6,0.80003]", 1);
    assert_ne!(rounded, lines);
    let read = Recording::read(rounded.as_bytes()).unwrap();
    let orientation: DQuat = read.ticks()[0].eyes.unwrap()[0].pose.orientation;
    assert!(
        (orientation.length() - 1.0).abs() < 1e-15 && (orientation.z - 0.6).abs() < 1e-4,
        "{orientation}"
    );
}

#[test]
fn a_recorder_leaves_out_what_is_no_tick_and_goes_on() {
    let mut written = Vec::new();
    let mut recorder = Recorder::new(&mut written);
    let demonstration = demonstration();
    let [first, second] = [0, 1].map(|index: usize| demonstration.ticks()[index]);
    recorder.record(&first).unwrap();
    let again = recorder.record(&first).unwrap_err();
    assert!(matches!(again, RecordingError::Tick { index: 1, fault: TickError::Order { .. } }), "{again}");
    let mut broken = second;
    broken.hands[0].grip = Some(Pose { position_m: glam::DVec3::NAN, ..at(0.0, 0.0, 0.0) });
    let none = recorder.record(&broken).unwrap_err();
    assert!(matches!(none, RecordingError::Tick { fault: TickError::Pose("grip"), .. }), "{none}");
    recorder.record(&second).unwrap();
    recorder.finish().unwrap();
    assert_eq!(Recording::read(written.as_slice()).unwrap().ticks(), [first, second]);
    assert!(matches!(Recorder::new(Vec::new()).finish(), Err(RecordingError::Empty)));
    assert!(matches!(Recording::new(Vec::new()), Err(RecordingError::Empty)));
}

#[test]
fn endless_lines_and_endless_files_are_ended() {
    let endless = std::io::BufReader::new(std::io::repeat(b'['));
    let error = Recording::read(endless).unwrap_err();
    assert!(matches!(error, RecordingError::Line { line: 1, fault: LineError::TooLong }), "{error}");
}
