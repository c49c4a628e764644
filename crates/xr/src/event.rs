//! What happens to a session beside its frames.

/// Something that a program may want to tell or act on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum SessionEvent {
    /// Hands act on this program from now on.
    FocusGained,
    /// Another program or the runtime's own menu has the hands now; what is held should be let go.
    FocusLost,
    /// The person moved the origin of the space that stands for the world.
    Recentred,
    /// The left or right hand holds another kind of controller: the interaction profiles' paths, none for a hand without.
    ControllersChanged([Option<String>; 2]),
    /// The display refreshes so many times per second from now on.
    RefreshRateChanged {
        /// Refreshes per second.
        hz: f32,
    },
    /// What the lenses hide of an eye's picture (0 left, 1 right) has changed: [`Session::hidden_area`](crate::Session::hidden_area).
    HiddenAreaChanged {
        /// Index of the eye.
        eye: usize,
    },
    /// The runtime is about to end.
    RuntimeEnding,
    /// The runtime had more to tell than it could keep.
    EventsLost {
        /// How many.
        count: u32,
    },
}
