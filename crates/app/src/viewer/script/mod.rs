//! Events without a person: from a file, or random ones.

mod chord;
mod drag;
mod dropped;
mod player;
mod random;
mod step;

#[cfg(test)]
pub(crate) use drag::{Button, Drag};
pub(crate) use dropped::Dropped;
pub(crate) use player::{Due, Happening, Player, Status};
pub(crate) use random::{of_what_exists, random_steps};
pub(crate) use step::read_steps;
