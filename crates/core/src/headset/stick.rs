//! What thumb-sticks ask for.

use super::Hand;
use super::button::Button;

/// How long a stick is held to the side from one preset to the next, seconds.
const REPEAT_S: f64 = 0.5;

/// How far a stick may be off its middle without meaning it.
const DEAD: f64 = 0.2;

/// How fast a stick that is held up shifts the window: widths of the window per second.
const SHIFT_PER_S: f64 = 0.5;

/// How fast it widens the window with the trigger pulled: doublings per second.
const DOUBLINGS_PER_S: f64 = 1.0;

/// Longest time that counts as held, seconds: ticks that are further apart have been interrupted.
const LONGEST_GAP_S: f64 = 0.1;

/// What the sticks of a tick ask for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wish {
    /// Presets to go on by; back if negative.
    pub(super) steps: i32,
    /// Widths to shift the window by.
    pub(super) shift: f64,
    /// How many times as wide the window becomes.
    pub(super) stretch: f64,
}

/// Both sticks. To the right is the next preset, to the left the one before: one step per flick, and one every half second
/// that the stick is held. Up shifts the window to higher values (its level), up with the trigger pulled widens it. A stick
/// means the direction in which it is further off its middle.
#[derive(Debug, Clone, Default)]
pub(super) struct Sticks {
    flicks: [Flick; 2],
    last_s: Option<f64>,
}

/// A stick that is held to a side.
#[derive(Debug, Clone, Default)]
struct Flick {
    left: Button,
    right: Button,
    /// When the next step is due, seconds.
    due_s: f64,
}

impl Sticks {
    /// What the sticks ask for at a time in seconds, while some triggers are pulled.
    pub(super) fn update(&mut self, time_s: f64, hands: &[Hand; 2], is_pulled: [bool; 2]) -> Wish {
        let gap_s = self.last_s.map_or(0.0, |last_s| time_s - last_s);
        let held_s = if gap_s > 0.0 { gap_s.min(LONGEST_GAP_S) } else { 0.0 };
        self.last_s = Some(time_s);
        let mut wish = Wish { steps: 0, shift: 0.0, stretch: 1.0 };
        for side in 0..2 {
            let [right, up] = hands[side].stick;
            let is_across = right.abs() > up.abs();
            wish.steps += self.flicks[side].steps(time_s, if is_across { right } else { 0.0 });
            let rate = if is_across { 0.0 } else { beyond_dead(f64::from(up)) };
            if is_pulled[side] {
                wish.stretch *= (DOUBLINGS_PER_S * rate * held_s).exp2();
            } else {
                wish.shift += SHIFT_PER_S * rate * held_s;
            }
        }
        wish
    }
}

impl Flick {
    fn steps(&mut self, time_s: f64, right: f32) -> i32 {
        let has_begun = [self.left.press(-right), self.right.press(right)].contains(&true);
        let side = i32::from(self.right.is_down()) - i32::from(self.left.is_down());
        if side == 0 || !(has_begun || time_s >= self.due_s) {
            return 0;
        }
        self.due_s = time_s + REPEAT_S;
        side
    }
}

/// −1 to 1, and 0 about the middle, without a leap in between.
fn beyond_dead(deflection: f64) -> f64 {
    let beyond = ((deflection.abs() - DEAD) / (1.0 - DEAD)).clamp(0.0, 1.0);
    if beyond > 0.0 { beyond.copysign(deflection) } else { 0.0 }
}
