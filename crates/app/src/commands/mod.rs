//! The commands, one per file: arguments, then `run`.

pub(crate) mod bench;
mod bench_cast;
mod bench_detail;
mod bench_lightfield;
mod bench_skip;
mod bench_stereo;
mod bench_vr;
mod bench_warp;
pub(crate) mod calibrate;
pub(crate) mod compare;
pub(crate) mod demo;
pub(crate) mod doctor;
pub(crate) mod info;
pub(crate) mod phantom;
pub(crate) mod projectors;
pub(crate) mod quilt;
pub(crate) mod render;
pub(crate) mod simulate;
pub(crate) mod view;
pub(crate) mod vr;
