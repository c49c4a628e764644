//! A session in a real runtime: Monado with devices that the test moves, on software Vulkan, without a headset.
//!
//! `scripts/monado.sh` sets Monado up. Without it these tests fail, unless `WHEATSTONE_SKIP_XR_TESTS` says why they are skipped.

#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "all of this crate is test code")]

mod inside;
mod monado;
mod remote;
mod screenshot;
mod support;

mod endings;
mod eyes;
mod focus;
mod frames;
mod hands;
mod missing;
mod screen;
