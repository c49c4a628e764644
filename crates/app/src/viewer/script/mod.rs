//! Events without a person: from a file, or random ones.

mod chord;
mod drag;
mod player;
mod random;
mod step;

#[cfg(test)]
pub(crate) use drag::{Button, Drag};
pub(crate) use player::{Due, Happening, Player, Status};
pub(crate) use random::random_steps;
pub(crate) use step::read_steps;
