//! `wheatstone vr` and `bench vr`, run as users run them: in Monado with devices that the tests move, and with no headset at all; on
//! software Vulkan.
//!
//! `scripts/monado.sh` sets Monado up. Without it the tests in Monado fail, unless `WHEATSTONE_SKIP_XR_TESTS` says why they are skipped.

#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "all of this crate is test code")]

#[allow(dead_code, reason = "the tests of the headset itself use the rest")]
#[path = "../../../xr/tests/headset/monado.rs"]
mod monado;
#[allow(dead_code, reason = "the tests of the headset itself use the rest")]
#[path = "../../../xr/tests/headset/remote.rs"]
mod remote;
#[path = "../../../xr/tests/headset/screenshot.rs"]
mod screenshot;
mod support;

mod endings;
mod hands;
mod marks;
mod moving;
mod no_headset;
mod validation;
