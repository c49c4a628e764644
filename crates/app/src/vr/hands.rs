//! What hands do, as the viewer's edits and commands.

use crate::viewer::command::Command;
use crate::viewer::session::Session;
use crate::viewer::state::{Clip, Edit, Plane, State};
use glam::DVec3;
use wheatstone_core::headset::{Changes, Hand, Handle, Interaction, Stand, Tick};
use wheatstone_core::scene::Placement;
use wheatstone_core::transfer::Preset;
use wheatstone_core::volume::Window;

use super::stage::ColoredLine;

/// How many times as narrow and as wide as all values hands make a window.
const MOST_NARROWED: f64 = 1000.0;
const MOST_WIDENED: f64 = 10.0;

/// Length of the ray of a hand that points at nothing, metres.
const RAY_M: f64 = 0.4;

/// Of rays, and of what they would take.
const RAY_RGB: [f32; 3] = [0.85, 0.85, 0.9];
const PICKED_RGB: [f32; 3] = [1.0, 0.75, 0.25];
const BOX_RGB: [f32; 3] = [0.5, 0.55, 0.6];

/// Two hands at the volume that is shown.
pub(crate) struct Hands {
    pub(crate) interaction: Interaction,
    /// What has been shown by the state's clip so far.
    shown: Clip,
}

impl Hands {
    /// At a volume that stands somewhere.
    pub(crate) fn new(interaction: Interaction, state: &State) -> Self {
        let mut hands = Self { interaction, shown: state.clip };
        hands.interaction.show_upright(&state.clip.scene());
        hands
    }

    /// What the hands do next, as what is to be done to the state, and which of them have taken hold of something.
    pub(crate) fn update(&mut self, tick: &Tick, session: &Session) -> (Vec<Command>, [bool; 2]) {
        let state = session.state();
        if state.clip != self.shown {
            self.interaction.show_upright(&state.clip.scene());
        }
        let Ok(window) = state.transfer.window() else { return (Vec::new(), [false; 2]) };
        let changes = self.interaction.update(tick, window);
        let mut commands = Vec::new();
        let is_useful = session.facts().is_none_or(|facts| is_useful(changes.window, facts.full_window));
        if changes.window != window && is_useful {
            commands.push(Edit::Window([changes.window.lo(), changes.window.hi()]).into());
        }
        let clip = self.clip(state);
        if clip != state.clip {
            commands.push(Edit::Clip(clip).into());
        }
        self.shown = clip;
        commands.extend(next_preset(session.preset(), &changes));
        (commands, changes.grabbed)
    }

    /// Where the volume stands in the room.
    pub(crate) fn stand(&self) -> &Stand {
        self.interaction.stand()
    }

    /// The state's clip as the hands have it.
    fn clip(&self, state: &State) -> Clip {
        let upright = self.interaction.upright_clip();
        let plane = upright.plane.map(|plane| Plane { normal: plane.normal, offset_m: plane.offset_m });
        Clip { box_lo: upright.box_lo, box_hi: upright.box_hi, plane, ..state.clip }
    }

    /// Rays of the hands, and the outline of what they can drag.
    pub(crate) fn lines(&self, tick: &Tick) -> Vec<ColoredLine> {
        let hovered = self.interaction.hovered();
        let mut lines = Vec::new();
        for (hand, picked) in tick.hands.iter().zip(hovered) {
            let Hand { aim: Some(aim), .. } = hand else { continue };
            let end =
                picked.map_or(aim.position_m + aim.orientation * (RAY_M * DVec3::NEG_Z), |at| at.point_m);
            lines.push(ColoredLine::new([aim.position_m, end], [0.8, 0.3], RAY_RGB));
        }
        if hovered.iter().any(Option::is_some) {
            let faces: Vec<_> = hovered.iter().flatten().map(|picked| picked.handle).collect();
            lines.extend(box_lines(&self.interaction.placement(), &self.interaction.upright_clip(), &faces));
        }
        lines
    }
}

/// The preset that the sticks go to from the one of a name.
fn next_preset(from: Option<&str>, changes: &Changes) -> Option<Command> {
    let names: Vec<_> = Preset::all().map(Preset::name).collect();
    let count = names.len() as i64;
    let steps = i64::from(changes.preset_steps);
    if steps == 0 || count == 0 {
        return None;
    }
    // From no preset, forwards leads to the first and back to the last.
    let from = names.iter().position(|name| Some(*name) == from);
    let from = from.map_or(if steps > 0 { -1 } else { 0 }, |preset| preset as i64);
    Some(Command::Preset(names[(from + steps).rem_euclid(count) as usize].to_owned()))
}

/// Whether a window shows anything of a volume whose values fill another.
fn is_useful(window: Window, full: Window) -> bool {
    let [width, all] = [window, full].map(|window| window.hi() - window.lo());
    (all / MOST_NARROWED..=all * MOST_WIDENED).contains(&width)
        && window.lo() <= full.hi()
        && window.hi() >= full.lo()
}

/// Edges of the visible box; those of faces that are picked stand out.
fn box_lines(
    placement: &Placement,
    clip: &wheatstone_core::scene::Clip,
    picked: &[Handle],
) -> impl Iterator<Item = ColoredLine> {
    let room_from_texture = placement.world_from_texture();
    let bounds = [clip.box_lo, clip.box_hi];
    let corner = move |ends: [usize; 3]| {
        let at = DVec3::new(bounds[ends[0]].x, bounds[ends[1]].y, bounds[ends[2]].z);
        room_from_texture.transform_point3(at)
    };
    let picked = picked.to_vec();
    (0..3_usize).flat_map(move |along| {
        let picked = picked.clone();
        (0..4_usize).map(move |bits| {
            let mut ends = [0; 3];
            let others = [(along + 1) % 3, (along + 2) % 3];
            (ends[others[0]], ends[others[1]]) = (bits & 1, bits >> 1);
            let mut far = ends;
            far[along] = 1;
            let is_picked = others.iter().any(|&axis| picked.contains(&Handle::Face(axis + 3 * ends[axis])));
            let (rgb, alpha) = if is_picked { (PICKED_RGB, 0.9) } else { (BOX_RGB, 0.5) };
            ColoredLine::new([corner(ends), corner(far)], [alpha; 2], rgb)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_go_on_from_the_preset_that_is_shown() {
        let names: Vec<_> = Preset::all().map(Preset::name).collect();
        let window = Window::new(0.0, 1.0).unwrap();
        let steps = |from, preset_steps| {
            let changes =
                Changes { has_moved: false, has_clipped: false, grabbed: [false; 2], preset_steps, window };
            next_preset(from, &changes)
        };
        let preset = |index: usize| Some(Command::Preset(names[index].to_owned()));
        assert_eq!(steps(Some(names[2]), 0), None);
        assert_eq!(steps(Some(names[2]), 1), preset(3));
        assert_eq!(steps(Some(names[0]), -1), preset(names.len() - 1));
        assert_eq!([steps(None, 1), steps(None, -1)], [preset(0), preset(names.len() - 1)]);
        assert_eq!(steps(Some("a file"), 2), preset(1));
    }

    #[test]
    fn a_window_that_would_show_nothing_is_not_taken() {
        let full = Window::new(-1000.0, 3000.0).unwrap();
        let is = |lo, hi| is_useful(Window::new(lo, hi).unwrap(), full);
        assert!(is(-1000.0, 3000.0) && is(0.0, 10.0) && is(-20_000.0, 19_000.0) && is(2999.0, 5000.0));
        assert!(!is(0.0, 3.0) && !is(-30_000.0, 30_000.0) && !is(3001.0, 5000.0) && !is(-3000.0, -1001.0));
    }
}
