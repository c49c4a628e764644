//! The command line, run as users run it: on small phantoms, with the CPU renderer.

mod pictures;
mod refusals;
mod reports;
mod support;
