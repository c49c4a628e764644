//! A volume in a headset: a runtime's ([`openxr`]) or, for a recording and for tests, none's ([`replay`]).
//!
//! [`room::Room`] is what is in the room: the viewer's session and casting, seen by eyes that a [`headset::Headset`] tells of, and
//! taken by hands. The volume does not move: eyes and hands do, in its upright space
//! ([`Stand`](wheatstone_core::headset::Stand)), so that pictures go on to be cast, and old ones to be warped, while it is carried.

mod check;
mod depths;
mod eyes;
mod hands;
mod headset;
mod keeping;
mod ladder;
mod mirror;
#[cfg_attr(not(any(target_os = "linux", target_os = "windows")), path = "no_openxr.rs")]
mod openxr;
mod panel;
mod pointing;
mod record;
mod rehearsal;
mod replay;
mod report;
mod room;
mod stage;

pub(crate) use check::Checking;
pub(crate) use headset::{DepthLayer, OfPictures};
pub(crate) use mirror::Mirror;
pub(crate) use openxr::{Connected, OpenXr};
pub(crate) use record::Record;
pub(crate) use replay::{Clock, Guided, Played, Replay};
pub(crate) use report::Report;
pub(crate) use room::{Beside, Control, Opening, Room, load, run};
