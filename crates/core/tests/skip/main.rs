//! Empty-space skipping against brute force: what blocks hold, what can be seen, and how far the next
//! occupied block is.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod distances;
mod gradients;
mod occupancy;
mod ranges;
mod scene;
