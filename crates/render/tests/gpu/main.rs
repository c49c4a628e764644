//! The GPU ray caster against the reference ray caster, on software Vulkan where there is any, else on the best device.
//!
//! A missing adapter fails these tests. `WHEATSTONE_SKIP_GPU_TESTS=1` skips them, and they say so.

#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "all of this crate is test code")]

mod anchors;
mod bounds;
mod detail;
mod device;
mod errors;
mod first_hits;
mod layers;
mod leap;
mod live;
mod novel_view;
mod pairs;
mod parity;
mod projectors;
mod report;
mod scene;
mod segments;
mod skip;
mod stereo;
mod stereo_forms;
mod stereo_repair;
mod styles;
mod targets;
mod tolerance;
mod upload;
mod volumetric;
mod warp;
