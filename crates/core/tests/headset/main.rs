//! Hands at a volume: laws of what they move, and recordings of them.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod canted;
mod demonstration;
mod drags;
mod grasp;
mod hands;
mod hidden_area;
mod late;
mod middle_eye;
mod pinches;
mod pointer;
mod recording;
mod stand;
mod sticks;
