//! Random events: a soak test.

use super::chord::Chord;
use super::drag::{Button, Drag};
use super::step::{Goal, Step};
use crate::look::ModeName;
use crate::viewer::command::Command;
use crate::viewer::state::{Arrangement, Edit, EyeMethod, Face, Plane, State, WarpName};
use egui::Key;
use fastrand::Rng;
use glam::DVec3;
use std::time::{Duration, Instant};
use wheatstone_core::scene::Shading;

/// Keys that are pressed.
const KEYS: [Key; 10] =
    [Key::H, Key::H, Key::Questionmark, Key::M, Key::L, Key::C, Key::P, Key::X, Key::V, Key::Home];

/// Keys that are held.
const HELD: [Key; 6] = [Key::W, Key::S, Key::A, Key::E, Key::ArrowRight, Key::ArrowUp];

/// Steps from a seed for some time once the first volume is there, then the end.
pub(crate) fn random_steps(seed: u64, duration: Duration) -> impl Iterator<Item = Step> + 'static {
    let mut rng = Rng::with_seed(seed);
    let end = Instant::now() + duration;
    let mut has_ended = false;
    let events = std::iter::from_fn(move || {
        if has_ended {
            return None;
        }
        has_ended = Instant::now() >= end;
        Some(if has_ended { Step::Do(Command::Quit) } else { step(&mut rng) })
    });
    std::iter::once(Step::WaitFor(Goal::Volume)).chain(events)
}

fn step(rng: &mut Rng) -> Step {
    match rng.u32(0..20) {
        0..5 => Step::WaitMs(rng.u64(0..400)),
        5..10 => Step::Drag(drag(rng)),
        10 => Step::Press(Chord::plain(KEYS[rng.usize(0..KEYS.len())])),
        11 => {
            let key = Chord::plain(HELD[rng.usize(0..HELD.len())]);
            Step::Hold { key, ms: rng.u64(0..600) }
        }
        12 => Step::Scroll { at: place(rng), points: (rng.f32() - 0.5) * 200.0 },
        13 => Step::Resize([rng.u32(200..1200), rng.u32(150..900)]),
        _ => match command(rng) {
            Command::Edit(edit @ (Edit::MoveOpacityPoint { .. } | Edit::RemoveOpacityPoint(_))) => {
                Step::DoToSome(edit)
            }
            command => Step::Do(command),
        },
    }
}

fn place(rng: &mut Rng) -> [f32; 2] {
    [rng.f32() * 1280.0, rng.f32() * 800.0]
}

fn drag(rng: &mut Rng) -> Drag {
    Drag {
        from: place(rng),
        to: place(rng),
        ms: rng.u64(0..600),
        button: [Button::Left, Button::Left, Button::Right, Button::Middle][rng.usize(0..4)],
        shift: rng.u32(0..6) == 0,
        ctrl: rng.u32(0..6) == 0,
    }
}

fn command(rng: &mut Rng) -> Command {
    let signed = |rng: &mut Rng| 2.0 * rng.f64() - 1.0;
    let edit = match rng.u32(0..24) {
        0 => Edit::Orbit { right_deg: 90.0 * signed(rng), up_deg: 40.0 * signed(rng) },
        1 => Edit::Zoom((0.5 * signed(rng)).exp()),
        2 => Edit::Fly { right_m: 0.1 * signed(rng), up_m: 0.1 * signed(rng), forward_m: 0.2 * signed(rng) },
        3 => Edit::Face(Face::ALL[rng.usize(0..6)]),
        4 => Edit::ResetCamera,
        5 => Edit::Mode(ModeName::ALL[rng.usize(0..6)]),
        6 => Edit::Mode(ModeName::Dvr),
        7 => {
            let all = [Shading::None, Shading::Phong, Shading::Shadow, Shading::Ambient];
            Edit::Shading(all[rng.usize(0..4)])
        }
        8 => Edit::Isovalue(rng.f64()),
        9 => Edit::SamplingFactor(0.5 + 1.5 * rng.f64()),
        10 => Edit::Preintegrated(rng.bool()),
        11 => Edit::WindowLevel { shift: 0.2 * signed(rng), stretch: (0.3 * signed(rng)).exp() },
        12 => Edit::MoveOpacityPoint { index: rng.usize(0..8), to: [rng.f32(), rng.f32().powi(3)] },
        13 => Edit::AddOpacityPoint([rng.f32(), rng.f32().powi(3)]),
        14 => Edit::RemoveOpacityPoint(rng.usize(0..8)),
        15 => Edit::MoveFace { face: rng.usize(0..6), to: rng.f64() },
        16 => Edit::ResetClip,
        17 => Edit::ClipPlane(rng.bool().then(|| {
            let normal = DVec3::new(signed(rng), signed(rng), signed(rng)).try_normalize();
            Plane { normal: normal.unwrap_or(DVec3::X), offset_m: 0.3 * signed(rng) }
        })),
        18 => Edit::Arrangement(Arrangement::ALL[rng.usize(0..5)]),
        19 => Edit::EyeMethod(EyeMethod::ALL[rng.usize(0..2)]),
        20 => Edit::Warp(WarpName::ALL[rng.usize(0..WarpName::ALL.len())]),
        21 => return Command::Preset(["auto", "mri-brain-t1", "viridis"][rng.usize(0..3)].to_owned()),
        22 => return Command::Reload,
        _ => return Command::OpenShipped,
    };
    edit.into()
}

/// An edit of a point of the transfer function, of one that there is: the numbers of points are counted through again and again. The last
/// one is kept.
pub(crate) fn of_what_exists(edit: &Edit, state: &State) -> Edit {
    let points = state.transfer.opacity.len();
    match *edit {
        Edit::MoveOpacityPoint { index, to } => Edit::MoveOpacityPoint { index: index % points, to },
        Edit::RemoveOpacityPoint(index) if points > 1 => Edit::RemoveOpacityPoint(index % points),
        Edit::RemoveOpacityPoint(_) => Edit::AddOpacityPoint([0.5, 0.5]),
        ref other => other.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_edits_leave_a_state_that_is_saved_and_loaded() {
        let mut rng = Rng::with_seed(7);
        let mut state = State::default();
        for _ in 0..3000 {
            if let Command::Edit(edit) = command(&mut rng) {
                state.apply(&of_what_exists(&edit, &state)).unwrap();
            }
        }
        assert_eq!(State::from_json(&state.to_json().unwrap()).unwrap(), state);
    }

    #[test]
    fn a_soak_ends() {
        let steps: Vec<Step> = random_steps(1, Duration::ZERO).collect();
        assert_eq!(steps, [Step::WaitFor(Goal::Volume), Step::Do(Command::Quit)]);
    }
}
