//! The command line, run as users run it: on small phantoms, with the CPU renderer; the viewer on software Vulkan.

#![expect(clippy::unwrap_used, reason = "a test may panic")]

mod pictures;
mod projectors;
mod quilts;
mod refusals;
mod reports;
mod support;
mod view;
mod xvfb;
