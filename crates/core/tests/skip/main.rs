//! Empty-space skipping against brute force: what blocks hold, what can be seen, how far the next occupied block is, and
//! how many samples a ray may leave out.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod distances;
mod gradients;
mod occupancy;
mod ranges;
mod scene;
mod steps;
