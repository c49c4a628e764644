//! What a headset tells before each of its refreshes, whichever runtime it comes from: when the picture will be shown, where
//! the eyes will be, and what the hands do. Nothing here knows a runtime; `wheatstone-xr` fills these in from `OpenXR`.

mod eye;
mod hand;
mod tick;

pub use eye::Eye;
pub use hand::{Hand, Side};
pub use tick::Tick;
