//! Budgeted casting in simulated time: what is missed, and what an oracle that knows every cost would have cast.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod oracle;
mod prediction;
mod properties;
mod quality;
mod refreshes;
mod simulation;
mod turntable;
mod workload;
