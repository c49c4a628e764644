//! The states of a session, and what they ask of the program.

use openxr::SessionState;

/// Why a session has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EndReason {
    /// The person, the runtime or [`Session::request_exit`](crate::Session::request_exit) closed it.
    Exited,
    /// The runtime takes the session away, as when the headset is unplugged; another one may be begun later.
    Lost,
}

/// What has to be called when a session's state changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Duty {
    /// Nothing.
    Nothing,
    /// `xrBeginSession`.
    Begin,
    /// `xrEndSession`.
    End,
}

/// What is known of a session from the changes of its state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct States {
    now: SessionState,
    running: bool,
    ended: Option<EndReason>,
}

impl States {
    /// Before the first change.
    pub(crate) fn new() -> Self {
        Self { now: SessionState::IDLE, running: false, ended: None }
    }

    /// Takes note of a change.
    pub(crate) fn change(&mut self, to: SessionState) -> Duty {
        self.now = to;
        match to {
            SessionState::READY if !self.running => {
                self.running = true;
                Duty::Begin
            }
            SessionState::STOPPING if self.running => {
                self.running = false;
                Duty::End
            }
            SessionState::EXITING => {
                self.end(EndReason::Exited);
                Duty::Nothing
            }
            SessionState::LOSS_PENDING => {
                self.end(EndReason::Lost);
                Duty::Nothing
            }
            _ => Duty::Nothing,
        }
    }

    fn end(&mut self, reason: EndReason) {
        self.running = false;
        self.ended.get_or_insert(reason);
    }

    /// Takes note that the runtime is about to end.
    pub(crate) fn lose(&mut self) {
        self.end(EndReason::Lost);
    }

    /// Whether frames are to be made.
    pub(crate) fn running(self) -> bool {
        self.running
    }

    /// Why no more frames will ever be made.
    pub(crate) fn ended(self) -> Option<EndReason> {
        self.ended
    }

    /// Whether hands act on this program.
    pub(crate) fn focused(self) -> bool {
        self.running && self.now == SessionState::FOCUSED
    }

    /// Whether the pictures can be seen.
    pub(crate) fn visible(self) -> bool {
        self.running && matches!(self.now, SessionState::VISIBLE | SessionState::FOCUSED)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(changes: &[SessionState]) -> (States, Vec<Duty>) {
        let mut states = States::new();
        let duties = changes.iter().map(|&to| states.change(to)).collect();
        (states, duties)
    }

    #[test]
    fn a_session_begins_when_ready_and_ends_when_stopping_once_each() {
        use SessionState as S;
        let (states, duties) = after(&[S::IDLE, S::READY, S::SYNCHRONIZED, S::VISIBLE, S::FOCUSED]);
        assert_eq!(duties, [Duty::Nothing, Duty::Begin, Duty::Nothing, Duty::Nothing, Duty::Nothing]);
        assert!(states.running() && states.focused() && states.visible());

        let (states, duties) = after(&[S::READY, S::FOCUSED, S::STOPPING, S::IDLE]);
        assert_eq!(duties[2..], [Duty::End, Duty::Nothing]);
        assert!(!states.running() && !states.focused() && states.ended().is_none());

        let (states, duties) = after(&[S::READY, S::STOPPING, S::IDLE, S::READY]);
        assert_eq!(duties[3], Duty::Begin, "a headset put on again");
        assert!(states.running());
    }

    #[test]
    fn the_first_reason_of_an_end_stays() {
        let (mut states, _) = after(&[SessionState::READY, SessionState::LOSS_PENDING]);
        assert_eq!(states.ended(), Some(EndReason::Lost));
        assert!(!states.running());
        states.change(SessionState::EXITING);
        assert_eq!(states.ended(), Some(EndReason::Lost));
        let (states, _) = after(&[SessionState::READY, SessionState::STOPPING, SessionState::EXITING]);
        assert_eq!(states.ended(), Some(EndReason::Exited));
    }

    #[test]
    fn a_second_program_in_front_takes_the_focus_only() {
        let (states, _) = after(&[SessionState::READY, SessionState::FOCUSED, SessionState::VISIBLE]);
        assert!(states.running() && states.visible() && !states.focused());
        let (states, _) = after(&[SessionState::READY, SessionState::FOCUSED, SessionState::SYNCHRONIZED]);
        assert!(states.running() && !states.visible());
    }
}
