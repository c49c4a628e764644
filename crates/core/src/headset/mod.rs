//! What a headset tells before each of its refreshes, whichever runtime it comes from: when the picture will be shown, where
//! the eyes will be, and what the hands do; and what follows from it. Nothing here knows a runtime; `wheatstone-xr` fills the
//! [`Tick`]s in from `OpenXR`.
//!
//! [`Interaction`] turns ticks into where the volume stands, what part of it is shown, and steps through presets and window;
//! [`value_under`] tells what a hand points at, [`Late`] counts refreshes that were missed, [`floor`] and [`horizon`] are lines
//! to stand by, and a [`Recording`] plays ticks back, as the [`Demonstration`] makes them.

mod button;
mod crop;
mod demonstration;
mod drag;
mod eye;
mod grasp;
mod hand;
mod hidden_area;
mod interaction;
mod late;
mod pinches;
mod pointer;
mod recording;
mod stand;
mod stick;
mod surroundings;
mod tick;

pub use crop::{Handle, Picked};
pub use demonstration::{Demonstration, Outcome};
pub use eye::Eye;
pub use grasp::LONGEST_SIDES_M;
pub use hand::{Hand, Pinch, Side};
pub use hidden_area::HiddenArea;
pub use interaction::{Changes, Interaction};
pub use late::{Late, Second};
pub use pointer::{Pointed, pointing_settings, value_under};
pub use recording::{LineError, Recorder, Recording, RecordingError, TickError};
pub use stand::{Scale, Stand};
pub use surroundings::{Line, floor, horizon};
pub use tick::Tick;
