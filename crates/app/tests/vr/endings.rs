//! How sessions end, and who has the hands.

use crate::monado::Compositor;
use crate::remote::Controller;
use crate::support::{Place, pose, recorded};
use wheatstone_core::headset::{Hand, Side, Tick};

fn has_eyes(tick: &Tick) -> bool {
    tick.eyes.is_some()
}

#[test]
fn a_second_program_takes_the_hands_and_the_session_goes_on() {
    let Some(place) = Place::start(Compositor::Null) else { return };
    let held = Controller { squeeze: 1.0, ..Controller::at(pose([0.1, 1.0, -0.5], [0.0; 3])) };
    let mut remote = place.contact().remote();
    remote.controller(Side::Left, &held).send();
    let holds = |tick: &Tick| has_eyes(tick) && tick.hands[0].squeeze == 1.0;
    let has_no_hands = |tick: &Tick| tick.hands == [Hand::default(); 2];

    let mut first = place.begin_vr("first", &["sphere.nrrd"]);
    first.until("the focus", holds);
    let mut second = place.begin_vr("second", &["sphere.nrrd"]);
    first.until("the loss of the focus", has_no_hands);
    second.until("the focus of the second program", holds);
    // What the hand would carry while it belongs to another program stays where it is.
    remote.controller(Side::Left, &Controller { pose: pose([0.4, 1.3, -0.2], [0.5; 3]), ..held }).send();
    second.until("a hand that moves", |tick| tick.hands[0].grip.is_some_and(|grip| grip.position_m.x > 0.39));
    remote.controller(Side::Left, &Controller { squeeze: 0.0, ..held }).send();
    second.until("a hand that lets go", |tick| tick.hands[0].grip.is_some() && tick.hands[0].squeeze == 0.0);
    assert!(second.interrupt().json()["refreshes"].as_u64().unwrap() > 0);
    first.until("the focus again", |tick| tick.hands[0].grip.is_some());
    let first = first.interrupt();
    for said in ["another program has the hands now", "the hands are here"] {
        assert!(first.stderr.contains(said), "{said}: {}", first.stderr);
    }
    let report = first.json();
    assert_eq!(report["ended"], "the session was closed");
    assert_eq!(report["failures"], serde_json::json!([]));
    let position_m = &report["stand"]["position_m"];
    assert!(position_m[0].as_f64().unwrap().abs() < 1e-6, "carried by nobody's hand: {position_m}");
    // Every refresh with and without hands is in the recording.
    let ticks = recorded(&place.folder().join("first/session.jsonl"));
    assert!(ticks.ticks().iter().any(holds) && ticks.ticks().iter().any(has_no_hands));
}

#[test]
fn a_runtime_that_is_killed_is_told_and_the_exit_code_says_so() {
    let Some(place) = Place::start(Compositor::Null) else { return };
    let mut vr = place.begin_vr("killed", &["sphere.nrrd"]);
    vr.until("the eyes", has_eyes);
    place.contact().kill();
    let run = vr.wait();
    assert_eq!(run.code, 1, "{run:?}");
    assert!(run.error().contains("runtime"), "{run:?}");
    let ticks = recorded(&place.folder().join("killed/session.jsonl"));
    assert!(ticks.ticks().iter().any(has_eyes), "what was recorded until then is kept");
}

#[test]
fn no_runtime_is_told_and_the_exit_code_says_so() {
    let Some(place) = Place::start(Compositor::None) else { return };
    let missing = place.run(&["vr", "missing.nrrd", "--no-mirror"]);
    assert_eq!(missing.code, 2, "{missing:?}");
    assert!(missing.error().contains("missing.nrrd"), "{missing:?}");
    let run = place.run(&["vr", "sphere.nrrd", "--no-mirror"]);
    assert_eq!(run.code, 1, "{run:?}");
    assert!(run.error().contains("start the headset's software"), "{run:?}");
}

#[test]
fn a_bad_volume_begins_no_session() {
    let Some(place) = Place::start(Compositor::Null) else { return };
    std::fs::write(place.folder().join("bad.nrrd"), "no volume").unwrap();
    for file in ["bad.nrrd", "missing.nrrd"] {
        let run = place.run(&["vr", file, "--no-mirror"]);
        assert_eq!(run.code, 2, "{run:?}");
        assert!(run.error().contains(file), "{run:?}");
    }
}
