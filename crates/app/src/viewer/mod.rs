//! The viewer: a window that shows a volume, casts it under a budget and never waits for a cast.
//!
//! Panels, mouse, keys and scripts ask for [`command`]s; the [`session`] does them; its [`state`] is all that is shown.
//! [`casting`] follows the state, [`cycle::Viewer`] makes refreshes of it, on a window ([`window`]) or without one
//! ([`headless`]).

pub(crate) mod canvas;
mod capture;
pub(crate) mod casting;
pub(crate) mod command;
mod cycle;
pub(crate) mod eyes;
mod facts;
mod headless;
pub(crate) mod job;
mod latency;
pub(crate) mod lens;
pub(crate) mod loading;
mod memory;
mod notes;
mod novel_views;
mod report;
pub(crate) mod screen;
mod script;
pub(crate) mod session;
pub(crate) mod show;
pub(crate) mod state;
mod tiles;
pub(crate) mod timings;
pub(crate) mod ui;
mod upload;
pub(crate) mod window;

pub(crate) use headless::run as run_headless;
pub(crate) use loading::Source;
pub(crate) use script::{Player, random_steps, read_steps};
pub(crate) use window::run as run_window;

use std::time::Instant;

/// What a run of the viewer begins with.
pub(crate) struct Opening {
    pub(crate) source: Source,
    /// Of what is shown, a saved view included.
    pub(crate) edits: Vec<state::Edit>,
    /// Events instead of a person's, if there are any.
    pub(crate) player: Option<Player>,
    /// Width and height of the window, points.
    pub(crate) size: [u32; 2],
    /// When the program began.
    pub(crate) begun: Instant,
}
