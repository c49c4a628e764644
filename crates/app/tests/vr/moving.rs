//! A head that moves.

use crate::monado::Compositor;
use crate::remote::Remote;
use crate::support::{Place, Started, pose};
use serde_json::Value;
use std::f64::consts::TAU;
use std::time::{Duration, Instant};
use wheatstone_core::head::Pose;

/// Refreshes while the head moves.
const MOVING: usize = 200;

/// Refreshes in all: enough for a picture at rest to become as fine as it gets, beside a compositor that draws and one that does not.
const REFRESHES: usize = 300;
const REFRESHES_ON_DISPLAY: usize = 600;

/// From one pose that is sent to the next.
const SEND_EVERY: Duration = Duration::from_millis(5);

/// Sways by some centimetres and degrees, as somebody who looks at something does.
fn swaying(time_s: f64) -> Pose {
    let sway = |amplitude: f64, period_s: f64| amplitude * (TAU * time_s / period_s).sin();
    pose(
        [sway(0.04, 4.0), 1.6 + sway(0.015, 3.0), sway(0.02, 5.0)],
        [sway(0.1, 5.0), -0.15 + sway(0.03, 3.5), sway(0.02, 6.0)],
    )
}

/// Moves the head until the session has been told of some refreshes, then leaves it elsewhere.
fn sway(remote: &mut Remote, vr: &mut Started) {
    let begun = Instant::now();
    while vr.runs() && vr.told() < MOVING {
        for _ in 0..20 {
            remote.head(&swaying(begun.elapsed().as_secs_f64())).send();
            std::thread::sleep(SEND_EVERY);
        }
    }
    remote.head(&pose([0.08, 1.55, 0.05], [-0.1, -0.2, 0.0])).send();
}

/// A figure of the checks of some refreshes.
fn figures(report: &Value, figure: &str, wanted: impl Fn(&Value) -> bool) -> Vec<f64> {
    let checked = report["checked"].as_array().unwrap();
    checked.iter().filter(|check| wanted(check)).map(|check| check[figure].as_f64().unwrap()).collect()
}

/// Shows a head phantom to a head that sways, then rests.
fn check(compositor: Compositor, refreshes: usize) {
    let Some(place) = Place::start(compositor) else { return };
    let phantom = ["phantom", "shepp-logan", "--size", "48", "-o", "head.nrrd"];
    assert_eq!(place.run(&phantom).code, 0);
    let mut remote = place.contact().remote();
    remote.head(&swaying(0.0)).send();
    let end = refreshes.to_string();
    let flags = ["head.nrrd", "--refreshes", &end, "--check-every", "10", "--checks", "60"];
    let mut vr = place.begin_vr("moving", &flags);
    sway(&mut remote, &mut vr);
    let report = vr.wait().json();
    assert_eq!(report["refreshes"], refreshes);
    let moving = figures(&report, "dssim", |check| check["moves"] == true);
    assert!(moving.len() >= 10, "the head hardly moved: {}", report["checked"]);
    assert!(moving.iter().all(|dssim| *dssim <= 0.02), "{moving:?}");
    // Most of an image is background: where the volume is, a picture that is coarse for a while is far off, and none at all further.
    let covered = figures(&report, "dssim_covered", |check| check["moves"] == true);
    assert!(covered.iter().all(|dssim| *dssim <= 0.35), "{covered:?}");
    // Refreshes before the first picture are not counted.
    let at_rest = figures(&report, "dssim_covered", |check| check["moves"] == false);
    let last = at_rest.get(at_rest.len().saturating_sub(4)..).unwrap();
    assert!(last.len() == 4 && last.iter().all(|dssim| *dssim <= 0.003), "{at_rest:?}");
}

#[test]
fn what_is_shown_is_what_the_eyes_should_see() {
    check(Compositor::Null, REFRESHES);
}

#[test]
fn so_it_is_on_a_display() {
    check(Compositor::Screen, REFRESHES_ON_DISPLAY);
}
