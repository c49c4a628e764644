//! Plays the steps of a script when they are due.

use super::step::{Goal, Step};
use crate::viewer::command::Command;
use crate::viewer::state::Edit;
use egui::{Event, Modifiers, MouseWheelSource, MouseWheelUnit, TouchPhase, Vec2};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Longest time that a script waits for something.
const PATIENCE: Duration = Duration::from_secs(120);

/// What a script can wait for.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Status {
    pub(crate) is_loading: bool,
    pub(crate) is_at_rest: bool,
}

/// Something that happens to the viewer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Happening {
    Command(Command),
    /// An edit of some point of the transfer function, whichever it has.
    EditOfSome(Edit),
    Event(Event),
    Drop(PathBuf),
    Resize([u32; 2]),
}

/// Something that happens, and since when it has been due.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Due {
    pub(crate) at: Instant,
    pub(crate) happening: Happening,
}

/// A script that is being played.
pub(crate) struct Player {
    steps: Box<dyn Iterator<Item = Step>>,
    next: Option<Step>,
    /// When the next step is due.
    at: Instant,
    /// What is left of the step that has begun, and what of it is due next.
    events: Box<dyn Iterator<Item = Due>>,
    next_event: Option<Due>,
    /// What is shown has to be looked at anew before anything is waited for.
    has_acted: bool,
}

impl Player {
    pub(crate) fn new(steps: impl Iterator<Item = Step> + 'static) -> Self {
        let mut steps: Box<dyn Iterator<Item = Step>> = Box::new(steps);
        let next = steps.next();
        Self {
            steps,
            next,
            at: Instant::now(),
            events: Box::new(std::iter::empty()),
            next_event: None,
            has_acted: false,
        }
    }

    /// Ends the program when everything is played and at rest.
    pub(crate) fn then_quit(self) -> Self {
        let end = [Step::WaitFor(Goal::Rest), Step::Do(Command::Quit)];
        Self::new(self.next.into_iter().chain(self.steps).chain(end))
    }

    /// What has become due.
    ///
    /// # Errors
    /// What has been waited for in vain, in words.
    pub(crate) fn due(&mut self, now: Instant, status: Status) -> Result<Vec<Due>, String> {
        let mut due = Vec::new();
        self.has_acted = false;
        loop {
            while let Some(event) = self.next_event.take_if(|event| event.at <= now) {
                due.push(event);
                self.has_acted = true;
                self.advance();
            }
            if self.next_event.is_some() || self.at > now {
                return Ok(due);
            }
            let Some(step) = self.next.take() else { return Ok(due) };
            if let Step::WaitFor(goal) = step {
                if self.has_acted || !goal.is_reached(status) {
                    self.next = Some(step);
                    let waited = now.saturating_duration_since(self.at);
                    return if waited >= PATIENCE {
                        Err(format!("waited {} s in vain for {goal:?}", PATIENCE.as_secs()))
                    } else {
                        Ok(due)
                    };
                }
                self.at = now;
                self.next = self.steps.next();
                continue;
            }
            let has_input = due.iter().any(|due| due.happening.is_input());
            if has_input && !step.makes_input() {
                // The panels take events in after all else that is due.
                self.next = Some(step);
                return Ok(due);
            }
            let is_capture = matches!(step, Step::Do(Command::Screenshot(_) | Command::ScreenshotNew(_)));
            self.begin(step);
            self.next = self.steps.next();
            if is_capture {
                // What follows is not to be seen on it.
                due.extend(self.next_event.take());
                return Ok(due);
            }
        }
    }

    /// When something is due next, as far as that is known: what is waited for may come at any time.
    pub(crate) fn next_at(&self, status: Status) -> Option<Instant> {
        match (&self.next_event, &self.next) {
            (Some(event), _) => Some(event.at),
            (None, Some(Step::WaitFor(goal))) if !goal.is_reached(status) => Some(self.at + PATIENCE),
            (None, Some(_)) => Some(self.at),
            (None, None) => None,
        }
    }

    fn begin(&mut self, step: Step) {
        let happenings: Happenings = match step {
            Step::WaitMs(ms) => {
                self.at += Duration::from_millis(ms);
                at_once([])
            }
            Step::WaitFor(_) => at_once([]),
            Step::Do(command) => at_once([Happening::Command(command)]),
            Step::DoToSome(edit) => at_once([Happening::EditOfSome(edit)]),
            Step::Drag(drag) => {
                let held = (Duration::ZERO, Event::ModifiersChanged(drag.modifiers()));
                let released = (drag.duration(), Event::ModifiersChanged(Modifiers::NONE));
                let all = std::iter::once(held).chain(drag.events()).chain([released]);
                Box::new(all.map(|(after, event)| (after, Happening::Event(event))))
            }
            Step::Press(chord) => {
                let [held, down] = chord.down().map(Happening::Event);
                let [up, released] = chord.up().map(Happening::Event);
                at_once([held, down, up, released])
            }
            Step::Hold { key, ms } => {
                let after = |ms, events: [Event; 2]| {
                    events.map(|event| (Duration::from_millis(ms), Happening::Event(event))).into_iter()
                };
                Box::new(after(0, key.down()).chain(after(ms, key.up())))
            }
            Step::Scroll { at, points } => at_once([
                Happening::Event(Event::PointerMoved(at.into())),
                Happening::Event(Event::MouseWheel {
                    unit: MouseWheelUnit::Point,
                    delta: Vec2::new(0.0, points),
                    phase: TouchPhase::Move,
                    source: MouseWheelSource::Wheel,
                    modifiers: Modifiers::NONE,
                }),
            ]),
            Step::Drop(path) => at_once([Happening::Drop(path)]),
            Step::Resize(size) => at_once([Happening::Resize(size)]),
        };
        let begun = self.at;
        self.events =
            Box::new(happenings.map(move |(after, happening)| Due { at: begun + after, happening }));
        self.advance();
    }

    fn advance(&mut self) {
        self.next_event = self.events.next();
        if let Some(event) = &self.next_event {
            self.at = event.at;
        }
    }
}

impl Step {
    fn makes_input(&self) -> bool {
        matches!(
            self,
            Self::Drag(_)
                | Self::Press(_)
                | Self::Hold { .. }
                | Self::Scroll { .. }
                | Self::Drop(_)
                | Self::WaitMs(_)
        )
    }
}

impl Happening {
    /// Whether it comes in as from a window.
    fn is_input(&self) -> bool {
        matches!(self, Self::Event(_) | Self::Drop(_))
    }
}

impl Goal {
    fn is_reached(self, status: Status) -> bool {
        match self {
            Self::Volume => !status.is_loading,
            Self::Rest => !status.is_loading && status.is_at_rest,
        }
    }
}

/// What comes of a step, and when after its beginning.
type Happenings = Box<dyn Iterator<Item = (Duration, Happening)>>;

fn at_once<const N: usize>(happenings: [Happening; N]) -> Happenings {
    Box::new(happenings.into_iter().map(|happening| (Duration::ZERO, happening)))
}

#[cfg(test)]
mod tests {
    use super::super::chord::Chord;
    use super::super::drag::{Button, Drag};
    use super::*;

    const READY: Status = Status { is_loading: false, is_at_rest: true };

    #[test]
    fn steps_are_due_one_after_the_other() {
        let zoom = || Step::Do(Edit::Zoom(2.0).into());
        let mut player = Player::new([zoom(), Step::WaitMs(100), zoom()].into_iter());
        let begun = player.at;
        assert_eq!(player.due(begun, READY).unwrap().len(), 1);
        assert!(player.due(begun + Duration::from_millis(99), READY).unwrap().is_empty());
        assert_eq!(player.next_at(READY), Some(begun + Duration::from_millis(100)));
        let late = player.due(begun + Duration::from_millis(250), READY).unwrap();
        assert_eq!(late[0].at, begun + Duration::from_millis(100));
        assert_eq!(player.next_at(READY), None);
    }

    #[test]
    fn a_script_that_is_to_quit_ends_at_rest() {
        let mut player = Player::new([Step::Do(Command::Reload)].into_iter()).then_quit();
        let now = player.at;
        assert_eq!(player.due(now, READY).unwrap()[0].happening, Happening::Command(Command::Reload));
        assert!(player.due(now, Status { is_at_rest: false, ..READY }).unwrap().is_empty());
        assert_eq!(player.due(now, READY).unwrap()[0].happening, Happening::Command(Command::Quit));
    }

    #[test]
    fn what_follows_a_screenshot_is_not_on_it() {
        let shot = Command::Screenshot("a.png".into());
        let mut player = Player::new([Step::Do(shot), Step::Do(Command::Quit)].into_iter());
        let now = player.at;
        assert_eq!(player.due(now, READY).unwrap().len(), 1);
        assert_eq!(player.due(now, READY).unwrap()[0].happening, Happening::Command(Command::Quit));
    }

    #[test]
    fn a_goal_is_looked_at_after_what_was_done_is_shown() {
        let steps = [Step::Do(Command::Reload), Step::WaitFor(Goal::Volume), Step::Do(Command::Quit)];
        let mut player = Player::new(steps.into_iter());
        let now = player.at;
        assert_eq!(player.due(now, READY).unwrap().len(), 1);
        let loading = Status { is_loading: true, ..READY };
        assert!(player.due(now, loading).unwrap().is_empty());
        assert_eq!(player.next_at(loading), Some(now + PATIENCE));
        assert!(player.due(now + PATIENCE + Duration::from_secs(1), loading).is_err());
        assert_eq!(player.due(now, READY).unwrap().len(), 1);
    }

    #[test]
    fn a_key_is_held_for_as_long_as_is_said() {
        let key = Chord::try_from("Shift+Right".to_owned()).unwrap();
        let mut player = Player::new([Step::Hold { key, ms: 300 }].into_iter());
        let begun = player.at;
        let events = |due: Vec<Due>| due.into_iter().map(|due| due.happening).collect::<Vec<_>>();
        assert_eq!(events(player.due(begun, READY).unwrap()), key.down().map(Happening::Event));
        assert!(player.due(begun + Duration::from_millis(299), READY).unwrap().is_empty());
        let up = player.due(begun + Duration::from_millis(300), READY).unwrap();
        assert_eq!(events(up), key.up().map(Happening::Event));
    }

    #[test]
    fn a_drag_of_an_hour_is_made_move_by_move() {
        let (from, to) = ([0.0; 2], [100.0; 2]);
        let drag = Drag { from, to, ms: 3_600_000, button: Button::Left, shift: false, ctrl: false };
        let mut player = Player::new([Step::Drag(drag), Step::Do(Command::Quit)].into_iter());
        let begun = player.at;
        assert_eq!(player.due(begun, READY).unwrap().len(), 3, "keys, place, press");
        assert_eq!(player.due(begun + Duration::from_millis(16), READY).unwrap().len(), 2);
        assert_eq!(player.next_at(READY), Some(begun + Duration::from_millis(24)));
        let end = begun + Duration::from_secs(3600);
        let rest = player.due(end, READY).unwrap();
        assert_eq!(rest.len(), 450_000 - 2 + 2, "moves, release, keys");
        assert_eq!(player.due(end, READY).unwrap()[0].happening, Happening::Command(Command::Quit));
    }

    #[test]
    fn what_follows_a_file_that_is_dropped_is_done_after_it() {
        let mut player = Player::new([Step::Drop("a.nrrd".into()), Step::Do(Command::Quit)].into_iter());
        let now = player.at;
        let due = player.due(now, READY).unwrap();
        assert_eq!(
            due.into_iter().map(|due| due.happening).collect::<Vec<_>>(),
            [Happening::Drop("a.nrrd".into())]
        );
        assert_eq!(player.due(now, READY).unwrap()[0].happening, Happening::Command(Command::Quit));
    }

    #[test]
    fn what_follows_events_is_done_after_them() {
        let key = Chord::try_from("M".to_owned()).unwrap();
        let mut player = Player::new([Step::Press(key), Step::Do(Command::Quit)].into_iter());
        let now = player.at;
        let due = player.due(now, READY).unwrap();
        assert!(due.iter().all(|due| matches!(due.happening, Happening::Event(_))), "{due:?}");
        assert_eq!(player.next_at(READY), Some(now));
        assert_eq!(player.due(now, READY).unwrap()[0].happening, Happening::Command(Command::Quit));
    }
}
