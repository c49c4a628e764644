//! Hands that hold controllers.

use crate::monado::Compositor;
use crate::remote::{Controller, Remote};
use crate::support::{Place, Started, distance, pose, recorded, stand_of, wheatstone};
use glam::{DQuat, DVec3};
use serde_json::Value;
use wheatstone_core::head::Pose;
use wheatstone_core::headset::{Hand, Interaction, Scale, Side, Stand, Tick};
use wheatstone_core::phantom::Phantom;
use wheatstone_core::scene::Clip;
use wheatstone_core::transfer::Preset;
use wheatstone_core::view::AnatomicalDirection::Superior;
use wheatstone_core::volume::{Grid, Window};

/// Where the right hand is when it takes the volume, and where it carries it.
const CARRY: [([f64; 3], [f64; 3]); 2] =
    [([0.2, 1.3, -0.45], [0.0; 3]), ([0.12, 1.35, -0.41], [0.5, 0.0, 0.0])];
/// Where both hands are when they take the volume, and how far they pull it.
const SPREAD: [[[f64; 3]; 2]; 2] =
    [[[-0.15, 1.4, -0.5], [0.15, 1.4, -0.5]], [[-0.2, 1.35, -0.5], [0.25, 1.5, -0.5]]];
/// Which face is dragged: that at the end of the first axis; how far, as a part of the volume's side; and from how far away, metres.
const FACE: usize = 3;
const CROP: f64 = 0.25;
const REACH_M: f64 = 0.2;

/// How far poses that have been single precision on their way may be off.
const SINGLE: f64 = 1e-5;

/// Two hands that do what they are told when the session has noticed what they did before.
struct Hands {
    remote: Remote,
    vr: Started,
    at: [Controller; 2],
}

impl Hands {
    /// Does something, and waits until the session has been told of it.
    fn act(&mut self, what: &str, change: impl FnOnce(&mut [Controller; 2])) {
        change(&mut self.at);
        let at = self.at;
        self.remote.controller(Side::Left, &at[0]).controller(Side::Right, &at[1]).send();
        self.vr.until(what, |tick| tick.hands.iter().zip(&at).all(|(hand, at)| does(hand, at)));
    }
}

fn does(hand: &Hand, controller: &Controller) -> bool {
    let is_there = |pose: Option<Pose>| {
        pose.is_some_and(|pose| {
            pose.distance_to_m(&controller.pose) < SINGLE && pose.angle_to_rad(&controller.pose) < 1e-3
        })
    };
    is_there(hand.grip)
        && is_there(hand.aim)
        && [hand.squeeze, hand.trigger] == [controller.squeeze, controller.trigger]
        && hand.stick == controller.stick
}

/// Where the volume is after it is carried, and after it is pulled, from where it stood.
fn carried_and_pulled(begin: &Stand) -> [Stand; 2] {
    let [from, to] = CARRY.map(|(position_m, turns_rad)| pose(position_m, turns_rad));
    let turn = to.orientation * from.orientation.inverse();
    let position_m = to.position_m + turn * (begin.pose.position_m - from.position_m);
    let carried = Stand { pose: Pose { position_m, orientation: turn * begin.pose.orientation }, ..*begin };
    let [from, to] = SPREAD.map(|hands| hands.map(DVec3::from));
    let [line_from, line_to] = [from, to].map(|[left, right]| right - left);
    let turn = DQuat::from_rotation_arc(line_from.normalize_or_zero(), line_to.normalize_or_zero());
    let growth = line_to.length() / line_from.length();
    let from_middle_m = carried.pose.position_m - from[0].midpoint(from[1]);
    let pulled = Stand {
        pose: Pose {
            position_m: to[0].midpoint(to[1]) + growth * (turn * from_middle_m),
            orientation: turn * carried.pose.orientation,
        },
        longest_side_m: growth * carried.longest_side_m,
    };
    [carried, pulled]
}

/// Aimed at the face from before it, and as much nearer as it is to be dragged.
fn aims(grid: &Grid, stand: &Stand) -> [Pose; 2] {
    let room_from_texture = stand.placement(grid, Superior).world_from_texture();
    let side_m = room_from_texture.matrix3.x_axis;
    let orientation = DQuat::from_rotation_arc(DVec3::Z, side_m.normalize_or_zero());
    let before_m =
        room_from_texture.transform_point3(DVec3::new(1.0, 0.5, 0.5)) + REACH_M * side_m.normalize_or_zero();
    [before_m, before_m - CROP * side_m].map(|position_m| Pose { position_m, orientation })
}

/// The transfer function that is shown by a preset, or at first.
fn transfer_of(place: &Place, preset: Option<&str>) -> Value {
    let vr = ["vr", "sphere.nrrd", "--headset", "none", "--patient", "--refreshes", "1", "--json"];
    let flags = preset.map_or_else(Vec::new, |name| vec!["--tf", name]);
    wheatstone(place.folder(), &[&vr[..], &flags].concat()).json()["view"]["transfer"].clone()
}

fn window_of(transfer: &Value) -> Window {
    let [lo, hi]: [f64; 2] = serde_json::from_value(transfer["window"].clone()).unwrap();
    Window::new(lo, hi).unwrap()
}

/// What hands lead to that did what was recorded.
struct Led {
    interaction: Interaction,
    preset_steps: i32,
    window: Window,
}

/// Leads hands along ticks. All presets but the last one are gone by at once.
fn led(ticks: &[Tick], grid: &Grid, first: Window, by_preset: impl Fn(i32) -> Window) -> Led {
    let begin = ticks.iter().position(|tick| tick.eyes.is_some()).unwrap();
    let stand = Stand::before(&ticks[begin].between_eyes().unwrap(), grid, Superior, Scale::Human);
    let interaction = Interaction::new(grid, Superior, stand, &Clip::default());
    let mut led = Led { interaction, preset_steps: 0, window: first };
    for tick in &ticks[begin..] {
        let changes = led.interaction.update(tick, led.window);
        led.window = changes.window;
        if changes.preset_steps != 0 {
            led.preset_steps += changes.preset_steps;
            led.window = by_preset(led.preset_steps);
        }
    }
    led
}

/// Bounds of the visible box in a report, then those of a clip.
fn boxes(report: &Value, clip: &Clip) -> [[f64; 6]; 2] {
    let clip_of = &report["view"]["clip"];
    assert!(clip_of["plane"].is_null());
    let numbers = |field: &str| -> [f64; 3] { serde_json::from_value(clip_of[field].clone()).unwrap() };
    let six = |[a, b, c]: [f64; 3], [d, e, f]: [f64; 3]| [a, b, c, d, e, f];
    [six(numbers("box_lo"), numbers("box_hi")), six(clip.box_lo.to_array(), clip.box_hi.to_array())]
}

fn largest_difference([a, b]: [[f64; 6]; 2]) -> f64 {
    a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn hands_carry_scale_crop_and_choose_as_computed() {
    let Some(place) = Place::start(Compositor::Null) else { return };
    let sphere = Phantom::Sphere.cube(24).unwrap();
    let grid = sphere.grid();
    let mut remote = place.contact().remote();
    remote.head(&pose([0.0, 1.6, 0.0], [0.0; 3])).send();
    let [from, to] = CARRY.map(|(position_m, turns_rad)| pose(position_m, turns_rad));
    let at = [Controller::at(pose(SPREAD[0][0], [0.0; 3])), Controller::at(from)];
    let mut hands = Hands { remote, vr: place.begin_vr("hands", &["sphere.nrrd"]), at };
    hands.act("the hands", |_| ());

    hands.act("the right hand's grip", |[_, right]| right.squeeze = 1.0);
    hands.act("a carrying hand", |[_, right]| right.pose = to);
    hands.act("the right hand's letting go", |[_, right]| right.squeeze = 0.0);
    let eyes = hands.vr.ticks().iter().find_map(Tick::between_eyes).unwrap();
    let [carried, pulled] = carried_and_pulled(&Stand::before(&eyes, grid, Superior, Scale::Human));

    let [near, far] = SPREAD.map(|hands| hands.map(|position_m| pose(position_m, [0.0; 3])));
    let put = |poses: [Pose; 2]| {
        move |hands: &mut [Controller; 2]| {
            hands.iter_mut().zip(poses).for_each(|(hand, pose)| hand.pose = pose);
        }
    };
    let squeeze = |how_far: f32| {
        move |hands: &mut [Controller; 2]| hands.iter_mut().for_each(|hand| hand.squeeze = how_far)
    };
    hands.act("both hands", put(near));
    hands.act("both hands' grip", squeeze(1.0));
    hands.act("both hands pulling", put(far));
    hands.act("both hands' letting go", squeeze(0.0));

    let [before, after] = aims(grid, &pulled);
    hands.act("a pointing hand", |[_, right]| right.pose = before);
    hands.act("the trigger", |[_, right]| right.trigger = 1.0);
    hands.act("a dragging hand", |[_, right]| right.pose = after);
    hands.act("the trigger's release", |[_, right]| right.trigger = 0.0);

    hands.act("the stick to the right", |[left, _]| left.stick = [1.0, 0.0]);
    hands.act("the stick", |[left, _]| left.stick = [0.0; 2]);
    hands.act("the stick up", |[left, _]| left.stick = [0.0, 1.0]);
    hands.act("the stick again", |[left, _]| left.stick = [0.0; 2]);
    let report = hands.vr.interrupt().json();

    // As computed from the same ticks.
    let recording = recorded(&place.folder().join("hands/session.jsonl"));
    let names: Vec<_> = Preset::all().map(Preset::name).collect();
    let preset = |steps: i32| names[(steps - 1).rem_euclid(names.len() as i32) as usize];
    let first = window_of(&transfer_of(&place, None));
    let steps = led(recording.ticks(), grid, first, |_| first).preset_steps;
    assert!(steps > 0);
    let transfer = transfer_of(&place, Some(preset(steps)));
    let led = led(recording.ticks(), grid, first, |_| window_of(&transfer));
    let stand = stand_of(&report);
    assert!(distance(&stand, led.interaction.stand()) < 1e-6, "{stand:?} {:?}", led.interaction.stand());
    assert!(largest_difference(boxes(&report, &led.interaction.upright_clip())) < 1e-6, "{report}");
    for (field, value) in transfer.as_object().unwrap() {
        if field != "window" {
            assert_eq!(report["view"]["transfer"][field], *value, "{field} of {}", preset(steps));
        }
    }
    let window = window_of(&report["view"]["transfer"]);
    let [off_lo, off_hi] =
        [window.lo() - led.window.lo(), window.hi() - led.window.hi()].map(|off| off / led.window.hi());
    assert!(off_lo.abs() < 1e-6 && off_hi.abs() < 1e-6, "{window:?} {:?}", led.window);
    assert!(window.lo() > window_of(&transfer).lo(), "the window has not been shifted: {window:?}");

    // And as known in closed form.
    assert!(distance(&carried, &pulled) > 0.1);
    assert!(distance(&stand, &pulled) < SINGLE, "{stand:?} {pulled:?}");
    let mut clip = Clip::default();
    clip.move_face(FACE, 1.0 - CROP);
    assert!(largest_difference(boxes(&report, &clip)) < SINGLE, "{report}");
}
