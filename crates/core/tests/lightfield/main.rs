//! Light-field displays: what they are to show, and what eyes in front of them see.

#![expect(clippy::unwrap_used, reason = "all of this crate is test code")]

mod anchors;
mod calibration;
mod descriptions;
mod lenses;
mod mcop;
mod observers;
mod packing;
mod quilts;
mod scene;
mod simulated;
